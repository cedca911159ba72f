#!/bin/sh
# Compile tests: every header alone, twice, in two translation units, static, with float, from C99 and
# C++, by gcc and clang where they are installed, all warnings as errors; and the symbols they leave.
set -u
dir=build/tests/compile
rm -rf "$dir"
mkdir -p "$dir"
. tests/check.sh
strict="-pedantic -Wall -Wextra -Wconversion -Wshadow -Werror -I."
# One symbol of each header that its implementation must provide.
symbol() {
    case $1 in
    mpm.h) echo 'mpm_version()[0]' ;;
    mpm_ptw.h) echo 'mpm_material_preset_count()' ;;
    mpm_bond.h) echo '(mpm_bond_check(0, 0) != MPM_OK)' ;;
    mpm_measure.h) echo '(int)mpm_critical_velocity_2003(1, 1, 1, 1)' ;;
    mpm_io.h) echo '(int)mpm_io_number_text(0, 0, 0)' ;;
    mpm_hdf5.h) echo 'mpm_hdf5_built()' ;;
    mpm_draw.h) echo '(int)mpm_draw_canvas_bytes(0, 0)' ;;
    mpm_surface.h) echo '(mpm_surfaces_check(0, 0) != MPM_OK)' ;;
    mpm_spray.h) echo '(int)mpm_spray_bytes(0)' ;;
    esac
}
only() { # object, pattern: main is there, and each of its external symbols fits the pattern
    nm "$1" >"$dir/symbols" && grep -q ' main$' "$dir/symbols" &&
        ! grep -E ' [A-TV-Z] ' "$dir/symbols" | grep -vE "$2"
}
headers=$(ls mpm*.h)
for h in $headers; do
    s=$(symbol "$h")
    main="int main(int n, char **a) { (void)a; return n > 9 ? (int)($s) : 0; }"
    printf '#define MPM_IMPLEMENTATION\n#include "%s"\n#include "%s"\n%s\n' "$h" "$h" "$main" >"$dir/whole.c"
    printf '#include "%s"\nint other(void);\nint other(void) { return (int)(%s); }\n' "$h" "$s" >"$dir/user.c"
    printf '#define MPM_STATIC\n#include "%s"\n%s\n' "$h" "$main" >"$dir/static.c"
    cp "$dir/whole.c" "$dir/whole.cpp"
    cp "$dir/user.c" "$dir/user.cpp"
    for real in double float; do
        flag=
        [ $real = float ] && flag=-DMPM_FLOAT
        for cc in gcc clang; do
            command -v $cc >/dev/null || continue
            check "$h $real $cc c99, twice, alone" $cc -std=c99 $strict $flag -O1 "$dir/whole.c" -o "$dir/whole" -lm
            check "$h $real $cc c99, two units" $cc -std=c99 $strict $flag "$dir/whole.c" "$dir/user.c" \
                -o "$dir/two" -lm
            check "$h $real $cc c99, static" $cc -std=c99 $strict $flag -O1 "$dir/static.c" -o "$dir/static" -lm
            check "$h $real $cc header only" $cc -std=c99 $strict $flag -c "$dir/user.c" -o "$dir/user.o"
        done
        for cxx in g++ clang++; do
            command -v $cxx >/dev/null || continue
            check "$h $real $cxx c++11" $cxx -std=c++11 -Wall -Wextra -Werror -I. $flag \
                "$dir/whole.cpp" "$dir/user.cpp" -o "$dir/cpp" -lm
        done
        if command -v nm >/dev/null; then
            rm -f "$dir/whole.o" "$dir/static.o"
            check "$h $real an object" $1 -std=c99 -I. $flag -c "$dir/whole.c" -o "$dir/whole.o"
            check "$h $real a static one" $1 -std=c99 -I. $flag -c "$dir/static.c" -o "$dir/static.o"
            pattern=' [A-TV-Z] (mpm_|main$)'
            [ $real = float ] && pattern=' [A-TV-Z] (mpm_.*_f32$|mpm_(version|status_text|units_.*)$|main$)'
            check "$h $real external symbols" only "$dir/whole.o" "$pattern"
            check "$h $real static leaves none" only "$dir/static.o" ' main$'
        fi
    done
done
# After headers that take short words as macros: each header and mpm.c, the declarations alone and all of it.
hostile() { # compiler, standard, what comes first, language
    for h in $headers mpm.c; do
        printf '%b\n#include "%s"\n' "$3" "$h" >"$dir/user.c"
        printf '#define MPM_IMPLEMENTATION\n%b\n#include "%s"\n' "$3" "$h" >"$dir/whole.c"
        for part in user whole; do
            check "$h ($part) after others' macros, $1 $2" $1 -std=$2 $4 -fsyntax-only -w -I. "$dir/$part.c"
        done
    done
}
for cc in gcc clang; do
    command -v $cc >/dev/null || continue
    hostile $cc gnu99 '#include "tests/compile/hostile.h"' '-x c'
    hostile $cc gnu99 '#include <complex.h>\n#include <tgmath.h>\n#include <iso646.h>' '-x c'
done
for cxx in g++ clang++; do
    command -v $cxx >/dev/null || continue
    hostile $cxx gnu++11 '#include "tests/compile/hostile.h"' '-x c++'
done
# For Windows, with what a Windows program includes.
windows=x86_64-w64-mingw32-gcc
if command -v $windows >/dev/null; then
    hostile $windows c99 '#include <windows.h>' '-x c'
    hostile $windows c99 '#define WIN32_LEAN_AND_MEAN\n#include <windows.h>' '-x c'
    hostile $windows c99 '#include "tests/compile/hostile.h"' '-x c'
    check "mpm.c by $windows" $windows -std=c99 $strict -c mpm.c -o "$dir/mpm.o"
    for p in impact taylor spray material; do
        check "$p by $windows" $windows -std=c99 -I. -Iexamples "examples/$p.c" -o "$dir/$p.exe" -lm
    done
fi
for tool in gcc clang g++ clang++ nm $windows; do
    command -v $tool >/dev/null || echo "skip - $tool is not installed: its compile tests were not run"
done
# Units compiled with different real types must not link.
printf '#define MPM_IMPLEMENTATION\n#include "mpm.h"\nint main(void) { return 0; }\n' >"$dir/whole.c"
printf '#include "mpm.h"\nint other(mpm_world *w);\nint other(mpm_world *w) { return mpm_step(w, 1); }\n' >"$dir/user.c"
rm -f "$dir/whole.o" "$dir/user.o"
check "a double unit" $1 -std=c99 -I. -c "$dir/whole.c" -o "$dir/whole.o"
check "a float unit" $1 -std=c99 -I. -DMPM_FLOAT -c "$dir/user.c" -o "$dir/user.o"
check "... do not link" sh -c "! $1 '$dir/whole.o' '$dir/user.o' -o '$dir/mixed' -lm"
# Optimisations that take NaN and infinity away are refused; without that part of them every check holds.
refuses() { # command...: does not compile, and the message says what to do
    ! "$@" 2>"$dir/refusal" && grep -q 'fno-finite-math-only' "$dir/refusal"
}
for cc in gcc clang; do
    command -v $cc >/dev/null || continue
    for flag in -ffast-math -Ofast -ffinite-math-only; do
        check "$cc $flag is refused" refuses $cc -std=c99 -w $flag -fsyntax-only -I. mpm.c
        check "$cc $flag is overruled" $cc -std=c99 -w $flag -DMPM_FINITE_MATH -fsyntax-only -I. mpm.c
    done
    for flag in -O0 '-Ofast -fno-finite-math-only' '-Ofast -fno-finite-math-only -DMPM_FLOAT'; do
        rm -f "$dir/nan"
        check "$cc $flag: builds" $cc -std=c99 -w $flag -I. -Itests tests/compile/nan.c -o "$dir/nan" -lm
        check "... NaN is noticed" "$dir/nan"
    done
done
# The same small impact by every compiler and level, with and without vector types: equal but for accumulated round-off.
first=
for cc in gcc clang; do
    command -v $cc >/dev/null || continue
    for level in -O0 -O2 -DMPM_NO_WIDE; do
        rm -f "$dir/agree"
        check "an impact by $cc $level builds" \
            $cc -std=c99 -I. -Itests $level -ffp-contract=off tests/compile/agree.c -o "$dir/agree" -lm
        check "... runs" numbers "$dir/agree_$cc$level" "$dir/agree"
        [ -z "$first" ] || check "... agrees with that by $first" agree "$dir/agree_$first" "$dir/agree_$cc$level"
        first=${first:-$cc$level}
    done
done
check_end
