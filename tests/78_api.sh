#!/bin/sh
# The reference that `make api` writes: every public name of the headers has a comment and stands in it, every link
# leads somewhere; and a name without a comment, or a line that is not understood, is a warning.
set -u
dir=build/tests/api
rm -rf "$dir"
mkdir -p "$dir"
. tests/check.sh
check "make api: no warnings" sh packaging/api.sh "$dir/pages"
check "... one page for each header, and the index" [ "$(ls "$dir/pages" | wc -l)" -eq $(($(ls mpm*.h | wc -l) + 1)) ]
# Functions as the compiler's own words find them: MPM_API up to the first "(" behind the name.
for h in mpm*.h; do
    sed '/stop here if you only want the API/,$d; /^#if defined(MPM_IMPLEMENTATION)/,$d' "$h" | tr '\n' ' ' |
        grep -oE 'MPM_API [^;(]*\(' | grep -oE 'mpm_[a-z0-9_]+\($' | tr -d '(' | sort -u >"$dir/functions"
    check "$h has functions" [ -s "$dir/functions" ]
    grep -oE '<a id="[A-Za-z0-9_]+"' "$dir/pages/$h.html" | cut -d'"' -f2 | sort -u >"$dir/there"
    check "$h: all its functions are on its page" sh -c "! comm -23 '$dir/functions' '$dir/there' | grep ."
done
# Links: every "#name" is on its page, every file is there.
(cd "$dir/pages" && grep -oE '<a id="[^"]+"' *.html | sed 's/:<a id="/#/; s/"$//' | sort -u) >"$dir/anchors"
(cd "$dir/pages" && grep -oE 'href="[^"]+"' *.html | sed 's/:href="/ /; s/"$//' |
    awk '{ print ($2 ~ /^#/ ? $1 : "") $2 }' | sort -u) >"$dir/links"
check "links to names were found" [ "$(grep -c '#' "$dir/links")" -gt 400 ]
check "every name that is linked is there" sh -c "grep '#' '$dir/links' | comm -23 - '$dir/anchors' | { ! grep .; }"
check "every file that is linked is there" sh -c "grep -v '#' '$dir/links' | while read -r f; do
    case \$f in
    ../../*) [ -f \"\${f#../../}\" ] ;;
    *) [ -f '$dir/pages/'\"\$f\" ] ;;
    esac || { echo \$f; exit 1; }
    done"
check "no name is there twice" sh -c "grep -hoE '<a id=\"[^\"]+\"' '$dir'/pages/*.html | sort | uniq -d | { ! grep .; }"
# What must be found: the comment of a function, of a type, of a macro taken away; a declaration of no known kind.
warns() { # words, declaration: a header with it before its end has a warning with those words, and no other
    mkdir -p "$dir/changed"
    awk -v d="$2" '/stop here if you only want the API/ { printf "\n" d "\n\n" } { print }' mpm_bond.h \
        >"$dir/mpm_bond.h"
    ! awk -v out="$dir/changed" -f packaging/api.awk "$dir/mpm_bond.h" >/dev/null 2>"$dir/warnings" &&
        grep -q "$1" "$dir/warnings" && [ "$(wc -l <"$dir/warnings")" -eq 1 ]
}
check "a function without a comment" warns "function mpm_bond_extra has no comment" 'MPM_API int mpm_bond_extra(int n);'
check "a function over two lines" warns "function mpm_bond_extra has no comment" \
    'MPM_API int mpm_bond_extra(int n,\n                           int m);'
check "an inline function" warns "function mpm_bond_extra has no comment" \
    'static inline int mpm_bond_extra(int n)\n{\n    return n;\n}'
check "a type" warns "type mpm_bond_extra has no comment" \
    'typedef struct mpm_bond_extra {\n    int n; /* a number */\n} mpm_bond_extra;'
check "a macro" warns "macro MPM_BOND_EXTRA has no comment" '#define MPM_BOND_EXTRA 1'
check "a variable, which no header has" warns "neither a comment nor a declaration" 'extern int mpm_bond_extra;'
check_end
