#!/bin/sh
# sh tests/run.sh JOBS CC TEST...: runs the tests, JOBS at a time, and closes with one count over all of them.
# A test is a program, or a script that is given the compiler's name. A program's twin NAME_f32 runs behind it,
# not beside it: both write the same files. Every test has a log of its own; they are shown in the order given.
set -u
name_of() { echo "$1" | sed 's,^build/,,; s,^tests/,,; s,/run\.sh$,,; s,\.sh$,,'; }
run() { # compiler, test: the log gets its name when it is whole
    log=build/tests/$(name_of "$2").log
    case $2 in
    *.sh) sh "$2" "$1" ;;
    *) "$2" ;;
    esac >"$log.part" 2>&1
    close "$log.part" $? >>"$log.part"
    mv "$log.part" "$log"
}
closing() { sed -n '/^[0-9]* passed, [0-9]* failed$/p' "$1" | tail -n 1; }
close() { # log, exit status: one more failure, with its reason, where the closing line says too little
    line=$(closing "$1")
    why=
    case $line in
    '') why="it died before its closing line, exit status $2" ;;
    '0 passed, 0 failed') why="it checked nothing, exit status $2" ;;
    *', 0 failed') [ "$2" -eq 0 ] || why="exit status $2" ;;
    esac
    [ -z "$why" ] || printf 'not ok - %s\n%d passed, 1 failed\n' "$why" "${line%% *}"
}
if [ "$1" = --one ]; then # this script again, as one of the jobs
    run "$2" "$3"
    [ -x "$3_f32" ] && run "$2" "$3_f32"
    exit 0
fi
jobs=$1
cc=$2
shift 2
passed=0
failed=0
count() { # adds up the closing line "N passed, N failed" of a log
    line=$(closing "$1")
    f=${line#* passed, }
    passed=$((passed + ${line%% *}))
    failed=$((failed + ${f% failed}))
}
show() { # test: its closing line and what a person must see, as soon as it is done
    log=build/tests/$(name_of "$1").log
    until [ -f "$log" ] || [ -f build/tests/done ]; do sleep 1; done
    [ -f "$log" ] || printf 'not ok - it did not run\n0 passed, 1 failed\n' >"$log"
    count "$log"
    printf '%-32s %s\n' "$(name_of "$1")" "$line"
    grep -E '^(not ok|skip)' "$log"
}
show_all() {
    for t in "$@"; do
        show "$t"
        [ -x "${t}_f32" ] && show "${t}_f32"
    done
    echo "$passed passed, $failed failed"
    [ "$failed" -eq 0 ] && [ "$passed" -gt 0 ]
}
mkdir -p build/tests
rm -f build/tests/*.log build/tests/done
trap ': >build/tests/done' EXIT
trap 'exit 130' INT TERM
show_all "$@" &
printf '%s\n' "$@" | xargs -P "$jobs" -n 1 sh "$0" --one "$cc"
: >build/tests/done
wait $!
