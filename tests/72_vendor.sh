#!/bin/sh
# Packages: mpm.c. Given: the compiler's name.
set -u
cc=${1:-cc}
dir=build/tests/vendor
rm -rf "$dir"
mkdir -p "$dir"
. tests/check.sh
strict="-pedantic -Wall -Wextra -Wconversion -Wshadow -Werror"
has() { command -v "$1" >/dev/null; }
skip() { echo "skip - $1"; }

# ---- mpm.c: every header, clean by every compiler ----------------------------------------------
for h in mpm*.h; do
    check "mpm.c includes $h" grep -qx "#include \"$h\"" mpm.c
done
for real in double float; do
    flag=
    [ $real = float ] && flag=-DMPM_FLOAT
    for c in gcc clang; do
        has $c || continue
        check "mpm.c $real $c c99" $c -std=c99 $strict $flag -I. -O1 -c mpm.c -o "$dir/mpm_$c$flag.o"
        check "mpm.c $real $c c++11" $c -x c++ -std=c++11 -Wall -Wextra -Werror $flag -I. -fsyntax-only mpm.c
    done
done

check_end
