#!/bin/sh
# sh tests/fuzz/run.sh SECONDS JOBS: each fuzz target of this folder for so long, JOBS at a time, one line each. Inputs
# that break one are kept in build/fuzz/found-<target>-*, its words in build/fuzz/<target>.log. Exit 1 if any did.
set -u
flags="-std=c99 -O1 -g -ffp-contract=off -DMPM_NO_INLINE -I. -Iexamples -Iexamples/studies -Itests/fuzz"
check="address,undefined,float-cast-overflow"
dir=build/fuzz
if [ "$1" = --one ]; then # this script again, as one of the jobs
    t=$3
    clang $flags "-fsanitize=fuzzer,$check" -fno-sanitize-recover=undefined,float-cast-overflow "tests/fuzz/$t.c" \
        -o "$dir/$t" -lm >"$dir/$t.log" 2>&1 || { echo "$t: found: it does not compile, see $dir/$t.log"; exit 1; }
    mkdir -p "$dir/corpus-$t"
    "$dir/$t" -max_total_time="$2" -max_len=1024 -timeout=20 -rss_limit_mb=1500 -print_final_stats=1 \
        -artifact_prefix="$dir/found-$t-" "$dir/corpus-$t" "$dir/first" >"$dir/$t.log" 2>&1 && status=ok || status=found
    runs=$(sed -n 's/^stat::number_of_executed_units: *//p' "$dir/$t.log")
    why=$(grep -m1 -oE 'broken: .*|runtime error: .*|ERROR: [A-Za-z]+: [a-zA-Z-]+' "$dir/$t.log")
    echo "fuzz $t: $status${why:+ $why}, ${runs:-?} inputs in $2 s"
    [ $status = ok ]
    exit
fi
mkdir -p $dir/first
echo 'int LLVMFuzzerTestOneInput(const unsigned char *d, unsigned long n) { return d && n ? 0 : 0; }' >$dir/try.c
if ! clang -fsanitize=fuzzer,address $dir/try.c -o $dir/try 2>/dev/null; then
    echo "skip: fuzz: clang with libFuzzer is not installed (Debian: clang libclang-rt-14-dev)"
    exit 0
fi
${CC:-cc} -std=c99 -I. -Itests/fuzz -DFUZZ_CORPUS -x c tests/fuzz/fuzz.h -o $dir/corpus || exit 1
$dir/corpus $dir/first || exit 1
ls tests/fuzz/*.c | sed 's,.*/,,; s,\.c$,,' | xargs -P "$2" -n 1 sh "$0" --one "$1"
