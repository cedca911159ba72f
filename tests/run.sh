#!/bin/sh
# Runs the test programs given before "--", then the compile tests with the compiler given behind it,
# and closes with one count over all of them.
set -u
passed=0
failed=0
count() { # adds up the closing lines "N passed, N failed" of a log
    p=$(sed -n 's/^\([0-9]*\) passed, \([0-9]*\) failed$/\1/p' "$1" | tail -n 1)
    f=$(sed -n 's/^\([0-9]*\) passed, \([0-9]*\) failed$/\2/p' "$1" | tail -n 1)
    if [ -z "$p" ]; then # the program died before its closing line
        p=0
        f=1
    fi
    passed=$((passed + p))
    failed=$((failed + f))
}
mkdir -p build/tests
while [ $# -gt 0 ] && [ "$1" != "--" ]; do
    log=$1.log
    "$1" >"$log" 2>&1
    count "$log"
    printf '%-32s %s\n' "$(basename "$1")" "$(tail -n 1 "$log")"
    grep '^not ok' "$log"
    shift
done
[ $# -gt 0 ] && shift
sh tests/compile/run.sh "${1:-cc}" >build/tests/compile.log 2>&1
count build/tests/compile.log
printf '%-32s %s\n' compile "$(tail -n 1 build/tests/compile.log)"
grep -E '^(not ok|skip)' build/tests/compile.log
echo "$passed passed, $failed failed"
[ "$failed" -eq 0 ]
