#!/bin/sh
# sh examples/embedded/run.sh CC: builds examples/embedded for the machine at hand and for a Cortex-M4, runs both, and
# compares their numbers. Says "ok: ...", "skip: reason" or "found: ...", the last with exit status 1.
set -u
cc=$1
dir=build/embedded
code=examples/embedded
set -- -std=c99 -pedantic -Wall -Wextra -Wconversion -Wshadow -Werror -Wno-type-limits -ffp-contract=off -I. \
    -DMPM_FLOAT -DMPM_STATIC -DMPM_NO_INLINE -DMPM_BLOCK=8
mkdir -p $dir
found() { echo "found: $*"; exit 1; }
skip() { echo "skip: $*"; exit 0; }
numbers() { grep -v '^#' $dir/"$1".out | sort >$dir/"$1".numbers; }

"$cc" "$@" -O2 $code/impact.c $code/desktop.c -o $dir/desktop -lm || found "it does not build with $cc"
$dir/desktop >$dir/desktop.out || found "it does not run here: $(tail -n 1 $dir/desktop.out)"
for tool in arm-none-eabi-gcc qemu-system-arm; do
    command -v $tool >/dev/null || skip "$tool is not installed"
done
echo 'int main(void) { return 0; }' |
    arm-none-eabi-gcc --specs=nano.specs --specs=nosys.specs -x c - -o $dir/probe.elf 2>/dev/null ||
    skip "arm-none-eabi-gcc has no newlib"
arm-none-eabi-gcc "$@" -Os -mcpu=cortex-m4 -mthumb -mfloat-abi=hard -mfpu=fpv4-sp-d16 -ffunction-sections \
    -fdata-sections -fno-inline-functions-called-once -Wl,--gc-sections --specs=nano.specs -nostartfiles \
    -T $code/board.ld $code/impact.c $code/board.c -o $dir/board.elf -lm ||
    found "it does not build, or not into 128 KiB of flash and 256 KiB of RAM"
! arm-none-eabi-nm $dir/board.elf | grep -iE ' _?(malloc|_malloc_r|sbrk|printf|fputs)$' ||
    found "it has malloc or stdio"
timeout 1500 qemu-system-arm -M mps2-an386 -nographic -monitor none -serial none \
    -chardev stdio,id=text -semihosting-config enable=on,target=native,chardev=text -kernel $dir/board.elf \
    >$dir/board.out </dev/null ||
    found "it does not run on the board: $(tail -n 1 $dir/board.out)"
numbers desktop
numbers board
# The name is all but the last word of a line.
paste $dir/desktop.numbers $dir/board.numbers | awk -F '\t' '
    { n = split($1, a, " "); m = split($2, b, " "); d = a[n] - b[m]; d = d < 0 ? -d : d; s = a[n] < 0 ? -a[n] : a[n]
      if (!(d <= 1e-4 * s) || a[1] != b[1]) { print "differs: " $1 ", " $2; bad = 1 } }
    END { exit bad || NR != 10 }' || found "its numbers are not those of this machine: see $dir"
stack=$(sed -n 's/^# bytes of stack \([0-9]*\) of .*/\1/p' $dir/board.out)
[ "${stack:-8192}" -lt 8192 ] || found "a stack of ${stack:-unknown} bytes"
arm-none-eabi-size $dir/board.elf | awk -v stack="$stack" 'NR == 2 {
    printf "ok: %.1f KiB of flash, %.1f KiB of RAM, of them %.1f KiB stack\n", ($1 + $2) / 1024, ($2 + $3) / 1024,
           stack / 1024 }'
