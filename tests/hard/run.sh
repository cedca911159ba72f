#!/bin/sh
# sh tests/hard/run.sh KILLS JOBS [CHECK...]: what goes wrong outside of the library, and what other tools say of it,
# JOBS checks at a time. Each gives one line, "name: ok", "found: ...", or "skip: reason"; the lines of all checks, with
# the tools' versions, become the table of docs/quality.md. Exit 1 if anything was found.
set -u
dir=build/hard
flags="-std=c99 -ffp-contract=off -DMPM_NO_INLINE -I. -Iexamples -Iexamples/studies -Itests"
strict="-std=c99 -pedantic -Wall -Wextra -Wconversion -Wshadow -Werror -DMPM_NO_INLINE -I."
impact="$dir/impact --quiet --time 1 --spacing 0.75"
all="allocations stdout full readonly nofolder kill address memory threads valgrind analyzer cppcheck tidy
gcc clang tcc musl m32 mingw s390x armhf bare board"
. tests/check.sh

# ---- one check -------------------------------------------------------------------------------
line() { # name, result, tool
    printf '%-38s %s\n' "$1" "$2"
    printf '| %s | %s | %s |\n' "$1" "$2" "${3:-}" >"$dir/$check.line"
}
version() { "$1" --version 2>/dev/null | head -n 1 | tr '|' ' '; }
have() { command -v "$1" >/dev/null 2>&1; }
try() { # name, tool, command...: the command's output goes to a log; its failure is a finding
    name=$1 tool=$2
    shift 2
    have "$tool" || { line "$name" "skip: $tool is not installed"; return; }
    if "$@" >"$dir/$check.log" 2>&1; then line "$name" "ok${note:+, $note}" "$(version "$tool")"
    else line "$name" "found: see $dir/$check.log" "$(version "$tool")"; fi
}
limited() { timeout 1500 nice "$@"; }
in_folder() { # program...: run in a folder of its own, as it would be beside build/
    mkdir -p "$dir/$check.run" && (cd "$dir/$check.run" && mkdir -p build && "$@")
}
here=$(pwd)/$dir

# ---- failures of the machine
refuses() { # name, command...: it says no by its exit status; a crash is no answer
    name=$1
    shift
    "$@" >"$dir/$check.log" 2>&1
    status=$?
    if [ $status = 0 ]; then line "$name" "found: it exits with 0"
    elif [ $status -gt 125 ]; then line "$name" "found: it dies of $status, see $dir/$check.log"
    else line "$name" ok; fi
}
fails_in_turn() { cc $flags -O1 tests/hard/memory.c -o $dir/memory -lm && limited $dir/memory; }
check_allocations() {
    try "every allocation fails in turn" cc fails_in_turn
    tail -n 1 $dir/allocations.log | grep -q ', 0 wrong$' || line "every allocation fails in turn" "found: it dies"
}
check_stdout() {
    [ -c /dev/full ] || { line "standard output full" "skip: no /dev/full"; return; }
    refuses "standard output full" sh -c "$dir/impact --help >/dev/full"
}
small_disk() { # folder, options
    mkdir -p "$1"
    [ "$(id -u)" = 0 ] && mount -t tmpfs -o "$2" tmpfs "$1" 2>/dev/null
}
check_full() {
    small_disk $dir/full size=64k || { line "disk full" "skip: no right to mount a small disk"; return; }
    refuses "disk full" $impact --frames 2 --out $dir/full
    [ -z "$(find $dir/full -name '*.part*')" ] || line "disk full" "found: parts of files stay"
    umount $dir/full
}
check_readonly() {
    small_disk $dir/readonly ro || { line "folder that cannot be written" "skip: no right to mount a disk"; return; }
    refuses "folder that cannot be written" $impact --frames 0 --out $dir/readonly
    umount $dir/readonly
}
check_nofolder() {
    : >$dir/file
    refuses "folder that cannot be made" $impact --frames 0 --out $dir/file/below
}
check_kill() {
    try "kill -9 at $kills moments, then on" cc limited sh tests/hard/kill.sh "$kills"
}

# ---- readers of the source
check_analyzer() { # it loses sight of short arrays that loops over 0, 1, 2 fill; valgrind and clang's sanitizer do not
    try "gcc -fanalyzer" gcc limited gcc $flags -O1 -fanalyzer -Wno-analyzer-use-of-uninitialized-value -Werror \
        -c mpm.c -o /dev/null
}
check_cppcheck() {
    try "cppcheck" cppcheck limited cppcheck -q --error-exitcode=9 --std=c99 --enable=warning -D__GNUC__ \
        -DMPM_NO_INLINE -I. --suppressions-list=tests/hard/cppcheck.txt mpm.c
}
check_tidy() {
    try "clang-tidy" clang-tidy limited clang-tidy --quiet "--checks=-*,bugprone-*,clang-analyzer-*$(tidy_without)" \
        "--warnings-as-errors=*" "--header-filter=.*" mpm.c -- $flags
}
tidy_without() { # what it is not asked, and why: each a comma, a minus and the name
    sed 's/#.*//; s/ //g; /^$/d; s/^/,-/' tests/hard/tidy.txt | tr -d '\n'
}

# ---- compilers: the library in double and float; an impact whose numbers are those recorded in agree.golden; elastic
# ---- bodies whose every bit is that recorded in 70_bits.c, in double and float; the tests of files
builds() { # options, compiler...
    options=$1
    shift
    for real in "" -DMPM_FLOAT; do limited "$@" $options $real -c mpm.c -o $dir/$check.o || return 1; done
}
runs() { # how to run a program ("": as it is), compiler...
    how=$1
    shift
    limited "$@" $flags -O1 tests/compile/agree.c -o $dir/$check.agree -lm &&
        limited "$@" $flags -O1 tests/40_io.c -o $dir/$check.io -lm || return 1
    [ "$how" = none ] && return
    numbers $dir/$check.numbers limited $how $dir/$check.agree && agree tests/compile/agree.golden $dir/$check.numbers &&
        golden_bits "$how" "$@" && in_folder timeout 1500 nice $how $here/$check.io
}
golden_bits() { # how to run a program, compiler...
    how=$1
    shift
    for real in "" -DMPM_FLOAT; do
        limited "$@" $flags $real -O1 tests/70_bits.c -o $dir/$check.bits -lm && limited $how $dir/$check.bits elastic ||
            return 1
    done
}
both() { # options, how to run, compiler...
    options=$1 how=$2
    shift 2
    builds "$options" "$@" && runs "$how" "$@"
}
check_gcc() { try "compiler gcc" gcc both "$strict -O2" "" gcc; }
check_clang() { try "compiler clang" clang both "$strict -O2" "" clang; }
check_tcc() { try "compiler tcc" tcc both "-I." "" tcc; }
check_musl() { try "compiler musl-gcc" musl-gcc both "$strict" "" musl-gcc -static; }
check_m32() {
    name="compiler gcc -m32"
    # Debian's package with asm/ for -m32 may not stand beside a cross compiler: the 64 bit one has the same names.
    m32="gcc -m32 -msse2 -mfpmath=sse -idirafter /usr/include/$(gcc -print-multiarch 2>/dev/null)"
    if ! echo 'int main(void) { return 0; }' | $m32 -include errno.h -x c - -o $dir/m32 2>/dev/null; then
        line "$name" "skip: gcc's 32 bit library is not installed"
        return
    fi
    try "$name" gcc both "$strict" "" $m32
}
emulated() { # name, compiler, options, emulator, its options...: only built where there is none to run it
    name=$1 compiler=$2 options=$3 how=none note="built; no $4 to run it"
    shift 3
    have "$1" && how=$* note="run by $1"
    try "$name" "$compiler" both "$strict" "$how" "$compiler" $options
}
check_mingw() {
    WINEDEBUG=-all WINEPREFIX=$here/wine
    export WINEDEBUG WINEPREFIX
    emulated "compiler mingw-w64" x86_64-w64-mingw32-gcc -static wine
}
check_s390x() { emulated "compiler s390x, big-endian" s390x-linux-gnu-gcc -static qemu-s390x; }
check_armhf() { # the emulator hands on numbers of files in 64 bits
    emulated "compiler armhf, 32 bit" arm-linux-gnueabihf-gcc "-static -D_FILE_OFFSET_BITS=64" qemu-arm
}
check_bare() { # its enums are unsigned bytes: that they are not negative is then no question
    note=built
    try "compiler arm-none-eabi" arm-none-eabi-gcc builds "$strict -Wno-type-limits -mcpu=cortex-m7 -mthumb" \
        arm-none-eabi-gcc
}
check_board() { # it says itself how it went
    line "Cortex-M4, 128 KiB flash, 256 KiB RAM" "$(limited sh examples/embedded/run.sh cc 2>&1 | tail -n 1)" \
        "$(version qemu-system-arm)"
}

# ---- sanitizers: tests of the step, of files, pictures and sprays
sanitized() { # options
    for t in 21_world 40_io 41_draw 50_spray 51_spray_input; do
        limited clang $flags -O1 -g $1 tests/$t.c -o $dir/$check.$t -lm || return 1
        in_folder timeout 1500 nice $here/$check.$t >$dir/$check.$t.log 2>&1 || { cat $dir/$check.$t.log; return 1; }
    done
}
check_address() {
    try "address, undefined, casts" clang sanitized "-fsanitize=address,undefined,float-cast-overflow \
-fsanitize=implicit-integer-sign-change -fno-sanitize-recover=all"
}
check_memory() { try "uninitialised memory" clang sanitized "-fsanitize=memory -fno-sanitize-recover=all"; }
raced() {
    limited clang $flags -O1 -g -fsanitize=thread tests/hard/threads.c -o $dir/threads -lm -lpthread &&
        limited $dir/threads
}
check_threads() { try "two threads, one material" clang raced; }
grinds() {
    limited cc $flags -O1 -g tests/21_world.c -o $dir/grind -lm &&
        in_folder timeout 1500 nice valgrind -q --error-exitcode=9 --leak-check=full $here/grind
}
check_valgrind() { try "valgrind" valgrind grinds; }

# ---- all of them -----------------------------------------------------------------------------
if [ "$1" = --one ]; then # this script again, as one of the jobs
    kills=$2
    check=$3
    note=
    check_$check
    exit 0
fi
kills=$1
jobs=$2
shift 2
[ $# -gt 0 ] || set -- $all
mkdir -p $dir
rm -f $dir/*.line
cc $flags -O1 examples/impact.c -o $dir/impact -lm || exit 1
echo "$@" | tr ' ' '\n' | xargs -P "$jobs" -n 1 sh "$0" --one "$kills"
for check in "$@"; do
    [ -f "$dir/$check.line" ] || line "$check" "found: it did not come to its end"
done
! grep -h '| found' $dir/*.line || bad=1
[ "$*" = "$(echo $all)" ] || exit "${bad:-0}"
{
    echo "# Quality"
    echo
    echo "Written by \`make hard\` on $(uname -s) $(uname -m), for mpm.h" \
        "$(sed -n 's/^.define MPM_VERSION "\(.*\)"/\1/p' mpm.h)."
    echo
    echo "| what | result | tool |"
    echo "|---|---|---|"
    for check in $all; do cat $dir/$check.line; done
    echo
    sed -n '/^## Other targets$/,$p' docs/quality.md # written by hand: it stays
} >docs/quality.md.part && mv docs/quality.md.part docs/quality.md || exit 1
exit "${bad:-0}"
