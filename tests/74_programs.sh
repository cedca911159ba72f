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
# The job that other codes are timed on: its points, its books, whatever is chosen.
job() { # options...: few points, unless said otherwise; what it prints to $dir/job
    build/bench_impact --quiet --spacing 1 --time 1 "$@" >"$dir/job"
}
books() { # momentum to round-off, less than 1 % of the energy unaccounted for
    awk '/^  momentum error/ { m = $3 + 0; seen++ } /^  energy unaccounted/ { e = $3 + 0; seen++ }
         END { exit !(seen == 2 && m < 1e-12 && e < 1 && e > -1) }' "$dir/job"
}
if [ -x build/bench_impact ]; then
    check "bench_impact runs a step of its job" job --spacing 0.5 --time 0.01
    check "... of 57 856 and 144 000 points" grep -q "^sphere 57856 points, block 144000 points, 1 steps" "$dir/job"
    for choice in "--law jc" "--law elastic" "--law ptw" "--contact weld" "--functions gimp"; do
        # shellcheck disable=SC2086
        check "bench_impact $choice" job $choice
        check "... conserves momentum and energy" books
        check "... and says what it costs" grep -q "^  point-steps per CPU second *[1-9]" "$dir/job"
    done
    check "bench_impact refuses a spacing" sh -c "! build/bench_impact --spacing 0 2>'$dir/refused' &&
        grep -q 'spacing 0' '$dir/refused'"
fi
# Manners: every program with options tells its version; a run says how far it is at every tenth; and one that is asked
# to stop says how it goes on, and then leaves what an uninterrupted one does.
version=$(sed -n 's/^.define MPM_VERSION "\(.*\)"/\1/p' mpm.h)
tells_version() { [ "$("$1" --version)" = "mpm.h $version" ]; }
for c in examples/*.c examples/studies/*.c; do
    name=$(basename "$c" .c)
    grep -q options_parse "$c" && [ -x "build/$name" ] || continue
    check "$name tells its version" tells_version "build/$name"
done
stop() { # file to wait for, command...: asked to stop when the file is there, it must say so; how it goes on to $dir/goes_on
    awaited=$1
    shift
    "$@" >"$dir/stopped" &
    n=0
    while [ ! -f "$awaited" ] && [ $n -lt 300 ]; do
        sleep 0.1
        n=$((n + 1))
    done
    kill -TERM $!
    wait $!
    [ $? -eq 3 ] && sed -n '/^stopped at step [1-9]/ { n; s/^ *//; p; }' "$dir/stopped" >"$dir/goes_on" &&
        [ -s "$dir/goes_on" ]
}
same_but_time() { # two folders: the same files, but for seconds and speeds
    [ "$(cd "$1" && ls)" = "$(cd "$2" && ls)" ] || return 1
    for file in "$1"/*; do
        case $file in
        *.json) for folder in "$1" "$2"; do
                    grep -vE '"(cpu_seconds|out|quiet|resume|checkpoint|stop-after|.*per_second|.*per_cpu_second)"' "$folder/$(basename "$file")" \
                        >"$dir/$(basename "$folder").json"
                done
                cmp "$dir/$(basename "$1").json" "$dir/$(basename "$2").json" || return 1 ;;
        *checkpoint.bin) ;; # holds CPU seconds, or stands for a run that ended
        *) cmp "$file" "$2/$(basename "$file")" || return 1 ;;
        esac
    done
}
stopped_and_on() { # program, file to wait for, options...
    name=$1
    awaited=$2
    shift 2
    [ -x "build/$name" ] && "build/$name" --help | grep -q -- --resume || return 0
    check "$name runs to its end" sh -c '"$@" >/dev/null 2>"$0"' "$dir/lines" "build/$name" --out "$dir/whole" "$@"
    check "... and says so at every tenth" [ "$(grep -c ' %' "$dir/lines")" -eq 10 ]
    check "... asked to stop, it says how it goes on" stop "$dir/parts/$awaited" "build/$name" --quiet --checkpoint 0.2 \
        --out "$dir/parts" "$@"
    check "... and goes on" sh -e "$dir/goes_on"
    check "... to the same files" same_but_time "$dir/whole" "$dir/parts"
    rm -rf "$dir/whole" "$dir/parts"
}
stopped_and_on impact points_0001.vtu --time 3 --spacing 0.75 --frames 5
stopped_and_on taylor points_0001.vtu --time 40 --cell 0.4 --spacing 0.2 --frames 5
stopped_and_on spray spray-000001500.vtu --time 0.06 --speed 100 --release 50:100 --stand-off 0.05 --feed 4e5 \
    --alpha inf --frames 8
check_end
