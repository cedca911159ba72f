#!/bin/sh
# Every complete program in a header's comment ("A COMPLETE PROGRAM") and in a C block of README.md and docs/*.md is
# taken out, compiled without a warning and run; it must end with 0. What the heading of a header's program promises is
# looked for in its output: texts in double quotes, and "PBCP 7.9 %". Run from the top folder: tests/74_programs.sh [cc]
set -u
cc=${1:-cc}
top=$(pwd)
dir=build/tests/programs
rm -rf "$dir"
mkdir -p "$dir"
. tests/check.sh
# Programs to NAME.c, what was promised to NAME.heading.
for h in mpm*.h; do
    awk -v out="$dir/$h" '
        /^   A COMPLETE PROGRAM/ { heading = 1; number++ }
        heading && /^       / { heading = 0; inside = 1 }
        heading { print > (out "." number ".heading") }
        inside { print substr($0, 8) > (out "." number ".c") }
        /^       }$/ { inside = 0 }' "$h"
done
for page in README.md docs/*.md; do
    awk -v out="$dir/$(basename "$page")" '
        /^```/ && inside { inside = 0; if (whole) { number++; printf "%s", text > (out "." number ".c") } next }
        /^```c$/ { inside = 1; whole = 0; text = ""; next }
        inside { text = text $0 "\n"; if (/int main\(/) whole = 1 }' "$page"
done
for h in mpm*.h; do check "$h has a complete program" [ -f "$dir/$h.1.c" ]; done
ends_with_0() { # program: run in its folder, its output kept
    (cd "$dir" && "./$1.run" >"$1.out" 2>&1) || { tail -n 1 "$dir/$1.out" && false; }
}
for c in "$dir"/*.c; do
    name=$(basename "$c" .c)
    check "$name compiles" $cc -std=c99 -pedantic -Wall -Wextra -Werror -O2 "-I$top" "$c" -o "$dir/$name.run" -lm
    check "... ends with 0" ends_with_0 "$name"
    [ -f "$dir/$name.heading" ] || continue
    tr '\n' ' ' <"$dir/$name.heading" | sed 's/  */ /g' | grep -oE '"[^"]*"|PBCP [0-9.]+ %' |
        tr -d '"' >"$dir/$name.says"
    while read -r text; do check "... prints $text" grep -qF -- "$text" "$dir/$name.out"; done <"$dir/$name.says"
done
# What is printed and lost is an error: of every program with options, by running it (built ones; make builds all);
# of the short ones, by their last line.
full() { # program: refuses a full standard output, in words and by its status
    ! "$1" --help >/dev/full 2>"$dir/full" && grep "standard output" "$dir/full"
}
for c in examples/*.c examples/studies/*.c examples/studies/reproduction/main.c; do
    name=$(basename "$c" .c)
    [ "$name" = main ] && name=reproduction
    grep -qE 'int main\(' "$c" || continue
    check "$c ends with a look at standard output" grep -E 'return (program_end\(|fflush\(stdout\) \|\| ferror)' "$c"
    [ -c /dev/full ] && [ -x "build/$name" ] && grep -q program_end "$c" || continue
    check "$name says that standard output is full" full "build/$name"
done
check_end
