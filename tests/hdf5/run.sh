#!/bin/sh
# make hdf5: builds mpm_hdf5.h with the HDF5 library and has its files read by readers that share nothing with it. What
# is not installed is left out with a line that says so. Given: compiler, make, flags to compile with HDF5 and to link.
set -u
cc=$1
make=$2
flags=$3
libs=$4
dir=build/tests/hdf5
mkdir -p "$dir"
. tests/check.sh
PYTHONDONTWRITEBYTECODE=1
export PYTHONDONTWRITEBYTECODE
if [ -z "$libs" ]; then
    echo "skip - the HDF5 library is not installed, or not known to pkg-config (Debian: libhdf5-dev, pkg-config)"
    exit 0
fi
python= # one that has h5py; Debian's package is for its own python3
for p in python3 /usr/bin/python3; do
    [ -z "$python" ] && $p -c 'import h5py, numpy' 2>/dev/null && python=$p
done
pvpython= # of ParaView, which has vtkXdmfReader
for p in ${PVPYTHON:-} pvpython /usr/bin/pvpython; do
    [ -z "$pvpython" ] && $p -c 'import numpy, vtkmodules.vtkIOXdmf2' >/dev/null 2>&1 && pvpython=$p
done
counted() { # command...: a program with a closing line of its own; its failures are shown
    "$@" >"$dir/log" 2>"$dir/warnings"
    status=$?
    grep -E '^(not ok|skip|#)' "$dir/log" | sort -u
    line=$(sed -n '/^[0-9]* passed, [0-9]* failed$/p' "$dir/log" | tail -n 1)
    [ -n "$line" ] || { line="0 passed, 1 failed" && tail -n 3 "$dir/warnings"; }
    echo "$title: $line"
    f=${line#* passed, }
    passed=$((passed + ${line%% *}))
    failed=$((failed + ${f% failed}))
    [ $status -eq 0 ] || [ "${f% failed}" -gt 0 ] || failed=$((failed + 1))
}
layout() { # what, files...
    [ -n "$python" ] || { echo "skip - no python3 with h5py (Debian: python3-h5py): $1 was not looked at"; return; }
    title="layout of $1, by h5py"
    shift
    counted "$python" tests/hdf5/layout.py "$@"
}
readers() { # what, files...
    what=$1
    shift
    if $python -c 'import vtkmodules.vtkIOHDF' 2>/dev/null; then
        title="$what, by VTK"
        counted "$python" tests/hdf5/readers.py "$@"
    else echo "skip - no VTK for python3 (Debian: python3-vtk9): $what was not read by it"; fi
    if [ -n "$pvpython" ]; then
        title="$what, by ParaView"
        counted "$pvpython" tests/hdf5/readers.py "$@"
    else echo "skip - no pvpython with vtkXdmfReader (Debian: python3-paraview): the .xmf of $what was not read"; fi
}

# ---- the header: clean by every compiler --------------------------------------------------------
strict="-pedantic -Wall -Wextra -Wconversion -Wshadow -Werror -I."
printf '#define MPM_IMPLEMENTATION\n#include "mpm_hdf5.h"\nint main(void) { return !mpm_hdf5_built(); }\n' >"$dir/one.c"
for real in "" -DMPM_FLOAT; do
    for c in gcc clang; do
        command -v $c >/dev/null || continue
        check "mpm_hdf5.h $real $c c99" $c -std=c99 $strict $real $flags -O1 "$dir/one.c" -o "$dir/one" $libs -lm
        check "... was built with HDF5" "$dir/one"
    done
    for c in g++ clang++; do
        command -v $c >/dev/null || continue
        check "mpm_hdf5.h $real $c c++11" $c -x c++ -std=c++11 -Wall -Wextra -Werror $real -I. $flags -c "$dir/one.c" \
            -o "$dir/one.o"
    done
done
for p in build/impact_hdf5 build/many_particles_hdf5 build/tests/hdf5/frames build/tests/hdf5/append build/impact; do
    check "$p builds" "$make" -s $p CC="$cc"
done

# ---- frames of known numbers --------------------------------------------------------------------
title="frames, their order, errors"
counted "$dir/frames"
series="build/test-hdf5/points.vtkhdf build/test-hdf5/packed.vtkhdf build/test-hdf5/lines.vtkhdf
    build/test-hdf5/triangles.vtkhdf"
layout "known series" $series build/test-hdf5/order.vtkhdf
readers "known series" $series
if [ -n "$python" ]; then
    title="killed while it adds frames"
    counted "$python" tests/hdf5/kill.py "$dir/append" "$dir" "${KILLS:-40}"
fi

# ---- runs: the same numbers as in their .vtu files ----------------------------------------------
short="--quiet --time 4 --cell 2 --spacing 1 --frames 5"
rm -rf "$dir/impact" "$dir/surface" "$dir/many" "$dir/parts" "$dir/refused"
check "an impact with --hdf5 4" build/impact_hdf5 $short --hdf5 4 --out "$dir/impact"
check "contact on surfaces with --hdf5 0" build/impact_hdf5 --method surface --quiet --time 2 --frames 3 --hdf5 0 \
    --out "$dir/surface"
check "several particles with --hdf5 9" build/many_particles_hdf5 $short --count 2 --spread 20 --hdf5 9 \
    --out "$dir/many"
runs="$dir/impact/impact.vtkhdf $dir/surface/impact.vtkhdf $dir/surface/surface.vtkhdf $dir/many/particles.vtkhdf"
layout "runs" $runs
readers "runs" $runs
stopped() { # after 60 steps, with status 3
    build/impact_hdf5 $short --hdf5 4 --out "$dir/parts" --stop-after 60 >/dev/null
    [ $? -eq 3 ]
}
check "an impact that is stopped" stopped
check "... and goes on" build/impact_hdf5 $short --hdf5 4 --out "$dir/parts" --resume
if command -v h5diff >/dev/null; then
    check "... has the same frames" h5diff "$dir/impact/impact.vtkhdf" "$dir/parts/impact.vtkhdf"
    check "... and the same XDMF" cmp "$dir/impact/impact.xmf" "$dir/parts/impact.xmf"
else echo "skip - no h5diff (Debian: hdf5-tools): frames of a run that was stopped were not compared"; fi

# ---- what is refused ----------------------------------------------------------------------------
refused() { # text of the message, command...: fails, says it, and makes no folder
    text=$1
    shift
    ! "$@" --out "$dir/refused" 2>"$dir/message" && grep -q -- "$text" "$dir/message" && [ ! -e "$dir/refused" ]
}
check "--hdf5 10 is refused" refused "--hdf5 10: must be -1 .. 9" build/impact_hdf5 $short --hdf5 10
check "--hdf5 fast is refused" refused "fast" build/impact_hdf5 $short --hdf5 fast
[ -e build/hdf5.on ] ||
    check "a program without HDF5 says how to build it" refused "make hdf5" build/impact $short --hdf5 1
check_end
