#!/bin/sh
# sh bench/performance.sh: what a step costs, on the job of examples/bench_impact, as the table of docs/performance.md
# between its two marks. A row is one run: read ratios within a table, not across machines.
set -eu
page=docs/performance.md
table=build/performance.md
mkdir -p build

row() { # words, options of build/bench_impact
    words=$1
    shift
    build/bench_impact --quiet "$@" | awk -v words="$words" -v options="$*" '
        /points, block/ { points = $2 + $5; steps = $7 }
        /^  stress/ { stress = $2 }
        /whole step/ { whole = $3 }
        /bytes per point/ { bytes = $4 }
        END {
            printf "| %s | `%s` | %d | %d | %.0f | %s | %.2f | %d |\n", words, options, points, steps, whole,
                stress ? sprintf("%.0f", stress) : "", 1e3 / whole, bytes
        }'
}
{
    echo '| | options | points | steps | ns per point-step | of it the law and strain | million point-steps per CPU second | bytes per point |'
    echo '|---|---|---|---|---|---|---|---|'
    for law in elastic jc ptw; do
        row "$law, phase by phase" --law $law
        row "$law, \`mpm_step\`" --law $law --sweeps
    done
    for functions in gimp quadratic cubic; do
        row "$functions" --law elastic --functions $functions --time 5 --sweeps
    done
    row 'no contact: one field' --law elastic --contact weld --sweeps
    row 'an eighth of the points' --law elastic --cell 2 --spacing 1 --sweeps
    row 'eight times the points' --law elastic --cell 0.5 --spacing 0.25 --time 3 --sweeps
    row '64 points in a cell' --law elastic --cell 2 --sweeps
} | tee "$table"
awk -v t="$table" '
    $0 == "<!-- made by make bench: end -->" { while ((getline line <t) > 0) print line; inside = 0 }
    !inside
    $0 == "<!-- made by make bench: begin -->" { inside = 1 }' "$page" >"$page.part" && mv "$page.part" "$page"
