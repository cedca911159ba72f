#!/bin/sh
# Small machines: MPM_BLOCK, how many points are treated together, changes the stack and no bit of a run; examples/embedded
# runs on this machine without malloc. Run from the top folder: tests/14_small.sh [cc]. On a Cortex-M: make embedded.
set -u
cc=${1:-cc}
dir=build/tests/small
rm -rf "$dir"
mkdir -p "$dir"
. tests/check.sh
strict="-std=c99 -pedantic -Wall -Wextra -Wconversion -Wshadow -Werror"
impact() { # options: a small bonded impact, its numbers to $dir/NAME
    name=$1
    shift
    $cc $strict -O1 -ffp-contract=off -DMPM_NO_INLINE "$@" -I. -Itests tests/compile/agree.c -o "$dir/$name.run" -lm &&
        numbers "$dir/$name" "$dir/$name.run"
}
for real in double float; do
    flag=-UMPM_FLOAT
    [ $real = float ] && flag=-DMPM_FLOAT
    check "an impact in $real" impact $real $flag
    for n in 1 8 100; do
        check "... with MPM_BLOCK $n" impact "$real.$n" $flag -DMPM_BLOCK=$n
        check "... has the same bits" cmp "$dir/$real" "$dir/$real.$n"
    done
done
for n in 0 1025; do
    check "MPM_BLOCK $n is no number of points" sh -c \
        "! $cc -DMPM_BLOCK=$n -I. -fsyntax-only mpm.c 2>'$dir/refusal' && grep -q 'at least 1' '$dir/refusal'"
done

# The frames of the library, in bytes, by gcc: what a small machine needs is set by the largest.
frames() { # name, options...: the largest frame of mpm.h, mpm_ptw.h and mpm_bond.h
    printf '#define MPM_IMPLEMENTATION\n#include "mpm_ptw.h"\n#include "mpm_bond.h"\n' >"$dir/$1.c"
    name=$1
    shift
    gcc -std=c99 -Os -DMPM_FLOAT -DMPM_NO_INLINE "$@" -I. -fstack-usage -c "$dir/$name.c" -o "$dir/$name.o" &&
        cut -f 2 "$dir/$name.su" | sort -n | tail -n 1 >"$dir/$name.frame"
}
below() { [ "$(cat "$dir/$1.frame")" -lt "$2" ]; }
if gcc -fstack-usage -x c -c /dev/null -o "$dir/none.o" 2>/dev/null; then
    check "frames in float" frames usual
    check "... with MPM_BLOCK 8" frames small -DMPM_BLOCK=8
    check "... of which none reaches 6 KiB: a chain of them stays below 8" below small 6144
    check "... while some otherwise do" sh -c "! [ \$(cat $dir/usual.frame) -lt 8192 ]"
else
    echo "skip - gcc -fstack-usage is not there: frames were not looked at"
fi

# The embedded example on this machine.
embedded() {
    $cc $strict -O2 -ffp-contract=off -DMPM_FLOAT -DMPM_STATIC -DMPM_NO_INLINE -DMPM_BLOCK=8 -I. \
        examples/embedded/impact.c examples/embedded/desktop.c -o "$dir/embedded" -lm
}
value() { awk -v name="$1" 'index($0, name) == 1 { print $NF }' "$dir/embedded.out"; }
near() { # name, value, tolerance
    value "$1" | awk -v v="$2" -v t="$3" '{ d = $1 - v; ok = d <= t && d >= -t } END { exit !ok }'
}
check "examples/embedded builds here" embedded
check "... and runs" sh -c "$dir/embedded >$dir/embedded.out"
check "... with all its points" near points 1268 0
check "... the ball stays" near "velocity lost" 810 5
check "... and is as hot as in double" near temperature 912.1 1
if command -v nm >/dev/null; then
    check "... without malloc" sh -c "! nm $dir/embedded | grep -E ' U _?(malloc|calloc|realloc|free)\$'"
    check "... nor printf" sh -c "! nm $dir/embedded | grep -E ' U .*printf'"
fi
check_end
