#!/bin/sh
# sh tests/coverage.sh JOBS TEST...: builds the test programs with gcc --coverage, runs them, JOBS at a time, and
# prints which share of each header's lines and branches they reached; the lines that none did stand in
# build/coverage/missed. Exit 1 where a program fails, or 98 % of all lines are not reached.
set -u
dir=build/coverage
flags="-std=c99 -O1 --coverage -ffp-contract=off -DMPM_NO_INLINE -I. -Iexamples -Iexamples/studies -Itests"
if [ "$1" = --one ]; then # this script again, as one of the jobs
    name=$(basename "$2" .c)
    gcc $flags "$2" -o "$dir/$name" -lm >"$dir/$name.log" 2>&1 || { echo "$name does not compile"; exit 1; }
    timeout 1200 "$dir/$name" >"$dir/$name.log" 2>&1 || { echo "$name: $(tail -n 1 "$dir/$name.log")"; exit 1; }
    gcov -b -c -t "$dir/$name"*.gcda 2>/dev/null | gzip >"$dir/$name.gcov.gz"
    exit
fi
command -v gcov >/dev/null 2>&1 || { echo "skip: coverage: gcov is not installed"; exit 0; }
jobs=$1
shift
rm -rf $dir
mkdir -p $dir build/tests
printf '%s\n' "$@" | xargs -P "$jobs" -n 1 sh "$0" --one
failed=$?
# a line or branch counts if any test reached it
cat $dir/*.gcov.gz | gunzip | awk -v missed=$dir/missed '
    /^ *-: *0:Source:/ { sub(/.*Source:/, ""); h = /^mpm[a-z_]*\.h$/ ? $0 : "" }
    h == "" { next }
    /^ *[0-9#=*-]+: *[0-9]+:/ {
        split($0, f, ":"); n = f[1]; gsub(/[ *]/, "", n); at = h ":" f[2] + 0; k = 0
        if (n == "-") next
        if (!(at in seen)) { seen[at] = $0; lines[h]++ }
        if (n !~ /[#=]/ && !(at in hit)) { hit[at] = 1; reached[h]++ }
    }
    /^branch/ {
        b = at ":" k++
        if (!(b in branch)) { branch[b] = 1; branches[h]++ }
        if (/taken [1-9]/ && !(b in taken)) { taken[b] = 1; went[h]++ }
    }
    function row(name, n, of, b, bs) {
        printf "%-16s lines %5.1f %% of %d, branches %5.1f %% of %d\n", name, 100 * n / of, of, 100 * b / (bs + !bs), bs
    }
    END {
        for (at in seen) if (!(at in hit)) { sub(/^[^:]*:[^:]*:/, "", seen[at]); print at ":" seen[at] >missed }
        for (h in lines) {
            row(h, reached[h], lines[h], went[h], branches[h])
            n += reached[h]; of += lines[h]; b += went[h]; bs += branches[h]
        }
        row("~ all", n, of, b, bs)
        exit !(n >= 0.98 * of)
    }' >$dir/table
enough=$?
sort $dir/table | sed 's/^~ //'
[ $failed -eq 0 ] && [ $enough -eq 0 ]
