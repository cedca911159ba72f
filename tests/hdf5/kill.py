"""kill.py - a process that adds frames is killed (SIGKILL) again and again: python3 tests/hdf5/kill.py APPEND FOLDER N.
After each kill the file holds every frame that was reported, whole; where it is marked as open it is read as HDF5's own
readers of such files do (SWMR). Then the process goes on, and the file is one again that any reader opens.
SPDX-License-Identifier: MIT"""
import os
import random
import signal
import subprocess
import sys
import time

import h5py
import numpy

import series
from series import check

append, folder, kills = sys.argv[1], sys.argv[2], int(sys.argv[3])
path = os.path.join(folder, "killed.vtkhdf")
POINTS = 3000
draw = random.Random(1)
for leftover in (path, path + ".part"):
    if os.path.exists(leftover):
        os.remove(leftover)


def frames_in(f, least):
    """Checks the first frames of an open file, as append wrote them. Returns how many there are."""
    root = f["VTKHDF"]
    n = int(root["Steps"].attrs["NSteps"])
    good = n >= least
    sizes = [POINTS - k % 7 for k in range(n)]
    firsts = numpy.concatenate([[0], numpy.cumsum(sizes)])[:n]
    good = good and list(root["Steps/PointOffsets"][:n]) == list(firsts) and list(root["NumberOfPoints"][:n]) == sizes
    good = good and list(root["Steps/Values"][:n]) == list(range(n))
    for k in range(max(0, n - 30), n):
        at = slice(firsts[k], firsts[k] + sizes[k])
        good = good and numpy.array_equal(root["PointData/temperature (K)"][at], k + numpy.arange(sizes[k]))
        good = good and numpy.array_equal(root["Points"][at, 2], 3 * numpy.arange(sizes[k]))
    return n if good else -1


whole = marked = bad = 0
frame = 0
for turn in range(kills):
    p = subprocess.Popen([append, path, str(frame), "100000"], stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    p.stdout.readline()  # it is under way
    time.sleep(draw.uniform(0, 0.02))
    p.send_signal(signal.SIGKILL)
    said, errors = p.communicate()
    if errors:
        bad += 1
        print("#", errors.decode().strip())
    reported = int(said.split()[-1]) + 1 if said.split() else frame + 1
    try:
        with h5py.File(path, "r") as f:
            n = frames_in(f, reported)
        whole += 1
    except OSError:
        try:
            with h5py.File(path, "r", swmr=True) as f:
                n = frames_in(f, reported)
            marked += 1
        except (OSError, KeyError) as e:
            n = -1
            print("#", e)
    if n < 0:
        bad += 1
        break
    frame = n if n < 60 else draw.randrange(0, 30)  # or from an earlier checkpoint
print(f"# {kills} kills: {whole} left a file as it is read by anyone, {marked} one that was marked as open")
check("every frame that was reported is there after every kill", bad == 0, bad)
check("both kinds were met", whole > 0 and marked > 0, (whole, marked))
done = subprocess.run([append, path, str(frame), str(frame + 2)], stdout=subprocess.PIPE)
check("then it goes on to its end", done.returncode == 0)
with h5py.File(path, "r") as f:
    check("... and the file is one that any reader opens", frames_in(f, frame + 2) == frame + 2)
with h5py.File(path, "r"):  # someone looks at it meanwhile
    done = subprocess.run([append, path, str(frame + 2), str(frame + 5)], stdout=subprocess.PIPE)
    check("a reader that has it open does not stop the process", done.returncode == 0)
with h5py.File(path, "r") as f:
    check("... and opened again it shows the new frames", frames_in(f, frame + 5) == frame + 5)
with h5py.File(path, "r+") as f:  # what a frame may leave that could not be added whole
    for name in ("Points", "NumberOfPoints", "Steps/PointOffsets"):
        f["VTKHDF/" + name].resize(f["VTKHDF/" + name].shape[0] + 1, axis=0)
done = subprocess.run([append, path, str(frame + 5), str(frame + 7)], stdout=subprocess.PIPE)
with h5py.File(path, "r") as f:
    check("rows of a frame that failed are dropped", done.returncode == 0 and frames_in(f, frame + 7) == frame + 7)
check("no .part is left", not os.path.exists(path + ".part"))
sys.exit(series.end())
