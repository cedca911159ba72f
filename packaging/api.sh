#!/bin/sh
# packaging/api.sh FOLDER: the reference of all public names into a folder that it makes; see api.awk. Fails where a
# name has no comment.
set -eu
rm -rf "$1.part"
mkdir -p "$1.part"
awk -v out="$1.part" -f packaging/api.awk mpm*.h >"$1.part/said" || { cat "$1.part/said"; exit 1; }
sed "s,$1[.]part,$1," "$1.part/said"
rm -rf "$1" "$1.part/said"
mv "$1.part" "$1"
