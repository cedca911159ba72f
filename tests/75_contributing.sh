#!/bin/sh
# CONTRIBUTING.md says where to add what: every name and every file in it is there.
set -u
dir=build/tests/contributing
mkdir -p "$dir"
. tests/check.sh
check "CONTRIBUTING.md is there" [ -s CONTRIBUTING.md ]
words() { grep -oE "$1" CONTRIBUTING.md | sort -u; } # what fits the pattern, each once
for name in $(words '\b(mpm__?[a-z0-9_]+[a-z0-9]|MPM__?[A-Z0-9_]+)\b'); do
    [ -f "$name.h" ] || [ -f "$name.c" ] || check "$name is in a header" grep -qw "$name" mpm*.h
done
for file in $(words '\b(examples|tests|docs)/[a-zA-Z0-9_/]+[.](c|h|sh|md)\b'; words '\bmpm[a-z_]*[.][ch]\b'); do
    check "$file is there" [ -f "$file" ]
done
for name in $(words '\b[0-9][0-9]_[a-z_]*[a-z]\b'); do
    check "$name is there" sh -c "ls tests/$name.* tests/verify/$name.* examples/$name.* 2>/dev/null | grep ."
done
check "names, files and tests were found in it" [ $((passed + failed)) -gt 50 ]
check_end
