#!/bin/sh
# report.html in headless Chromium, driven by node: `make report-test`. Runs of each kind into build/report-web,
# pictures of their pages into build/report-web/pictures. Skipped, with the reason, where Chromium or node is missing.
# Run from the top folder.
set -u
dir=build/report-web
browser=${CHROMIUM:-$(command -v chromium || command -v chromium-browser || command -v google-chrome)}
skip() {
    echo "skip - report.html in a browser: $1"
    exit 0
}
[ -n "$browser" ] || skip "no Chromium (Debian: chromium; or CHROMIUM=path)"
command -v node >/dev/null || skip "no node (Debian: nodejs)"
mkdir -p "$dir/pictures"
made() { # folder, program, options...: a page, if it is older than its program
    folder=$dir/$1
    program=$2
    shift 2
    [ "$folder/report.html" -nt "$program" ] || "$program" --quiet --out "$folder" "$@" || exit 1
}
made nodes build/impact --geometry axisymmetric --time 25 --frames 5
made surface build/impact --method surface --velocity 840 --cell 1 --time 25 --frames 4
made solid build/impact --method surface --geometry 3d --cell 2 --spacing 1 --time 2 --frames 3
made study build/critical_velocity --method thesis --time 12 --low 600 --high 900 --scan 100 --step 50 --offsets 2 \
    --cell 2 --spacing 0.5
node tests/web/report.mjs "$browser" "$dir/pictures" "$dir/nodes" nodes "$dir/surface" surface "$dir/solid" 3d \
    "$dir/study" study
