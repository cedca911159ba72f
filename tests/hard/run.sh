#!/bin/sh
# sh tests/hard/run.sh KILLS: what goes wrong outside of the library, and what other tools say of it. Each line is
# "name: ok", "found N: ...", or "skip: reason"; the same lines, with the tools' versions, become docs/quality.md.
# Exit 1 if anything was found.
set -u
kills=${1:-20}
dir=build/hard
page=$dir/quality.md
flags="-std=c99 -ffp-contract=off -DMPM_NO_INLINE -I. -Iexamples -Iexamples/studies -Itests"
strict="-std=c99 -pedantic -Wall -Wextra -Wconversion -Wshadow -Werror -I."
bad=0
mkdir -p $dir
: >$dir/table
line() { # name, result, tool
    printf '%-28s %s\n' "$1" "$2"
    printf '| %s | %s | %s |\n' "$1" "$2" "${3:-}" >>$dir/table
    case $2 in found*) bad=1 ;; esac
}
version() { "$1" --version 2>/dev/null | head -n 1 | tr '|' ' '; }
have() { command -v "$1" >/dev/null 2>&1; }
# name, tool, log, command...: ok, or the number of lines in the log that name a fault
try() {
    name=$1 tool=$2 log=$dir/$3
    shift 3
    if ! have "$tool"; then line "$name" "skip: $tool is not installed"; return; fi
    if timeout 900 "$@" >"$log" 2>&1; then line "$name" ok "$(version "$tool")"
    else line "$name" "found $(grep -cE 'error|ERROR|warning|WARNING|not ok|wrong|differ' "$log"): see $log" "$(version "$tool")"; fi
}

# ---- failures of the machine
try "allocations fail" cc memory.log sh -c "cc $flags -O1 tests/hard/memory.c -o $dir/memory -lm && $dir/memory"
impact=$dir/impact
cc $flags -O1 examples/impact.c -o $impact -lm || exit 1
if [ -w /dev/full ]; then
    if $impact --help >/dev/full 2>/dev/null; then line "standard output full" "found 1: impact --help exits 0"
    else line "standard output full" ok; fi
else line "standard output full" "skip: no /dev/full"; fi
full=$dir/full
mkdir -p $full
if [ "$(id -u)" = 0 ] && mount -t tmpfs -o size=64k tmpfs $full 2>/dev/null; then
    if $impact --quiet --time 1 --spacing 0.75 --frames 2 --out $full >/dev/null 2>&1; then line "disk full" "found 1: impact exits 0"
    elif [ -n "$(find $full -name '*.part*')" ]; then line "disk full" "found 1: parts of files stay"
    else line "disk full" ok; fi
    umount $full
else line "disk full" "skip: no right to mount a small disk"; fi
: >$dir/file
if $impact --quiet --time 1 --spacing 0.75 --frames 0 --out $dir/file/below >/dev/null 2>&1; then
    line "folder that cannot be made" "found 1: impact exits 0"
else line "folder that cannot be made" ok; fi
try "kill -9, then go on" cc kill.log sh tests/hard/kill.sh "$kills"

# ---- readers of the source
for h in mpm*.h; do printf '#define MPM_IMPLEMENTATION\n#include "%s"\n' "$h" >$dir/only_${h%.h}.c; done
try "gcc -fanalyzer" gcc analyzer.log sh -c "for f in $dir/only_*.c; do gcc $flags -O1 -fanalyzer -Werror -c \$f -o /dev/null || exit 1; done"
try "cppcheck" cppcheck cppcheck.log cppcheck -q --error-exitcode=9 --std=c99 --enable=warning -D__GNUC__ -DMPM_NO_INLINE -I. mpm.c
try "clang-tidy" clang-tidy tidy.log clang-tidy --quiet "--checks=-*,bugprone-*,clang-analyzer-*,-bugprone-easily-swappable-parameters,-bugprone-implicit-widening-of-multiplication-result,-bugprone-reserved-identifier,-bugprone-macro-parentheses,-bugprone-narrowing-conversions,-clang-analyzer-security.insecureAPI.*" --warnings-as-errors=* mpm.c -- $flags

# ---- compilers
for c in gcc clang tcc musl-gcc "gcc -m32" x86_64-w64-mingw32-gcc s390x-linux-gnu-gcc arm-linux-gnueabihf-gcc arm-none-eabi-gcc; do
    tool=${c%% *}
    opts=$strict
    [ "$tool" = tcc ] && opts="-I."
    name=$(echo "$c" | tr -d ' -')
    if [ "$c" = "gcc -m32" ] && ! echo 'int main(void) { return 0; }' | gcc -m32 -include stdio.h -x c - -o $dir/m32 2>/dev/null; then
        line "compiler $c" "skip: gcc's 32 bit library is not installed"
        continue
    fi
    try "compiler $c" "$tool" "compiler_$name.log" sh -c "$c $opts -DMPM_NO_INLINE -c mpm.c -o $dir/$name.o && $c $opts -DMPM_NO_INLINE -DMPM_FLOAT -c mpm.c -o $dir/$name.o"
done

# ---- sanitizers: the tests of the step, of files, pictures and sprays
san() { # name, tool, options
    try "$1" clang "$2.log" sh -c "
        for t in 21_world 40_io 51_spray_input; do
            clang $flags -O1 -g $3 tests/\$t.c -o $dir/$2_\$t -lm && $dir/$2_\$t >$dir/$2_\$t.log || { cat $dir/$2_\$t.log; exit 1; }
        done"
}
san "address, undefined, casts" asan "-fsanitize=address,undefined,float-cast-overflow,implicit-integer-sign-change -fno-sanitize-recover=all"
san "uninitialised memory" msan "-fsanitize=memory -fno-sanitize-recover=all"
try "two threads, one material" clang tsan.log sh -c "clang $flags -O1 -g -fsanitize=thread tests/hard/threads.c -o $dir/threads -lm -lpthread && $dir/threads"
try "valgrind" valgrind valgrind.log sh -c "cc $flags -O1 -g tests/21_world.c -o $dir/val -lm && valgrind -q --error-exitcode=9 --leak-check=full $dir/val"

{
    echo "# Quality"
    echo
    echo "Written by \`make hard\` on $(uname -s) $(uname -m), mpm.h $(sed -n 's/^.define MPM_VERSION "\(.*\)"/\1/p' mpm.h), with $kills kills."
    echo "\`make fuzz SECONDS=20\` runs the targets of tests/fuzz, \`make coverage\` counts lines and branches."
    echo
    echo "| what | result | tool |"
    echo "|---|---|---|"
    cat $dir/table
} >$page
cp $page docs/quality.md
exit $bad
