#!/bin/sh
# Prints mpm_all.h, all headers in one file for a release: the headers in the order of mpm.c, each whole but for
# its includes of the others, and the licence. Given: the version.
set -eu
cat <<END
/* mpm_all.h - all headers of mpm.h $1 in one file, written by \`make dist\`. SPDX-License-Identifier: MIT
   In ONE source file #define MPM_IMPLEMENTATION before including it. The headers follow one after the other, each
   with its own description; the licence stands at the end. */
END
for h in $(sed -n 's/^#include "\(mpm.*\.h\)"$/\1/p' mpm.c); do
    echo
    grep -v '^#include "mpm' "$h"
done
printf '\n/*\n'
cat LICENSE
echo '*/'
