"""readers.py - files of mpm_hdf5.h read by programs that others read them with, without a picture:
    python3 tests/hdf5/readers.py FILE.vtkhdf ...
VTK's vtkHDFReader: 9.3 and later step by step; before that it knows no steps and takes every frame for a part of one
mesh, so the parts are read one by one. FILE.xmf beside it: vtkXdmfReader, which ParaView has and Debian's VTK has not.
Each frame is compared with points_NNNN.vtu (or surface_NNNN.vtu) of the same folder, read by VTK's own XML reader; of
the series of 42_hdf5, with the numbers known. SPDX-License-Identifier: MIT"""
import os
import sys

import numpy
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkVersion
from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline
from vtkmodules.vtkIOHDF import vtkHDFReader
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

try:
    from vtkmodules.vtkIOXdmf2 import vtkXdmfReader
except ImportError:
    vtkXdmfReader = None

import series
from series import check

VERSION = vtkVersion().GetVTKVersion()
HAS_STEPS = tuple(int(v) for v in VERSION.split(".")[:2]) >= (9, 3)


def numbers(grid):
    """Points, cells and fields of a vtkUnstructuredGrid."""
    ids = vtk_to_numpy(grid.GetCells().GetConnectivityArray())
    data = grid.GetPointData()
    fields = {data.GetArrayName(i): vtk_to_numpy(data.GetArray(i)) for i in range(data.GetNumberOfArrays())}
    return vtk_to_numpy(grid.GetPoints().GetData()), ids.reshape(grid.GetNumberOfCells(), -1), fields


def by_vtk_hdf(path):
    """Times (None where the reader has none) and frames."""
    r = vtkHDFReader()
    r.SetFileName(path)
    r.UpdateInformation()
    info, key = r.GetOutputInformation(0), vtkStreamingDemandDrivenPipeline.TIME_STEPS()
    if HAS_STEPS:
        times = [info.Get(key, i) for i in range(info.Length(key))]
        for t in times:
            r.UpdateTimeStep(t)
            yield t, numbers(r.GetOutputDataObject(0))
        return
    import h5py  # for the number of parts alone
    with h5py.File(path, "r") as f:
        parts = f["VTKHDF/NumberOfPoints"].shape[0]
    for k in range(parts):
        r.UpdatePiece(k, parts, 0)
        yield None, numbers(r.GetOutputDataObject(0))


def by_xdmf(path):
    r = vtkXdmfReader()
    r.SetFileName(path)
    r.UpdateInformation()
    info, key = r.GetOutputInformation(0), vtkStreamingDemandDrivenPipeline.TIME_STEPS()
    for i in range(info.Length(key)):
        t = info.Get(key, i)
        r.UpdateTimeStep(t)
        grid = r.GetOutputDataObject(0)
        while grid.IsA("vtkMultiBlockDataSet"):
            grid = grid.GetBlock(0)
        yield t, numbers(grid)


def by_vtu(folder, k, surface):
    r = vtkXMLUnstructuredGridReader()
    r.SetFileName(os.path.join(folder, f"{'surface' if surface else 'points'}_{k:04d}.vtu"))
    r.Update()
    grid = r.GetOutput()
    return grid.GetFieldData().GetArray("TimeValue").GetTuple1(0), numbers(grid)


def wanted(path, k):
    """Time and numbers of frame k from outside the file."""
    folder, name = os.path.split(path)
    name = name.split(".")[0]
    if "test-hdf5" in path:
        return 0.1 * k, series.frame(name, k)
    return by_vtu(folder, k, name == "surface")


def compare(what, path, read, safe):
    """safe: whether names are as HDF5 has them."""
    frames = 0
    for k, (time, (x, cells, fields)) in enumerate(read):
        t, (x0, cells0, fields0) = wanted(path, k)
        at = f"{what}: {path}: frame {k}"
        check(f"{at}: time {t:.6g}", time is None or abs(time - t) <= 1e-12 * abs(t), time)
        check(f"{at}: {len(x0)} points", numpy.array_equal(x, x0))
        check(f"{at}: {len(cells0)} cells", numpy.array_equal(cells, cells0), cells.shape)
        names = {n.replace("/", " per ") if safe else n: n for n in fields0}
        check(f"{at}: {len(names)} names of fields", sorted(fields) == sorted(names), sorted(fields))
        for name, given in names.items():
            same = name in fields and numpy.array_equal(fields[name], fields0[given])
            check(f"{at}: {name}, {fields0[given].min():.6g} .. {fields0[given].max():.6g}", same)
        frames += 1
    check(f"{what}: {path}: frames were read", frames > 0)


for path in sys.argv[1:]:
    compare(f"vtkHDFReader {VERSION}" + ("" if HAS_STEPS else ", by parts"), path, by_vtk_hdf(path), True)
    xmf = path.replace(".vtkhdf", ".xmf")
    if vtkXdmfReader is None:
        print(f"skip - this VTK {VERSION} has no vtkXdmfReader: {xmf} was not read (ParaView's pvpython has)")
    elif os.path.exists(xmf):
        compare(f"vtkXdmfReader {VERSION}", path, by_xdmf(os.path.abspath(xmf)), False)
sys.exit(series.end())
