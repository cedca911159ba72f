#!/bin/sh
# The prediction's tables: docs/prediction.md and docs/data/prediction*.csv. Called by `make predict`.
#   sh examples/studies/prediction.sh POSITIONS JOBS
# What is run is planned in one list, JOBS at a time; the tables are read from what the runs leave in build/predict. There
# a run is kept and not repeated while version and options are those asked for; delete the folder after changing the
# headers. Pages, tables and pictures get their names when they are whole.
set -eu
out=build/predict
version=$(sed -n 's/^.define MPM_VERSION "\(.*\)"/\1/p' mpm.h)
value() { # file, key
    sed -n "s/^  \"$2\": \([^,]*\),*$/\1/p" "$1"
}
same() { # summary, options: whether it is of this version and these options
    awk -v version="$version" '
        BEGIN {
            for (i = 2; i < ARGC; i++)
                if (ARGV[i] ~ /^--/) {
                    name = substr(ARGV[i], 3)
                    want[name] = i + 1 < ARGC && ARGV[i + 1] !~ /^--/ ? ARGV[i + 1] : "on"
                }
            ARGC = 2
        }
        /^ *"[^"]*": / {
            key = $0; sub(/^ *"/, "", key); sub(/".*/, "", key)
            text = $0; sub(/^ *"[^"]*": /, "", text); sub(/,$/, "", text); gsub(/"/, "", text)
            if (key == "mpm_version") known = text == version
            else if (key == "options") inside = 1
            else if (inside && key in want && (text == want[key] || (text ~ /^[-0-9]/ && text + 0 == want[key] + 0)))
                delete want[key]
        }
        /^}/ { whole = 1 }
        END { for (key in want) known = 0; exit !(known && whole) }' "$@"
}
impact() { # name, options: an impact whose folder is kept
    name=$1
    shift
    if [ -s "$out/$name/summary.json" ]; then
        same "$out/$name/summary.json" --method surface "$@" && return
        echo "$out/$name is of another version or other options: it is run again" >&2
        rm -f "$out/$name/summary.json" # it would stand for this run
    fi
    build/impact --method surface --quiet --out "$out/$name" "$@"
}
critical() { # name, options: a critical velocity, whose runs it keeps itself
    name=$1
    shift
    build/critical_velocity --method surface --step 6 --quiet --out "$out/$name" "$@"
}
if [ "${1:-}" = --one ]; then # a line of the plan
    shift
    "$@"
    exit
fi
positions=${1:-4} jobs=${2:-1}
mkdir -p "$out" docs/data
picture=docs/surface.png table=docs/data/prediction_unbonded.csv curve=docs/data/prediction.csv page=docs/prediction.md
held=docs/data/prediction_held_out.csv
trap 'rm -f $picture.part $table.part $curve.part $page.part $held.part' EXIT
trap 'exit 1' HUP INT TERM

# ---- what there is to run
sizes="14 18 22 26 30"
grids="1_0.25_35 0.7_0.175_35 0.5_0.125_35 0.5_0.125_50" # cell, spacing, substrate's diameter, um; of 14 um
outs="45_550_rebounds 38_780_bonds 22_752_rebounds 22_1066_bonds" # um, m/s, measured
grid() { # cell_spacing_substrate: as options
    echo "$1" | awk -F_ '{ printf "--cell %s --spacing %s --substrate-diameter %s --substrate-height %s", $1, $2, $3, $3 / 2 }'
}
many() { # positions on a grid: eight, on the wide substrate two
    case $1 in *_50) echo $(((positions + 1) / 2)) ;; *) echo $((2 * positions)) ;; esac
}
each() { # offsets of the grid, as parts of a cell
    awk -v n="$1" 'BEGIN { for (k = 0; k < n; k++) printf "%g ", k / n }'
}
product() { awk -v a="$1" -v b="$2" 'BEGIN { printf "%.6g", a * b }'; }
plan() {
    for d in $sizes; do echo "critical critical_$d --diameter $d --offsets $positions"; done
    echo "critical critical_14_coarse --cell 1 --offsets $positions"
    echo "critical critical_14_middle --cell 0.7 --offsets $positions"
    echo "critical critical_14_wide --substrate-diameter 50 --substrate-height 25 --offsets $(((positions + 3) / 4))"
    echo "critical critical_14_steps --dt-factor 0.1 --offsets $(((positions + 3) / 4))"
    echo "impact picture --frames 1 --velocity 840"
    for o in $outs; do
        d=${o%%_*} v=${o#*_} v=${v%%_*}
        for part in $(each "$positions"); do
            echo "impact held_${d}_${v}_$part --frames 0 --diameter $d --velocity $v --grid-offset $(product "$part" "$(product "$d" 0.0357142857)")"
        done
    done
    for g in $grids; do
        for part in $(each "$(many "$g")"); do
            echo "impact unbonded_${g}_$part --bond none --frames 0 $(grid "$g") --grid-offset $(product "$part" "${g%%_*}")"
        done
    done
}
[ -s "$out/picture/impact.png" ] || rm -f "$out/picture/summary.json"
plan | xargs -P "$jobs" -L 1 sh "$0" --one

# ---- the tables
{
    echo "cell_um,spacing_um,substrate_um,part_of_cell,rebound_m_s,mean_strain,contact_fraction,energy_unaccounted,noise_m_s,cpu_s"
    for g in $grids; do
        for part in $(each "$(many "$g")"); do
            s=$out/unbonded_${g}_$part/summary.json
            echo "$(echo "$g" | tr _ ,),$part,$(value "$s" v_rest_relative_m_s),$(value "$s" eps_mean),$(value "$s" energy_contact_fraction),$(value "$s" energy_unaccounted),$(value "$s" v_noise_m_s),$(value "$s" cpu_seconds)"
        done
    done
} >$table.part
mv $table.part $table
cp "$out/picture/impact.png" $picture.part
mv $picture.part $picture
cpu_of() { sed -n 's/^  "cpu_s": \([^,]*\),*$/\1/p' "$@" | awk '{ s += $1 } END { printf "%.0f", s }'; } # kept runs
option() { # file, name: a number among the options
    sed -n "s/^    \"$2\": \([^,]*\),*$/\1/p" "$1"
}
row() { # name of a critical velocity
    s=$out/$1/summary.json
    echo "$(option "$s" diameter),$(value "$s" critical_velocity_m_s),$(value "$s" lowest_m_s),$(value "$s" highest_m_s),$(option "$s" offsets),$(option "$s" cell),$(option "$s" spacing),cubic,surface,interface,$(option "$s" substrate-diameter),axisymmetric,$(cpu_of "$out/$1"/runs/*.json),$(option "$s" dt-factor)"
}
{
    echo "diameter_um,critical_velocity_m_s,lowest_m_s,highest_m_s,positions,cell_um,spacing_um,basis,contact,bond,substrate_um,geometry,cpu_s,dt_factor"
    for d in $sizes 14_coarse 14_middle 14_wide 14_steps; do row "critical_$d"; done
} >$curve.part
mv $curve.part $curve
{
    echo "diameter_um,velocity_m_s,part_of_cell,rebound_m_s,held,measured"
    for o in $outs; do
        d=${o%%_*} v=${o#*_} v=${v%%_*}
        for part in $(each "$positions"); do
            s=$out/held_${d}_${v}_$part/summary.json
            echo "$d,$v,$part,$(value "$s" v_rest_relative_m_s),$(value "$s" held_pairs),${o##*_}"
        done
    done
} >$held.part
mv $held.part $held

# ---- the page
rows() { awk -F, "$1" "$2"; }
lines() { # the unbonded runs, grid by grid
    rows 'NR > 1 {
            g = $1 " | " $2 " | " $3
            if (!(g in n)) { order[++grids] = g; low[g] = high[g] = $5 }
            n[g]++; if ($5 < low[g]) low[g] = $5; if ($5 > high[g]) high[g] = $5
            s[g] += $6; q[g] += $6 * $6; c[g] += $7; d[g] += $7 * $7; t[g] += $10
        }
        function sd(s, q, n) { s /= n; q = q / n - s * s; return 100 * sqrt(q > 0 ? q : 0) / s }
        END {
            for (k = 1; k <= grids; k++) {
                g = order[k]
                printf "| %s | %d | %.1f - %.1f | %.3f, sd %.1f %% | %.2f %%, sd %.1f %% | %.0f |\n", g, n[g], low[g],
                    high[g], s[g] / n[g], sd(s[g], q[g], n[g]), 100 * c[g] / n[g], sd(c[g], d[g], n[g]), t[g] / n[g]
            }
        }' $table
}
{
    sed '/^| diameter/,$d' $page
    echo "| diameter, um | cell, um | substrate, um | time step over the critical one | positions | critical velocity, m/s | lowest | highest | CPU, s |"
    echo "|---|---|---|---|---|---|---|---|---|"
    rows 'NR > 1 { printf "| %s | %.4g | %s | %.2g | %s | %.0f | %.0f | %.0f | %s |\n", $1, $6, $11, $14 * 0.5 / $6, $5, $2, $3, $4, $13 }' $curve
    echo
    echo "| held out: diameter, um | velocity, m/s | measured | stays at | rebound, m/s |"
    echo "|---|---|---|---|---|"
    rows 'NR > 1 {
            g = $1 " | " $2 " | " $6
            if (!(g in n)) { order[++all] = g; low[g] = high[g] = $4 }
            n[g]++; stays[g] += $5 > 0 && $4 < 5
            if ($4 < low[g]) low[g] = $4; if ($4 > high[g]) high[g] = $4
        }
        END {
            for (k = 1; k <= all; k++) {
                g = order[k]
                printf "| %s | %d of %d positions | %.1f - %.1f |\n", g, stays[g], n[g], low[g], high[g]
            }
        }' $held
    echo
    echo "| unbonded: cell, um | spacing, um | substrate, um | positions | rebound, m/s | mean plastic strain | lost in contact | CPU, s |"
    echo "|---|---|---|---|---|---|---|---|"
    lines
} >$page.part
mv $page.part $page
