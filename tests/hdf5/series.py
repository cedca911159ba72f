"""series.py - what the checks of tests/hdf5 share: results, and the numbers that tests/42_hdf5.c puts into its series.
SPDX-License-Identifier: MIT"""
import numpy

passed = failed = 0


def check(what, good, why=""):
    global passed, failed
    if good:
        passed += 1
        print("ok -", what)
    else:
        failed += 1
        print("not ok -", what, why)
    return good


def end():
    print(f"{passed} passed, {failed} failed")
    return 1 if failed or not passed else 0


# Points of the frames, and points of a cell, of each file that 42_hdf5 leaves.
SERIES = {
    "points": ([50000, 50000, 120, 33000, 7], 1),
    "packed": ([50000, 50000, 120, 33000, 7], 1),
    "lines": ([50, 60, 70, 80, 90], 2),
    "triangles": ([50, 60, 70, 80, 90], 3),
    "order": ([20], 1),
}
# Names as they were given, and as HDF5 has them.
FIELDS = {"velocity (m/s)": "velocity (m per s)", "stress (MPa)": "stress (MPa)", "temperature <K>": "temperature <K>",
          "flag": "flag", "id": "id"}


def frame(name, k):
    """Points, cells and fields of frame k as they must be read: the formulas of 42_hdf5.c again."""
    counts, ends = SERIES[name]
    n = counts[k]
    i = numpy.arange(n)
    x = numpy.stack([i % 100 + a * k / 2 for a in range(3)], axis=1)
    cells = numpy.arange(n)[:, None] if ends == 1 else numpy.arange(n - 2)[:, None] + numpy.arange(ends)
    order = [1, 2, 3, 6, 4, 5]  # xx yy zz xy yz xz of the order of mpm.h
    fields = {
        "velocity (m/s)": numpy.stack([numpy.full(n, 100.0 * a + k) for a in range(3)], axis=1),
        "stress (MPa)": numpy.stack([2.0 * a * (i % 7 + k) for a in order], axis=1),
        "temperature <K>": 300.0 + k + i % 10,
        "flag": i % 3,
        "id": n - i,
    }
    return x, cells, fields
