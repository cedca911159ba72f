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
passed=0
failed=0
result() { # ok?, what
    if [ "$1" -eq 0 ]; then
        passed=$((passed + 1))
        echo "ok - $2"
    else
        failed=$((failed + 1))
        echo "not ok - $2"
    fi
}
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
for h in mpm*.h; do
    [ -f "$dir/$h.1.c" ]
    result $? "$h has a complete program"
done
for c in "$dir"/*.c; do
    name=$(basename "$c" .c)
    $cc -std=c99 -pedantic -Wall -Wextra -Werror -O2 "-I$top" "$c" -o "$dir/$name.run" -lm >"$dir/$name.cc" 2>&1
    result $? "$name compiles: $(head -n 1 "$dir/$name.cc")"
    [ -f "$dir/$name.run" ] || continue
    (cd "$dir" && "./$name.run" >"$name.out" 2>&1)
    result $? "$name ends with 0: $(tail -n 1 "$dir/$name.out")"
    [ -f "$dir/$name.heading" ] || continue
    tr '\n' ' ' <"$dir/$name.heading" | sed 's/  */ /g' | grep -oE '"[^"]*"|PBCP [0-9.]+ %' |
        tr -d '"' >"$dir/$name.says"
    while read -r text; do
        grep -qF -- "$text" "$dir/$name.out"
        result $? "$name prints $text"
    done <"$dir/$name.says"
done
# What is printed and lost is an error: of every program with options, by running it (built ones; make builds all);
# of the short ones, by their last line.
for c in examples/*.c examples/studies/*.c examples/studies/reproduction/main.c; do
    name=$(basename "$c" .c)
    [ "$name" = main ] && name=reproduction
    grep -qE 'int main\(' "$c" || continue
    grep -qE 'return (program_end\(|fflush\(stdout\) \|\| ferror)' "$c"
    result $? "$c ends with a look at standard output"
    [ -c /dev/full ] && [ -x "build/$name" ] && grep -q program_end "$c" || continue
    "build/$name" --help >/dev/full 2>"$dir/full"
    grep -q "standard output" "$dir/full"
    result $? "$name says that standard output is full"
    ! "build/$name" --help >/dev/full 2>&1
    result $? "... and ends with another status than 0"
done
echo "$passed passed, $failed failed"
[ "$failed" -eq 0 ]
