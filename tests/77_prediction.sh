#!/bin/sh
# The prediction's script (make predict), with impacts of two steps and a critical velocity made up: a run is kept only
# while version and options are those asked for, and tables, page and picture get their names when they are whole. So do
# the pages and pictures of the Makefile and of make hard.
set -u
dir=build/tests/prediction
. tests/check.sh
rm -rf "$dir"
mkdir -p "$dir/build" "$dir/docs/data"
top=$(pwd)
cp mpm.h "$dir"
cp docs/prediction.md "$dir/docs/page.first"
# build/impact, cut short, which counts its runs; `broken` says that it fails
cat >"$dir/build/impact" <<END
#!/bin/sh
[ ! -f broken ] || exit 1
echo "\$*" >>runs
exec "$top/build/impact" "\$@" --time 0.02
END
cat >"$dir/build/critical_velocity" <<'END'
#!/bin/sh
diameter=14 cell=0.5
while [ $# -gt 0 ]; do
    case $1 in
    --out) out=$2 ;;
    --diameter) diameter=$2 ;;
    --cell) cell=$2 ;;
    esac
    shift
done
mkdir -p "$out/runs"
printf '{\n  "cpu_s": 3,\n  "end": 1\n}\n' >"$out/runs/one.json"
printf '{\n  "critical_velocity_m_s": 761,\n  "lowest_m_s": 759,\n  "highest_m_s": 766,\n  "options": {
    "diameter": %s,\n    "cell": %s,\n    "spacing": 0.25,\n    "substrate-diameter": 35,\n    "dt-factor": 0.2,
    "offsets": 1\n  }\n}\n' "$diameter" "$cell" >"$out/summary.json"
END
chmod +x "$dir/build/impact" "$dir/build/critical_velocity"
results="docs/prediction.md docs/surface.png docs/data/prediction.csv docs/data/prediction_unbonded.csv
docs/data/prediction_held_out.csv"
predict() { (cd "$dir" && : >runs && sh "$top/examples/studies/prediction.sh" 1 2 2>said); }
runs() { wc -l <"$dir/runs"; }
ran() { [ "$(runs)" -eq "$1" ] || { echo "$(runs) runs"; false; }; }
summary=build/predict/unbonded_1_0.25_35_0/summary.json
again() { # sed command, name: after that change of the first summary it is run again, and it alone
    sed "$1" "$dir/$summary" >"$dir/changed"
    check "$2: a change" sh -c "! cmp -s '$dir/$summary' '$dir/changed'"
    mv "$dir/changed" "$dir/$summary"
    check "... and the tables once more" predict
    check "... run again, and it alone" ran 1
    check "... and said" grep -q "run again" "$dir/said"
}
# The names of what was there before, kept by a second link: a file written in place changes under both.
for f in $results; do
    echo "| diameter of before" >"$dir/$f"
    [ "$f" != docs/prediction.md ] || cp "$dir/docs/page.first" "$dir/$f"
    ln "$dir/$f" "$dir/$f.before"
    cp "$dir/$f" "$dir/$f.copy"
done
check "the tables" predict
check "seven unbonded impacts, four bonded and the picture's" ran 12
for f in $results; do
    check "$f is new" sh -c "[ -s '$dir/$f' ] && ! cmp -s '$dir/$f' '$dir/$f.copy'"
    check "... and was not written in place" cmp "$dir/$f.before" "$dir/$f.copy"
done
check "the page has its numbers" grep -q '^| 14 | 1 | 35 | 0.1 | 1 | 761 | 759 | 766 | 3 |' "$dir/docs/prediction.md"
for page in page.first prediction.md; do sed '/^| diameter/,$d' "$dir/docs/$page" >"$dir/$page.text"; done
check "... and its text" cmp "$dir/page.first.text" "$dir/prediction.md.text"
check "the tables again" predict
check "... without a run" ran 0
again 's/"mpm_version": "[^"]*"/"mpm_version": "0.1.9"/' "another version"
again 's/"cell": 1/"cell": 1.1/' "another grid"
again 's/"substrate-height": 17.5/"substrate-height": 17/' "another substrate"
again 's/"bond": "none"/"bond": "energy"/' "another word"
again 's/"method": "surface"/"method": "thesis"/' "another method"
again '$d' "a summary that is cut"
again 's/^  "options": {/  "others": {/' "no options"
rm "$dir/build/predict/picture/impact.png"
check "without the picture" predict
check "... its impact once more" ran 1
rm "$dir/$summary"
touch "$dir/broken"
for f in $results; do cp "$dir/$f" "$dir/$f.copy"; done
fails() { ! predict; }
check "an impact that fails" fails
for f in $results; do check "... leaves $f" cmp "$dir/$f" "$dir/$f.copy"; done
check "... and nothing half-written" sh -c "! find '$dir/docs' -name '*.part' | grep ."
# A page or picture of docs/ is never written under its own name: not by cp, not by a redirection.
check "scripts were found" [ "$(ls Makefile tests/hard/run.sh examples/studies/*.sh bench/*.sh | wc -l)" -ge 4 ]
check "pages and pictures get their names when they are whole" sh -c \
    "! grep -noE '(> *|cp [^|;&]* )\"?docs/[^ ;&\"]*' Makefile tests/hard/*.sh examples/studies/*.sh bench/*.sh |
        grep -v '[.]part$'"
check_end
