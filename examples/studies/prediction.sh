#!/bin/sh
# The prediction's tables: docs/prediction.md and docs/data/prediction*.csv. Called by `make predict`.
#   sh examples/studies/prediction.sh POSITIONS
# Runs of a position are kept in build/predict and not repeated; delete the folder after changing the headers.
set -eu
positions=${1:-4}
out=build/predict
mkdir -p "$out" docs/data
common="--geometry axisymmetric --functions cubic --contact surface --springs --scheme consistent --gap 0.3"
half="--substrate-diameter 50 --substrate-height 25"
value() { # file, key
    sed -n "s/^  \"$2\": \([^,]*\),*$/\1/p" "$1"
}
cpu_of() { sed -n 's/^  "cpu_s": \([^,]*\),*$/\1/p' "$@" | awk '{ s += $1 } END { printf "%.0f", s }'; } # kept runs
impact() { # name, options: an impact whose summary is kept
    [ -s "$out/$1/summary.json" ] && return
    name=$1
    shift
    build/impact $common --bond none --frames 0 --quiet --out "$out/$name" "$@"
}
offset() { awk -v k="$1" -v n="$2" -v cell="$3" 'BEGIN { printf "%.6g", cell * k / n }'; }

# ---- unbonded: what comes back, wherever the grid lies
unbonded() { # cell, spacing, substrate diameter and height, dt-factor, positions
    k=0
    while [ "$k" -lt "$6" ]; do
        at=$(offset $k "$6" "$1")
        run=unbonded_$1_$2_$3_$at
        impact "$run" --cell "$1" --spacing "$2" --substrate-diameter "$3" --substrate-height "$4" --dt-factor "$5" \
            --grid-offset "$at"
        s=$out/$run/summary.json
        echo "$1,$2,$3,$at,$(value "$s" v_rest_relative_m_s),$(value "$s" eps_mean),$(value "$s" energy_contact_fraction),$(value "$s" energy_unaccounted),$(value "$s" v_noise_m_s),$(value "$s" cpu_seconds)"
        k=$((k + 1))
    done
}
table=docs/data/prediction_unbonded.csv
{
    echo "cell_um,spacing_um,substrate_um,grid_offset_um,rebound_m_s,mean_strain,contact_fraction,energy_unaccounted,noise_m_s,cpu_s"
    unbonded 1 0.25 50 25 0.2 "$positions"
    unbonded 1 0.25 35 17.5 0.2 $(((positions + 1) / 2))
} >"$out/unbonded.csv"
mv "$out/unbonded.csv" $table

# ---- the picture: it stays at 810 m/s
if [ ! -s "$out/picture/impact.png" ]; then
    build/impact $common $half --bond interface --cell 1 --spacing 0.25 --dt-factor 0.2 --frames 1 --quiet \
        --out "$out/picture"
fi
cp "$out/picture/impact.png" docs/surface.png

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
} >"$out/critical.csv"
mv "$out/critical.csv" docs/data/prediction.csv

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
sed '/^| cell/,$d' docs/prediction.md >"$out/page.md"
{
    cat "$out/page.md"
    echo "| cell, um | spacing, um | substrate, um | positions | rebound, m/s | mean plastic strain | lost in contact | CPU, s |"
    echo "|---|---|---|---|---|---|---|---|"
    line 1 0.25 50 "$positions"
    line 1 0.25 35 $(((positions + 1) / 2))
    echo
    echo "| diameter, um | cell, um | spacing, um | positions | critical velocity, m/s | lowest | highest |"
    echo "|---|---|---|---|---|---|---|"
    rows 'NR > 1 { printf "| %s | %s | %s | %s | %.0f | %.0f | %.0f |\n", $1, $6, $7, $5, $2, $3, $4 }' \
        docs/data/prediction.csv
} >"$out/whole.md"
mv "$out/whole.md" docs/prediction.md
