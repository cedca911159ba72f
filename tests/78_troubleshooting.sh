#!/bin/sh
# docs/troubleshooting.md has a section for every status, headed by its name and number, under it its text; the fields
# and names it speaks of are those of the headers. Run from the top folder.
set -u
dir=build/tests/troubleshooting
rm -rf "$dir"
mkdir -p "$dir"
. tests/check.sh
page=docs/troubleshooting.md
sed -n 's/^ *X(\(MPM_[A-Z_]*\), \(-*[0-9]*\), "\(.*\)").*/\1 \2 \3/p' mpm.h >"$dir/list"
check "the statuses are found" [ "$(wc -l <"$dir/list")" -ge 15 ]
last=$(sed -n 's/^ *MPM_STATUS_LAST = \([0-9]*\).*/\1/p' mpm.h)
check "... to the last" grep -qE "^MPM_[A-Z_]* $((last - 1)) " "$dir/list"
section() { # name, number: the section to $dir/section
    awk -v head="## $1 ($2)" '/^## / { on = $0 == head } on' $page >"$dir/section" && [ -s "$dir/section" ]
}
while read -r name number text; do
    check "$name has its section" section "$name" "$number"
    check "... which says what it means" grep -qxF "*$text*" "$dir/section"
    [ "$name" = MPM_OK ] || check "... and what to do" [ "$(wc -w <"$dir/section")" -gt 30 ]
done <"$dir/list"
grep -oE '^## MPM_[A-Z_]+' $page | cut -c4- | sort >"$dir/headed"
cut -d' ' -f1 "$dir/list" | sort >"$dir/named"
check "every section is of a status, and each there once" cmp "$dir/headed" "$dir/named"
check "README.md leads to it" grep -qF "($page)" README.md
# Names in code: functions and constants of the headers; in the first column of a table, fields of faults.
for name in $(grep -oE '\b(mpm_[a-z0-9_]+|MPM_[A-Z0-9_]+)\b' $page | grep -v '_$' | sort -u); do
    [ -f "$name.h" ] || check "$name is in a header" grep -qw "$name" mpm*.h
done
awk '/^## MPM_ERR_(ARGUMENT|FULL|STATE) / { on = 1 } /^## / && !/ERR_(ARGUMENT|FULL|STATE) / { on = 0 }
     on && /^\| `/ { split($0, cell, "|"); print cell[2] }' $page | grep -oE '`[^`]+`' | tr -d '`' >"$dir/fields"
check "fields are found" [ "$(wc -l <"$dir/fields")" -ge 15 ]
while read -r field; do check "a fault names \"$field\"" grep -qF "\"$field" mpm*.h; done <"$dir/fields"
check_end
