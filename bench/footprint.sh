#!/bin/sh
# sh bench/footprint.sh CC: what each header costs - code, stack, memory of a point, compile time - as a table of
# docs/performance.md, between its two marks. Code and stack are the header's own; compiling it means compiling mpm.h
# with it.
set -eu
cc=${1:-cc}
dir=build/footprint
page=docs/performance.md
rm -rf "$dir"
mkdir -p "$dir"
flags="-std=c99 -ffp-contract=off -I."

unit() { # header: the implementation of it alone
    printf '#define MPM_IMPLEMENTATION\n#include "%s"\n' "$1" >"$dir/$1.c"
}
section() { # object, pattern: bytes in its sections of that name
    size -A "$1" | awk -v p="$2" '$1 ~ p { n += $2 } END { print n + 0 }'
}
frame() { # header: bytes and name of its function with the largest frame
    grep "/\{0,1\}$1:" "$dir/$1.su" | awk -F '[:\t]' '$5 > most { most = $5; name = $4 } END { print most + 0, name }'
}
chain() { # header: bytes of the deepest chain of calls that begins in it; calls through pointers are not followed
    [ -f "$dir/$1.ci" ] || { echo 0; return; }
    awk -F '"' -v h="$1:" '
        /^node:/ && /bytes/ {
            split($4, part, "\\\\n")
            own[$2] = part[3] + 0
            if (index(part[2], h)) begins[$2] = 1
        }
        /^edge:/ { calls[$2, ++n[$2]] = $4 }
        function depth(f, i, d, most) {
            if (f in known) return known[f]
            known[f] = own[f] + 0
            for (i = 1; i <= n[f]; i++) {
                d = depth(calls[f, i])
                if (d > most) most = d
            }
            return known[f] = own[f] + most
        }
        END { for (f in begins) if (depth(f) > deepest) deepest = depth(f); print deepest + 0 }' "$dir/$1.ci"
}
compile() { # header, level: "0.52 s, 61 MB", processor time and memory, the median of three
    for turn in 1 2 3; do
        command time -f '%U %S %M' "$cc" $flags "$2" -c "$dir/$1.c" -o "$dir/timed.o" 2>&1
    done | awk '{ print $1 + $2, $3 }' | sort -n | awk 'NR == 2 { printf "%.2f s, %.0f MB", $1, $2 / 1024 }'
}
row() { # header, code and constants that are not its own
    unit "$1"
    "$cc" $flags -O2 -fstack-usage $graph -c "$dir/$1.c" -o "$dir/$1.o"
    code=$(section "$dir/$1.o" '^[.]text')
    data=$(section "$dir/$1.o" '^[.](ro)?data')
    printf '| `%s` | %.1f | %.1f | %s | %s | %s | %s | %s |\n' "$1" \
        "$(echo "$code $2" | awk '{ print ($1 - $2) / 1024 }')" "$(echo "$data $3" | awk '{ print ($1 - $2) / 1024 }')" \
        "$(frame "$1" | awk '{ printf "%.1f `%s`", $1 / 1024, $2 }')" \
        "$(chain "$1" | awk '{ if ($1) printf "%.1f", $1 / 1024; else print "?" }')" \
        "$(compile "$1" -O0)" "$(compile "$1" -O2)" "$(compile "$1" -O3)"
}
bytes() { # flags: what a point, a node and a particle of the spray take, from the sizes the library asks for
    cat >"$dir/bytes.c" <<'END'
#define MPM_IMPLEMENTATION
#include "mpm.h"
#include "mpm_spray.h"
#include <stdio.h>
static double world(int points, int nodes)
{
    mpm_desc d = mpm_desc_default();
    d.cell = 1;
    d.cells[0] = d.cells[1] = d.cells[2] = 10;
    d.bodies = 2;
    d.points = points;
    d.nodes = nodes;
    return (double)mpm_bytes(&d);
}
static double spray(int particles)
{
    mpm_spray_desc d = mpm_spray_desc_default();
    d.capacity = particles;
    return (double)mpm_spray_bytes(&d);
}
int main(void)
{
    const int n = 1 << 20; /* so many that the rounding of each array does not show */
    printf("%.0f %.0f %.0f\n", (world(2 * n, n) - world(n, n)) / n, (world(n, 2 * n) - world(n, n)) / n,
           (spray(2 * n) - spray(n)) / n);
    return 0;
}
END
    "$cc" $flags $1 "$dir/bytes.c" -o "$dir/bytes" -lm
    "$dir/bytes"
}
compiler() { # its name and version
    name=gcc
    "$cc" -dM -E - </dev/null | grep -q __clang__ && name=clang
    echo "$name $("$cc" --version | sed -n '1s/.* \([0-9][0-9.]*\).*/\1/p')"
}
table() {
    printf 'Own code and constants of each header at `-O2`, its largest stack frame and deepest chain of calls\n'
    printf '(what callbacks and libc add is not in it), all in KiB; processor time and memory to compile it with `mpm.h`.\n'
    printf '%s, %s.\n\n' "$(compiler)" "$(uname -m)"
    echo '| header | code | constants | largest frame | deepest chain | compile `-O0` | `-O2` | `-O3` |'
    echo '|---|---|---|---|---|---|---|---|'
    row mpm.h 0 0
    core_code=$(section "$dir/mpm.h.o" '^[.]text')
    core_data=$(section "$dir/mpm.h.o" '^[.](ro)?data')
    for h in mpm_*.h; do row "$h" "$core_code" "$core_data"; done
    set -- $(bytes "") $(bytes -DMPM_FLOAT)
    printf '\nMemory in bytes, double and float: a point %s and %s, a node of a body with its run and pair %s and %s, a particle of the spray %s and %s.\n' \
        "$1" "$4" "$2" "$5" "$3" "$6"
}

echo 'int x;' >"$dir/probe.c"
graph=-fcallgraph-info=su # gcc's; without it the chains stay unknown
"$cc" $graph -c "$dir/probe.c" -o "$dir/probe.o" 2>/dev/null || graph=
table >"$dir/table.md"
cat "$dir/table.md"
begin='<!-- made by make footprint: begin -->'
end='<!-- made by make footprint: end -->'
if grep -qx "$begin" "$page" && grep -qx "$end" "$page"; then
    awk -v b="$begin" -v e="$end" -v t="$dir/table.md" '
        $0 == e { while ((getline line <t) > 0) print line; inside = 0 }
        !inside
        $0 == b { inside = 1 }' "$page" >"$page.part" && mv "$page.part" "$page"
else
    echo "$page has no line '$begin' or '$end': the table was not put in"
fi
