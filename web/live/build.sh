#!/bin/sh
# Compiles web/live/live.c to build/web/live.wasm, and writes it into build/web/live_wasm.js as text, so that the page
# also opens from a disk. Run from the top folder: sh web/live/build.sh [-n] COMPILER; -n only tells whether it can.
set -eu
only=
[ "${1:-}" = -n ] && only=1 && shift
cc=$1
out=build/web
mkdir -p $out
target='--target=wasm32-wasi'
if ! echo 'int main(void) { return 0; }' | $cc $target -xc - -o $out/probe.wasm 2>$out/probe.log; then
    echo "no WebAssembly: $cc $target cannot compile and link" \
         "(Debian: clang lld wasi-libc libclang-rt-14-dev-wasm32): $(head -n 1 $out/probe.log)"
    rm -f $out/probe.wasm $out/probe.log
    exit 1
fi
rm -f $out/probe.wasm $out/probe.log
[ -z "$only" ] || exit 0
exports=$(sed -n 's/^[a-z].*[ *]\(live_[a-z_]*\)(.*/-Wl,--export=\1/p' web/live/live.c)
$cc $target -std=c99 -pedantic -Wall -Wextra -Wconversion -Wshadow -DMPM_STATIC -O3 -msimd128 \
    -ffp-contract=off -fno-math-errno -D_WASI_EMULATED_PROCESS_CLOCKS -I. -Iexamples web/live/live.c \
    -o $out/live.wasm.part -nostartfiles -Wl,--no-entry $exports -Wl,-z,stack-size=1048576 -Wl,--strip-all \
    -lwasi-emulated-process-clocks -lm
{
    echo '/* live.wasm as text: made by make web. */'
    printf 'const LIVE_WASM = "'
    base64 $out/live.wasm.part | tr -d '\n'
    echo '";'
} >$out/live_wasm.js.part
mv $out/live_wasm.js.part $out/live_wasm.js
mv $out/live.wasm.part $out/live.wasm
