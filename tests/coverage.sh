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
for h in mpm*.h; do
    for t in $dir/*.gcda; do
        (cd $dir && gcov -b -c -s "$OLDPWD" -r -o . "$(basename "$t")" >/dev/null 2>&1; [ -f "$h.gcov" ] && cat "$h.gcov")
    done | awk -v h="$h" '
        /^ *[0-9#=-]+\*?: *[0-9]+:/ { split($0, f, ":"); line = f[2] + 0; n = f[1]; gsub(/[ *]/, "", n); k = 0
            if (n != "-") { seen[line] = 1; if (n !~ /#|=/) hit[line] = 1 } }
        /^branch/ { key = line ":" k++; branch[key] = 1; if ($0 ~ /taken [1-9]/) taken[key] = 1 }
        END { for (l in seen) { lines++; if (l in hit) run++ }
              for (b in branch) { branches++; if (b in taken) went++ }
              if (lines) printf "%-16s lines %5.1f %% of %d, branches %5.1f %% of %d\n", h, 100 * run / lines, lines,
                                100 * went / (branches ? branches : 1), branches }'
done
