#!/bin/sh
# Writes build/mpm-VERSION.tar.gz: every file of the project as it stands in this folder, under one folder of that
# name. Works in a clone and in an unpacked archive. Given: the version.
set -eu
name=mpm-$1
if [ -e .git ]; then
    list=$(git ls-files)
else
    list=$(find . -type f ! -path './build/*' | sed 's,^\./,,')
fi
rm -rf "build/$name"
mkdir -p "build/$name"
printf '%s\n' "$list" | sort | while read -r f; do
    [ ! -f "$f" ] || printf '%s\n' "$f"
done | tar cf - -T - | tar xf - -C "build/$name"
tar cf - -C build "$name" | gzip -9n >"build/$name.tar.gz"
rm -rf "build/$name"
