#!/bin/sh
# sh tests/hard/kill.sh N: a run that writes checkpoints and frames is killed N times at random moments, and goes on
# each time from what it finds. Its end and its series must be those of the run that nobody disturbed, byte for byte;
# a kill counts where the run died of it, and nine in ten must.
set -u
dir=build/hard/kill
steps=3000
rm -rf $dir
mkdir -p $dir
cc -std=c99 -O2 -ffp-contract=off -DMPM_NO_INLINE -I. tests/hard/kill.c -o $dir/kill -lm || exit 1
$dir/kill $dir/whole $steps || { echo "error: the undisturbed run fails with $?"; exit 1; }
whole() { # the run in $dir/killed came to its end
    cmp $dir/whole/end $dir/killed/end && cmp $dir/whole/series.pvd $dir/killed/series.pvd || exit 1
}
i=0
killed=0
ends=0
while [ $i -lt "$1" ]; do
    $dir/kill $dir/killed $steps &
    pid=$!
    sleep "0.$(awk -v s=$i 'BEGIN { srand(s + 1); rand(); printf "%03d", 10 + 150 * rand() }')"
    kill -9 $pid 2>/dev/null
    wait $pid 2>/dev/null
    case $? in
    137) killed=$((killed + 1)) ;;
    0) whole && ends=$((ends + 1)) && rm -rf $dir/killed ;; # once more from the start
    *) echo "error: it does not go on after kill $i"; exit 1 ;;
    esac
    i=$((i + 1))
done
$dir/kill $dir/killed $steps || { echo "error: it does not go on: $?"; exit 1; }
whole
echo "$killed of $1 kills hit the run, which came to its end $((ends + 1)) times"
[ $((10 * killed)) -ge $((9 * $1)) ] || { echo "error: too few kills hit the run"; exit 1; }
