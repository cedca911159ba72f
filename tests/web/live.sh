#!/bin/sh
# The live page: digits beside the desktop's by node, and the page in a headless Chromium. What is not there is
# skipped, with the reason. sh tests/web/live.sh MAKE WASM_COMPILER, from the top folder, when build/impact and
# build/tests/live_digits are made.
set -u
make=$1
cc=$2
skip() { echo "skipped: $1"; exit 0; }
status=0
why=$(sh web/live/build.sh -n "$cc") || skip "$why"
$make --no-print-directory web WASM_CC="$cc" || exit 1
command -v node >/dev/null || skip "no node, which runs the page's scripts"
echo "# digits"
node tests/web/live_digits.mjs || status=1
browser=$(command -v chromium || command -v chromium-browser || command -v google-chrome) ||
    { echo "skipped: no chromium, to open the page in"; exit $status; }
echo "# the page"
node tests/web/live_page.mjs "$browser" || status=1
exit $status
