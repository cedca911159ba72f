#!/bin/sh
# docs/keys.md is what docs/keys.c makes, and its tables are what the programs write: short runs of each, whose
# summaries and tables have those keys in that order. Run from the top folder: tests/69_keys.sh [cc]
set -u
cc=${1:-cc}
dir=build/tests/keys
. tests/check.sh
rm -rf "$dir"
mkdir -p "$dir/mpi"
made() {
    $cc -std=c99 -I. -Iexamples docs/keys.c -o "$dir/keys" -lm && "$dir/keys" >"$dir/keys.md" &&
        cmp "$dir/keys.md" docs/keys.md
}
check "docs/keys.md is what make keys writes" made
# One file a table: its keys, a line each. The name of a section may stand for several programs.
awk -v out="$dir" '
    /^## / { n = split(substr($0, 4, index($0, ": ") - 4), program, /, /); file = substr($0, index($0, ": ") + 2) }
    /^\| `/ { split($0, cell, "`"); for (i = 1; i <= n; i++) print cell[2] > (out "/" program[i] "." file ".page") }
' docs/keys.md
keys_of() { # of a summary all keys but the version, up to the options; of a table the names
    case $1 in
    *.json) sed -n 's/^ *"\([^"]*\)":.*/\1/p; /^options$/q' "$1" | grep -v '^mpm_version$' ;;
    *) grep -v '^#' "$1" | head -n 1 | tr ',' '\n' ;;
    esac
}
same_keys() { # program, file
    keys_of "$dir/$1/$2" >"$dir/$1.$2.file" && diff "$dir/$1.$2.page" "$dir/$1.$2.file"
}
hold() { # program, options...
    name=$1
    shift
    [ -x "build/$name" ] || return 0
    check "$name runs" "build/$name" --quiet --out "$dir/$name" "$@"
    for page in "$dir/$name".*.page; do
        file=$(basename "$page" .page)
        file=${file#"$(basename "$name")".}
        check "... its $file has the keys of docs/keys.md" same_keys "$name" "$file"
    done
    for file in "$dir/$name"/*.json "$dir/$name"/*.csv; do
        check "... $(basename "$file") is on the page" [ -f "$dir/$name.$(basename "$file").page" ]
    done
}
# mpi/many_particles starts as one rank by itself; as root Open MPI wants to be asked twice.
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
coarse="--cell 2 --spacing 1 --substrate-diameter 24 --substrate-height 6"
# shellcheck disable=SC2086
{
    hold impact $coarse --time 0.5 --frames 0
    hold taylor --time 1 --cell 0.8 --spacing 0.4 --frames 0
    hold pull $coarse --time 8 --distance 0.02 --ramp 1 --sample 0.2
    hold two_particles $coarse --time 0.05 --frames 0
    hold many_particles $coarse --time 0.05 --frames 0 --count 2
    hold mpi/many_particles $coarse --time 0.05 --frames 0 --count 2
    hold critical_velocity $coarse --method thesis --geometry axisymmetric --time 2 --low 600 --high 800 --scan 200 \
        --step 200 --offsets 1 --grids 2
}
hold spray --time 0.002 --frames 0
check_end
