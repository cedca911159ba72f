#!/bin/sh
# How the house is built: the headers include mpm.h and nothing else of ours, use the private names (mpm__, MPM__) of no
# other header, keep within 120 columns and to short functions (median 12 lines, 95 of 100 within 35).
set -u
dir=build/tests/house
. tests/check.sh
rm -rf "$dir"
mkdir -p "$dir"
private='\b(mpm|MPM)__[A-Za-z0-9_]+'
for h in mpm*.h; do
    grep -ohE "$private" "$h" | sort -u >"$dir/$h.private"
    check "$h has private names" [ -s "$dir/$h.private" ]
done
for h in mpm*.h; do
    wanted='#include "mpm.h"'
    [ "$h" = mpm.h ] && wanted='#include nothing of ours'
    grep '^#include "' "$h" >"$dir/includes"
    check "$h includes mpm.h and no other header of ours" sh -c "! grep -vxF '$wanted' '$dir/includes'"
    for other in mpm*.h; do
        [ "$other" = "$h" ] && continue
        check "$h uses no private name of $other" sh -c "! comm -12 '$dir/$h.private' '$dir/$other.private' | grep ."
    done
done
# Every C file that is not the library.
find examples tests bench docs -name '*.[ch]' | sort >"$dir/programs"
for folder in examples examples/studies examples/studies/reproduction tests tests/compile tests/fuzz tests/hard \
    tests/verify bench; do
    check "programs of $folder are looked at" grep -qE "^$folder/[^/]*\.[ch]$" "$dir/programs"
done
check "programs use no private name of a header" sh -c "! xargs grep -nE '$private' <'$dir/programs'"
check "lines within 120 columns" sh -c \
    "! { ls mpm*.h mpm.c && cat '$dir/programs'; } | xargs awk 'length > 120 { print FILENAME \":\" FNR }' | grep ."
# A function: from a line that begins in column 1 and is followed by "{" alone, to "}" alone.
awk 'FNR == 1 { open = 0 }
     /^\{$/ { open = FNR }
     /^\}$/ && open { print FNR - open - 1, FILENAME ":" open; open = 0 }' mpm*.h | sort -n >"$dir/lengths"
n=$(wc -l <"$dir/lengths")
middle=$(sed -n "$(((n + 1) / 2))p" "$dir/lengths" | cut -d' ' -f1)
most=$(sed -n "$((n * 95 / 100))p" "$dir/lengths" | cut -d' ' -f1)
longest=$(tail -n 1 "$dir/lengths")
echo "# $n functions of more than a line: median $middle lines, 95 of 100 within $most, longest $longest"
check "functions were found" [ "$n" -gt 500 ]
check "median length of functions is at most 12 lines" [ "$middle" -le 12 ]
check "95 of 100 functions have at most 35 lines" [ "$most" -le 35 ]
check_end
