#!/bin/sh
# The prediction's tables: docs/prediction.md and docs/data/prediction*.csv. Called by `make predict`.
#   sh examples/studies/prediction.sh POSITIONS
# Runs of a position are kept in build/predict and not repeated while version and options are those asked for; delete the
# folder after changing the headers. Pages, tables and pictures get their names when they are whole.
set -eu
positions=${1:-4}
out=build/predict
mkdir -p "$out" docs/data
version=$(sed -n 's/^.define MPM_VERSION "\(.*\)"/\1/p' mpm.h)
picture=docs/surface.png table=docs/data/prediction_unbonded.csv curve=docs/data/prediction.csv page=docs/prediction.md
trap 'rm -f $picture.part $table.part $curve.part $page.part' EXIT
trap 'exit 1' HUP INT TERM
common="--geometry axisymmetric --functions cubic --contact surface --springs --scheme consistent --gap 0.3"
half="--substrate-diameter 50 --substrate-height 25"
value() { # file, key
    sed -n "s/^  \"$2\": \([^,]*\),*$/\1/p" "$1"
}
cpu_of() { sed -n 's/^  "cpu_s": \([^,]*\),*$/\1/p' "$@" | awk '{ s += $1 } END { printf "%.0f", s }'; } # kept runs
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
        same "$out/$name/summary.json" $common "$@" && return
        echo "$out/$name is of another version or other options: it is run again" >&2
        rm -f "$out/$name/summary.json" # it would stand for this run
    fi
    build/impact $common --quiet --out "$out/$name" "$@"
}
offset() { awk -v k="$1" -v n="$2" -v cell="$3" 'BEGIN { printf "%.6g", cell * k / n }'; }

# ---- unbonded: what comes back, wherever the grid lies
unbonded() { # cell, spacing, substrate diameter and height, dt-factor, positions
    k=0
    while [ "$k" -lt "$6" ]; do
        at=$(offset $k "$6" "$1")
        run=unbonded_$1_$2_$3_$at
        impact "$run" --bond none --frames 0 --cell "$1" --spacing "$2" --substrate-diameter "$3" --substrate-height "$4" \
            --dt-factor "$5" --grid-offset "$at"
        s=$out/$run/summary.json
        echo "$1,$2,$3,$at,$(value "$s" v_rest_relative_m_s),$(value "$s" eps_mean),$(value "$s" energy_contact_fraction),$(value "$s" energy_unaccounted),$(value "$s" v_noise_m_s),$(value "$s" cpu_seconds)"
        k=$((k + 1))
    done
}
{
    echo "cell_um,spacing_um,substrate_um,grid_offset_um,rebound_m_s,mean_strain,contact_fraction,energy_unaccounted,noise_m_s,cpu_s"
    unbonded 1 0.25 50 25 0.2 "$positions"
    unbonded 1 0.25 35 17.5 0.2 $(((positions + 1) / 2))
} >$table.part
mv $table.part $table

# ---- the picture: it stays at 810 m/s
[ -s "$out/picture/impact.png" ] || rm -f "$out/picture/summary.json"
impact picture $half --bond interface --frames 1 --cell 1 --spacing 0.25 --dt-factor 0.2
cp "$out/picture/impact.png" $picture.part
mv $picture.part $picture

# ---- the critical velocity
critical() { # diameter, cell, spacing, dt-factor, substrate diameter, height
    folder=$out/critical_$1_$2_$3
    build/critical_velocity $common --bond interface --material al --diameter "$1" --cell "$2" --spacing "$3" \
        --dt-factor "$4" --substrate-diameter "$5" --substrate-height "$6" --rule stays --stays 5 --low 700 --high 900 \
        --offsets "$positions" --quiet --out "$folder"
    echo "$1,$(value "$folder/summary.json" critical_velocity_m_s),$(value "$folder/summary.json" lowest_m_s),$(value "$folder/summary.json" highest_m_s),$positions,$2,$3,cubic,surface,interface,$5,axisymmetric,$(cpu_of "$folder"/runs/*.json)"
}
{
    echo "diameter_um,critical_velocity_m_s,lowest_m_s,highest_m_s,positions,cell_um,spacing_um,basis,contact,bond,substrate_um,geometry,cpu_s"
    critical 14 1 0.25 0.2 50 25
} >$curve.part
mv $curve.part $curve

# ---- the page
rows() { awk -F, "$1" "$2"; }
spread() { # largest less smallest rebound of a cell and substrate
    rows "NR > 1 && \$1 == $1 && \$3 == $2 { n++; if (n == 1 || \$5 < a) a = \$5; if (n == 1 || \$5 > b) b = \$5 }
          END { printf \"%.1f - %.1f\", a, b }" $table
}
strain() {
    rows "NR > 1 && \$1 == $1 && \$3 == $2 { n++; s += \$6; q += \$6 * \$6 } END { m = s / n
          printf \"%.3f, sd %.1f %%\", m, 100 * sqrt(q / n > m * m ? q / n - m * m : 0) / m }" $table
}
lost() { rows "NR > 1 && \$1 == $1 && \$3 == $2 { n++; s += \$7 } END { printf \"%.2f %%\", 100 * s / n }" $table; }
cpu() { rows "NR > 1 && \$1 == $1 && \$3 == $2 { n++; s += \$10 } END { printf \"%.0f\", s / n }" $table; }
line() { echo "| $1 | $2 | $3 | $4 | $(spread "$1" "$3") | $(strain "$1" "$3") | $(lost "$1" "$3") | $(cpu "$1" "$3") |"; }
{
    sed '/^| cell/,$d' $page
    echo "| cell, um | spacing, um | substrate, um | positions | rebound, m/s | mean plastic strain | lost in contact | CPU, s |"
    echo "|---|---|---|---|---|---|---|---|"
    line 1 0.25 50 "$positions"
    line 1 0.25 35 $(((positions + 1) / 2))
    echo
    echo "| diameter, um | cell, um | spacing, um | positions | critical velocity, m/s | lowest | highest |"
    echo "|---|---|---|---|---|---|---|"
    rows 'NR > 1 { printf "| %s | %s | %s | %s | %.0f | %.0f | %.0f |\n", $1, $6, $7, $5, $2, $3, $4 }' \
        $curve
} >$page.part
mv $page.part $page
