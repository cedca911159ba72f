#!/bin/sh
# sh tests/coverage.sh "TEST...": builds the test programs with gcc --coverage at -O0, runs them, and prints which share
# of each header's lines and branches they reached.
set -u
dir=build/coverage
command -v gcov >/dev/null 2>&1 || { echo "skip: coverage: gcov is not installed"; exit 0; }
rm -rf $dir
mkdir -p $dir build/tests
for t in $1; do
    name=$(basename "$t" .c)
    gcc -std=c99 -O0 --coverage -ffp-contract=off -DMPM_NO_INLINE -I. -Iexamples -Iexamples/studies -Itests "$t" -o "$dir/$name" -lm \
        2>"$dir/$name.log" || { echo "$name does not compile"; continue; }
    timeout 1200 "$dir/$name" >"$dir/$name.log" 2>&1 || echo "$name: $(tail -n 1 "$dir/$name.log")"
done
# a line or branch counts if any test reached it
for t in $dir/*.gcda; do gcov -b -c -t "$t" 2>/dev/null; done | awk '
    /^ *-: *0:Source:/ { sub(/.*Source:/, ""); h = /^mpm[a-z_]*\.h$/ ? $0 : "" }
    h == "" { next }
    /^ *[0-9#=*-]+: *[0-9]+:/ {
        split($0, f, ":"); n = f[1]; gsub(/[ *]/, "", n); at = h ":" f[2] + 0; k = 0
        if (n == "-") next
        if (!(at in seen)) { seen[at] = 1; lines[h]++ }
        if (n !~ /[#=]/ && !(at in hit)) { hit[at] = 1; reached[h]++ }
    }
    /^branch/ {
        b = at ":" k++
        if (!(b in branch)) { branch[b] = 1; branches[h]++ }
        if (/taken [1-9]/ && !(b in taken)) { taken[b] = 1; went[h]++ }
    }
    END { for (h in lines) printf "%-16s lines %5.1f %% of %d, branches %5.1f %% of %d\n", h, 100 * reached[h] / lines[h],
                                  lines[h], 100 * went[h] / (branches[h] ? branches[h] : 1), branches[h] }' | sort
