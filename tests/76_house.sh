#!/bin/sh
# How the house is built: the headers include mpm.h and nothing else of ours, use the private names (mpm__) of no
# other header, keep within 120 columns and to short functions (median 12 lines, 95 of 100 within 35).
dir=build/tests/house
. tests/check.sh
rm -rf "$dir"
mkdir -p "$dir"
for h in mpm*.h; do
    wanted='#include "mpm.h"'
    [ "$h" = mpm.h ] && wanted='#include nothing of ours'
    grep '^#include "' "$h" >"$dir/includes"
    check "$h includes mpm.h and no other header of ours" sh -c "! grep -vxF '$wanted' '$dir/includes'"
    grep -ohE '\bmpm__[a-z0-9_]+' "$h" | sort -u >"$dir/uses"
    for other in mpm*.h; do
        [ "$other" = "$h" ] && continue
        # defined there and not here: a name followed by "(" or ";" or in an enum or macro of that header
        grep -hE '^(static|typedef|MPM_|MPM__|#define|\} *mpm__)' "$other" | grep -ohE '\bmpm__[a-z0-9_]+' | sort -u >"$dir/theirs"
        grep -hE '^(static|typedef|MPM_|MPM__|#define|\} *mpm__)' "$h" | grep -ohE '\bmpm__[a-z0-9_]+' | sort -u >"$dir/ours"
        comm -12 "$dir/uses" "$dir/theirs" | comm -23 - "$dir/ours" >"$dir/taken"
        check "$h uses no private name of $other" sh -c "[ ! -s '$dir/taken' ] || { cat '$dir/taken'; false; }"
    done
done
check "examples and tests use no private name of a header" sh -c \
    "! grep -nE '\bmpm__[a-z]' examples/*.[ch] examples/studies/*.[ch] tests/*.[ch] tests/verify/*.[ch] bench/*.[ch]"
check "lines within 120 columns" sh -c \
    "! awk 'length > 120 { print FILENAME \":\" FNR }' mpm*.h mpm.c examples/*.[ch] examples/studies/*.[ch] tests/*.[ch] | grep ."
# A function: from a line that begins in column 1 and is followed by "{" alone, to "}" alone.
awk 'FNR == 1 { open = 0 }
     /^\{$/ { open = FNR }
     /^\}$/ && open { print FNR - open - 1, FILENAME ":" open; open = 0 }' mpm*.h | sort -n >"$dir/lengths"
n=$(wc -l <"$dir/lengths")
middle=$(sed -n "$(((n + 1) / 2))p" "$dir/lengths" | cut -d' ' -f1)
most=$(sed -n "$((n * 95 / 100))p" "$dir/lengths" | cut -d' ' -f1)
echo "# $n functions of more than a line: median $middle lines, 95 of 100 within $most, longest $(tail -n 1 "$dir/lengths")"
check "median length of functions is at most 12 lines" [ "$middle" -le 12 ]
check "95 of 100 functions have at most 35 lines" [ "$most" -le 35 ]
check_end
