#!/bin/sh
# Puts the sections given as files together into docs/verification.md, on standard output.
set -eu
held=$(sed -n 's/^<!-- \([0-9]*\) hold, \([0-9]*\) miss -->$/\1/p' "$@" | awk '{ n += $1 } END { print n + 0 }')
missed=$(sed -n 's/^<!-- \([0-9]*\) hold, \([0-9]*\) miss -->$/\2/p' "$@" | awk '{ n += $1 } END { print n + 0 }')
cat <<END
# Verification

Written by \`make verify\`; every section is one program in [tests/verify](../tests/verify). Each row sets what the
library gives beside an answer that comes from outside it. A row that misses says so and is followed by the reason.
Contact and walls act in source A's scheme here (\`MPM_SCHEME_THESIS\`); the consistent one is held by tests/27_schemes.c.

$((held + missed)) rows with a tolerance: $held hold, $missed do not.

END
for part in "$@"; do
    sed '/^<!-- [0-9]* hold, [0-9]* miss -->$/d' "$part"
done
