"""layout.py - holds a file to VTKHDF 2.0, by h5py: python3 tests/hdf5/layout.py FILE.vtkhdf ...
Every table of the steps has one entry a frame; they lie one behind the other without holes and end where the arrays
end; offsets, types and connectivity of each frame are those of its cells. Of the files of 42_hdf5, every number is known.
SPDX-License-Identifier: MIT"""
import os
import sys

import h5py
import numpy

import series
from series import check

WIDTH = {1: 1, 3: 2, 5: 3}  # points of a vertex, a line, a triangle


def tables(f, path):
    """Checks all that is beside the data. Returns frames: (first and last rows of points, cells, connectivity)."""
    root = f["VTKHDF"]
    steps = root["Steps"]
    n = int(steps.attrs["NSteps"])
    check(f"{path}: version 2.0", list(root.attrs["Version"]) == [2, 0])
    check(f"{path}: an UnstructuredGrid", root.attrs["Type"] == b"UnstructuredGrid")
    check(f"{path}: the type is a text of fixed length",
          h5py.check_string_dtype(root.attrs.get_id("Type").dtype).length == 16)
    check(f"{path}: has frames", n > 0)
    per_frame = {k: steps[k] for k in steps if isinstance(steps[k], h5py.Dataset)}
    per_frame.update({k: root[k] for k in ("NumberOfPoints", "NumberOfCells", "NumberOfConnectivityIds")})
    per_frame.update({k: v for k, v in steps["PointDataOffsets"].items()})
    check(f"{path}: one entry a frame in {len(per_frame)} tables",
          all(v.shape == (n,) for v in per_frame.values()), {k: v.shape for k, v in per_frame.items()})
    check(f"{path}: times rise", numpy.all(numpy.diff(steps["Values"][:]) > 0), steps["Values"][:])
    check(f"{path}: a part a frame", list(steps["NumberOfParts"]) == [1] * n)
    check(f"{path}: parts in order", list(steps["PartOffsets"]) == list(range(n)))
    ranges = []
    for first, count, array in (("PointOffsets", "NumberOfPoints", "Points"), ("CellOffsets", "NumberOfCells", "Types"),
                                ("ConnectivityIdOffsets", "NumberOfConnectivityIds", "Connectivity")):
        ends = numpy.concatenate([[0], numpy.cumsum(root[count][:])])
        check(f"{path}: {first} are the sums of {count}", list(steps[first]) == list(ends[:-1]))
        check(f"{path}: ... and end with {array}", root[array].shape[0] == ends[-1], (root[array].shape, ends))
        ranges.append(ends)
    check(f"{path}: Offsets has one more than cells in every frame", root["Offsets"].shape[0] == ranges[1][-1] + n)
    check(f"{path}: fields and their offsets have the same names",
          list(root["PointData"]) == list(steps["PointDataOffsets"]) and len(root["PointData"]) > 0)
    for name, field in root["PointData"].items():
        check(f"{path}: {name} begins with the points and has as many",
              list(steps["PointDataOffsets"][name]) == list(steps["PointOffsets"]) and
              field.shape[0] == ranges[0][-1])
        given = field.attrs["name"].decode()
        check(f"{path}: ... and keeps its name", given.replace("/", " per ") == name, given)
    return [[(int(r[k]), int(r[k + 1])) for r in ranges] for k in range(n)]


def cells(root, k, place, path):
    """The cells of frame k, a row each."""
    (first, last), (c0, c1), (i0, i1) = place
    types = root["Types"][c0:c1]
    offsets = root["Offsets"][c0 + k:c1 + k + 1]
    ids = root["Connectivity"][i0:i1]
    width = WIDTH.get(int(types[0]), 0)
    check(f"{path}: frame {k}: cells of one type, offsets in steps of {width}",
          width > 0 and numpy.all(types == types[0]) and list(offsets) == list(range(0, width * (c1 - c0) + 1, width)))
    check(f"{path}: frame {k}: of points that are there", ids.min() >= 0 and ids.max() < last - first)
    return ids.reshape(-1, width)


def known(f, name, frames, path):
    """Every number of a series of 42_hdf5."""
    root = f["VTKHDF"]
    check(f"{path}: the frames and counts of the test",
          [last - first for (first, last), _, _ in frames] == series.SERIES[name][0])
    check(f"{path}: the times of the test", numpy.allclose(root["Steps/Values"][:], 0.1 * numpy.arange(len(frames))))
    check(f"{path}: what made it", f.attrs["note"] == b"a test" and f.attrs["mpm.h"].count(b".") == 2)
    for k, place in enumerate(frames):
        x, wanted, fields = series.frame(name, k)
        first, last = place[0]
        check(f"{path}: frame {k}: points", numpy.array_equal(root["Points"][first:last], x))
        check(f"{path}: frame {k}: cells", numpy.array_equal(cells(root, k, place, path), wanted))
        for field, values in fields.items():
            check(f"{path}: frame {k}: {field}",
                  numpy.array_equal(root["PointData"][series.FIELDS[field]][first:last], values))


for path in sys.argv[1:]:
    with h5py.File(path, "r") as f:
        frames = tables(f, path)
        name = os.path.basename(path).split(".")[0]
        if name in series.SERIES and "test-hdf5" in path:
            known(f, name, frames, path)
        else:
            for k, place in enumerate(frames):
                cells(f["VTKHDF"], k, place, path)
sys.exit(series.end())
