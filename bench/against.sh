#!/bin/sh
# sh bench/against.sh REV N CC CFLAGS...: bench/step of another revision and of this tree, N times each, in turns on
# the same machine: the medians of both, and the ratio of the speeds. Above 1: this tree is faster.
set -eu
rev=$1
n=$2
cc=$3
shift 3
flags="$*"
dir=build/against
rm -rf "$dir"
mkdir -p "$dir/tree"
git archive "$rev" | tar xf - -C "$dir/tree"
make -s -C "$dir/tree" build/bench/step CC="$cc" CFLAGS="$flags"
make -s build/bench/step CC="$cc" CFLAGS="$flags"

i=0
while [ $i -lt "$n" ]; do
    i=$((i + 1))
    "$dir/tree/build/bench/step" >>"$dir/then.txt"
    build/bench/step >>"$dir/now.txt"
    echo "$i of $n" >&2
done
# Every line "  name  X ns per point-step ...": name, X. Two or more blanks end a name.
spent() { sed -n 's/^  \([a-z].*[a-z0-9]\)  *\([0-9.]*\) ns per point-step.*/\1|\2/p' "$1"; }
{ spent "$dir/then.txt" | sed 's/^/then|/' && spent "$dir/now.txt" | sed 's/^/now|/'; } | awk -F '|' -v rev="$rev" '
    { value[$1, $2, ++count[$1, $2]] = $3 }
    $1 == "now" && count[$1, $2] == 1 { name[++names] = $2 }
    function median(which, phase, n, i, j, v) {
        n = count[which, phase]
        for (i = 2; i <= n; i++) { # put each value in its place among those before it
            v = value[which, phase, i]
            for (j = i - 1; j && value[which, phase, j] > v; j--) value[which, phase, j + 1] = value[which, phase, j]
            value[which, phase, j + 1] = v
        }
        return (value[which, phase, int((n + 1) / 2)] + value[which, phase, int(n / 2) + 1]) / 2
    }
    END {
        printf "%-20s %10s %10s %10s\n", "ns per point-step", substr(rev, 1, 10), "this tree", "speed"
        for (i = 1; i <= names; i++) {
            if (!count["then", name[i]]) continue
            a = median("then", name[i])
            b = median("now", name[i])
            printf "%-20s %10.2f %10.2f %10.3f\n", name[i], a, b, a / b
        }
    }'
for which in then now; do sed -n "s/^  *\([0-9]* bytes per point\)/$which: \1/p" "$dir/$which.txt" | tail -n 1; done
