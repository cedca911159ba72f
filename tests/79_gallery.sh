#!/bin/sh
# docs/gallery.md: every picture is there, small, and made by a command on the page; every command names a program and
# options that there are.
set -u
dir=build/tests/gallery
rm -rf "$dir"
mkdir -p "$dir"
. tests/check.sh
grep -oE '\]\(data/[^)]+\)' docs/gallery.md | sed 's,](data/,,; s,)$,,' | sort >"$dir/shown"
sed -n 's/^    //p' docs/gallery.md >"$dir/commands"
sed -n 's,^cp [^ ]* docs/data/,,p' "$dir/commands" | sort >"$dir/made"
check "ten pictures or more" [ "$(wc -l <"$dir/shown")" -ge 10 ]
check "what is shown is what is made" cmp "$dir/shown" "$dir/made"
while read -r picture; do
    check "$picture is there" [ -s "docs/data/$picture" ]
    check "... of at most 200 kB" [ "$(wc -c <"docs/data/$picture")" -le 200000 ]
done <"$dir/shown"
check "the commands are shell" sh -n "$dir/commands"
sed 's/.*&& //' "$dir/commands" | awk '{ if (sub(/\\$/, "")) printf "%s", $0; else print }' >"$dir/lines"
grep '^build/' "$dir/lines" | while read -r program options; do
    echo "$options" | grep -oE -- '--[a-z0-9-]+' | sed "s,^,$program ,"
done | sort -u >"$dir/options"
check "options were found" [ "$(wc -l <"$dir/options")" -gt 20 ]
while read -r program option; do
    [ -x "$program" ] || { echo "skip - $program is not built: $option was not looked for"; continue; }
    check "$program has $option" sh -c "$program --help | grep -q -- '^  $option '"
done <"$dir/options"
check_end
