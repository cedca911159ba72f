#!/bin/sh
# Runs the test programs given before "--", then with the compiler given behind it the compile tests, the index of
# equations (tags) and the programs of comments and pages; closes with one count over all of them.
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
for script in compile/run tags programs; do
    name=${script%/run}
    log=build/tests/$name.log
    sh "tests/$script.sh" "${1:-cc}" >"$log" 2>&1
    count "$log"
    printf '%-32s %s\n' "$name" "$(tail -n 1 "$log")"
    grep -E '^(not ok|skip)' "$log"
done
echo "$passed passed, $failed failed"
[ "$failed" -eq 0 ]
