#!/bin/sh
# build/sweep: tasks from a table, by several workers at once who are killed at random moments; every result is there
# once, none that was finished was made again, and all bytes but the times equal those of one worker left in peace.
#   sh tests/69_sweep.sh CC [TASKS [SEED]]: 20 tasks, or more; `make sweep-test` takes 200
set -u
tasks=${2:-20} seed=${3:-1}
dir=build/tests/sweep
. tests/check.sh
rm -rf "$dir"
mkdir -p "$dir"
top=$(pwd)
table=$dir/tasks.csv
# An impact that notes its start, and whether its result was there by then. It runs in OUT/attempts/HASH.ATTEMPT.
cat >"$dir/hit" <<END
#!/bin/sh
case \$1 in --help | --version) exec "$top/build/impact" "\$1" ;; esac
hash=\${PWD##*/}
[ ! -e "../../runs/\${hash%.*}" ] || echo "\$hash" >>../../repeated
echo "\$hash \$*" >>../../started
exec "$top/build/impact" "\$@"
END
# A program that reads a file and has a flag.
cat >"$dir/reader" <<'END'
#!/bin/sh
case $1 in
--help) printf 'usage\n  --file      a file [none]\n  --loud      say more [off]\n  --fail      status [0]\n' && exit ;;
--version) echo reader 1 && exit ;;
esac
while [ $# -gt 0 ]; do
    case $1 in
    --file) read -r text <"$2"; shift ;;
    --loud) loud=1 ;;
    --fail) echo "error: asked to fail" >&2; exit "$2" ;;
    esac
    shift
done
echo "text = $text"
echo "loud = ${loud:-0}"
END
chmod +x "$dir/hit" "$dir/reader"
awk -v n="$tasks" -v hit="$dir/hit" 'BEGIN {
    print "# a sweep of the tests\nprogram,velocity,bond,geometry,cell,spacing,time,frames"
    for (k = 0; k < n; k++)
        printf "%s,%g,%s,axisymmetric,2,1,%d,0\n", hit, 600 + 300 * k / n, k % 3 ? "" : "none", 5 + 3 * (k % 2)
}' >"$table"
keys=pbcp_percent,v_rest_mean_m_s,eps_mean,steps
sweep() { # folder, options...
    folder=$1
    shift
    build/sweep "$table" --quiet --out "$dir/$folder" "$@"
}
ends() { # status, command...
    want=$1
    shift
    "$@"
    got=$?
    [ "$got" -eq "$want" ] || { echo "ends with $got"; false; }
}
says() { # text, status, command...: it ends so and says so
    text=$1
    shift
    ends "$@" >"$dir/said" 2>&1 && grep -qF -- "$text" "$dir/said" && return
    cat "$dir/said"
    false
}
started() { # folder: how many runs were begun
    if [ -f "$dir/$1/started" ]; then wc -l <"$dir/$1/started"; else echo 0; fi
}
begun() { [ "$(started "$1")" -eq "$2" ] || { echo "$(started "$1") were begun"; false; }; }
same_results() { # two folders: the same results, in the same bytes but for the times
    ls "$dir/$1/runs" >"$dir/names.1"
    ls "$dir/$2/runs" >"$dir/names.2"
    cmp "$dir/names.1" "$dir/names.2" && cmp "$dir/$1/results.csv" "$dir/$2/results.csv" || return 1
    while read -r hash; do
        for folder in "$1" "$2"; do
            cat "$dir/$folder/runs/$hash/summary.json" "$dir/$folder/runs/$hash/stdout.txt" |
                grep -vE '"(cpu_seconds|point_steps_per_second)"' >"$dir/$folder.json"
        done
        cmp "$dir/$1.json" "$dir/$2.json" || return 1
    done <"$dir/names.1"
}

# ---- one worker
check "a sweep by one worker" sweep serial --run
check "... each task once" begun serial "$tasks"
check "... collected" sweep serial --collect --keys $keys
check "... a row each" [ "$(grep -c ',finished,[0-9]' "$dir/serial/results.csv")" -eq "$tasks" ]
check "once more" sweep serial --run
check "... and nothing is run" begun serial "$tasks"
check "nothing is left to list" [ -z "$(sweep serial --list)" ]
check "its status, without the table" says "$tasks tasks: $tasks finished, 0 failed, 0 under way, 0 open" 0 \
    build/sweep --status --out "$dir/serial"
awk -F, -v OFS=, '!/^#/ { t = $2; $2 = $7; $7 = t } 1' "$table" >"$dir/turned.csv"
check "another order of the columns" build/sweep "$dir/turned.csv" --quiet --out "$dir/serial" --run
check "... is the same tasks" begun serial "$tasks"
set -- "$dir"/serial/runs/*
sed 's/"steps": /"steps": 1/' "$1/summary.json" >"$dir/damaged"
cp "$dir/damaged" "$1/summary.json"
check "a damaged result is listed" [ "$(sweep serial --list | wc -l)" -eq 1 ]
touch -d '1 hour ago' "$dir"/serial/claims/*
check "... and run again" sweep serial --run
check "... it alone" begun serial $((tasks + 1))
check "... and the collection is what it was" sweep serial --collect --keys $keys

# ---- two workers, one task
sweep pair --task 3 &
sweep pair --task 3
one=$?
wait $!
check "two workers on one task: both end well" [ "$one$?" = 00 ]
check "... and it was run once" begun pair 1
check "one result is left in the status" says "$tasks tasks: 1 finished, 0 failed, 0 under way, $((tasks - 1)) open" 0 \
    build/sweep --status --out "$dir/pair"
check "an incomplete collection says so" says "1 of $tasks tasks" 3 build/sweep "$table" --out "$dir/pair" --collect

# ---- killed at random moments; a long test does it twice
random() { # from, to: a whole number
    seed=$(((seed * 1103515245 + 12345) % 2147483648))
    echo $(($1 + seed / 65536 % ($2 - $1 + 1)))
}
worker() { # folder: starts one, pid in $!
    build/sweep "$table" --quiet --out "$dir/$1" --run --dead 3 --tries 1000 2>>"$dir/workers" &
}
moment() { # folder: shortly after another run was begun, or after half a second without one
    naps=0
    until [ "$(started "$1")" -gt $seen ] || [ $naps -ge 50 ]; do
        sleep 0.01
        naps=$((naps + 1))
    done
    seen=$(started "$1")
    sleep "0.0$(random 0 6)"
}
killed() { # folder: three workers, one of them killed every now and then and another one started
    kills=0
    worker "$1" && a=$!
    worker "$1" && b=$!
    worker "$1" && c=$!
    seen=0
    while [ $kills -lt $((tasks / 4)) ]; do
        moment "$1"
        case $(random 0 2) in 0) who=$a ;; 1) who=$b ;; *) who=$c ;; esac
        case $(random 0 3) in 0) kill -TERM "$who" ;; *) kill -KILL "$who" ;; esac
        wait "$who"
        kills=$((kills + 1))
        worker "$1"
        case $who in "$a") a=$! ;; "$b") b=$! ;; *) c=$! ;; esac
    done
    wait
    echo "# $1: $kills kills, $(($(started "$1") - tasks)) of $(started "$1") runs died of them"
    sweep "$1" --run --dead 3 --tries 1000
}
rounds=killed_once
[ "$tasks" -lt 100 ] || rounds="killed_once killed_twice"
for name in $rounds; do
    killed $name 2>>"$dir/shell" || echo "# $name does not end well"
    check "killed workers: all tasks finished" [ -z "$(sweep $name --list)" ]
    check "... some runs died, and were made again" [ "$(started $name)" -gt "$tasks" ]
    check "... no finished one was" [ ! -e "$dir/$name/repeated" ]
    check "... collected" sweep $name --collect --keys $keys
    check "... to the bytes of one worker" same_results serial $name
    check "... nothing half-done is left" [ -z "$(ls "$dir/$name/attempts")" ]
done

# ---- asked to stop, it goes on from the checkpoint
sed -n '1,2p' "$table" >"$dir/long.csv"
echo "$dir/hit,810,,axisymmetric,1,0.5,30,0" >>"$dir/long.csv"
check "a long task" build/sweep "$dir/long.csv" --out "$dir/whole" --run
check "... its collection" build/sweep "$dir/long.csv" --out "$dir/whole" --collect --keys $keys
build/sweep "$dir/long.csv" --out "$dir/stopped" --run >"$dir/stop.said" 2>&1 &
pid=$!
until [ -s "$dir/stopped/started" ]; do sleep 0.1; done
sleep 0.3
check "it is under way" says "1 tasks: 0 finished, 0 failed, 1 under way, 0 open" 0 \
    build/sweep --status --out "$dir/stopped"
kill -TERM $pid
check "asked to stop" ends 3 wait $pid
check "... it says so" grep -q "1 of 1 tasks are left" "$dir/stop.said"
check "... and another worker goes on at once" build/sweep "$dir/long.csv" --out "$dir/stopped" --run --dead 100000
check "... from the checkpoint" grep -q -- --resume "$dir/stopped/started"
check "... collected" build/sweep "$dir/long.csv" --out "$dir/stopped" --collect --keys $keys
check "... to the same numbers" cmp "$dir/whole/results.csv" "$dir/stopped/results.csv"

# ---- taken for dead, and alive: a stopped worker whose program runs on; the long test has the time for it
revived() { # its task is another's, done by now; it finds that and ends well
    build/sweep "$dir/long.csv" --quiet --out "$dir/revived" --run --dead 3 &
    pid=$!
    until [ -s "$dir/revived/started" ]; do sleep 0.1; done
    kill -STOP $pid
    build/sweep "$dir/long.csv" --quiet --out "$dir/revived" --run --dead 3
    other=$?
    kill -CONT $pid
    wait $pid
    [ "$other$?" = 00 ]
}
if [ "$tasks" -ge 100 ]; then
    check "a worker taken for dead comes back" revived
    check "... its task was begun twice" begun revived 2
    check "... collected" build/sweep "$dir/long.csv" --out "$dir/revived" --collect --keys $keys
    check "... to the same numbers" cmp "$dir/whole/results.csv" "$dir/revived/results.csv"
    check "... nothing half-done is left" [ -z "$(ls "$dir/revived/attempts")" ]
fi

# ---- a study keeps the runs that it has made
coarse=gimp,2,1,24,6,0.5,40,1000,2e5,stays,500,900,100,50
{
    printf 'program,method,functions,cell,spacing,substrate-diameter,substrate-height,margin,time,gc,gdot,rule,'
    printf 'low,high,scan,step,limit\ncritical_velocity,thesis,%s,2\n' $coarse
} >"$dir/search.csv"
if [ -x build/critical_velocity ]; then
    check "a study that stops after two runs" build/sweep "$dir/search.csv" --out "$dir/search" --run --dead 3
    check "... goes on with them" grep -q '"runs_made_now": [12],' "$dir"/search/runs/*/summary.json
fi

# ---- two processes of one study share its runs
calibrate() { # folder
    build/calibrate --functions gimp --cell 2 --spacing 1 --substrate-diameter 24 --substrate-height 6 --margin 0.5 \
        --time 4 --columns 5 --rows 5 --diameter-2 16 --gc-low 200 --gc-high 4000 --pbcp-1 10 --pbcp-2 10 \
        --restitution-1 1 --restitution-2 1 --quiet --out "$dir/$1"
}
count() { find "$dir/shared/$1" -name "$2" | wc -l; }
if [ -x build/calibrate ]; then
    check "a calibration by one process" calibrate alone
    calibrate shared &
    calibrate shared
    one=$?
    wait $!
    check "the same by two: both end well" [ "$one$?" = 00 ]
    check "... each made some of the runs" [ "$(sed 's/[.][^.]*$//' "$dir"/shared/claims/* | sort -u | wc -l)" -eq 2 ]
    check "... each run once" [ "$(count claims '*.1') $(count claims '*.2')" = "$(count runs '*.json') 0" ]
    check "... to the same classes" cmp "$dir/alone/tasks.csv" "$dir/shared/tasks.csv"
fi

# ---- inputs, flags, failures
echo first >"$dir/input"
printf 'program,file,loud,fail\r\n"%s", "%s" ,on,\r\n%s,%s,off,\r\n\r\n' "$dir/reader" "$dir/input" "$dir/reader" \
    "$dir/input" >"$dir/read.csv"
read_sweep() { build/sweep "$dir/read.csv" --out "$dir/read" "$@"; }
check "a program that reads a file" read_sweep --run
check "... collected from what it printed" read_sweep --collect --keys text,loud
check "... the flag that is given" grep -qE 'on,,finished,first,1$' "$dir/read/results.csv"
check "... the flag that is not" grep -qE 'off,,finished,first,0$' "$dir/read/results.csv"
cp "$dir/input" "$dir/other"
sed "s,/input,/other," "$dir/read.csv" >"$dir/other.csv"
check "the same content under another name" [ -z "$(build/sweep "$dir/other.csv" --out "$dir/read" --list)" ]
echo second >"$dir/input"
check "another content is another task" [ "$(read_sweep --list | wc -l)" -eq 2 ]
printf 'program,fail\n%s,7\n' "$dir/reader" >"$dir/fails.csv"
fails() { build/sweep "$dir/fails.csv" --out "$dir/fails" "$@"; }
check "a task that fails, with its reason" says "exit status 7: error: asked to fail" 1 fails --run
check "... stays failed" says "1 of 1 tasks failed" 1 fails --run
check "... without another run" [ "$(ls "$dir"/fails/claims/*.* | wc -l)" -eq 1 ]
check "... is tried again when asked" says "exit status 7" 1 fails --run --again
check "... and collected as failed" ends 3 fails --collect
check "... in a row of its own" grep -q ',7,failed$' "$dir/fails/results.csv"

# ---- what is refused
refused() { # text, options...: an error that names it
    text=$1
    shift
    check "refused: $text" says "$text" 1 build/sweep "$@" --out "$dir/refused"
}
lines() { printf '%b' "$1" >"$dir/bad.csv"; }
refused "wanted: one of" "$table"
refused "wanted: a table" --run
refused "none.csv cannot be read" "$dir/none.csv" --run
refused "--task $tasks: there are $tasks" "$table" --task "$tasks"
refused "--dead 1:" "$table" --run --dead 1
refused "--tries 0:" "$table" --run --tries 0
refused "--workers -1:" "$table" --slurm --workers -1
refused "unknown option" "$table" "$table" --run
lines 'program,velocity\n'
refused "has no task" "$dir/bad.csv" --run
lines 'program,velocity\nimpact,1\nimpact\n'
refused "line 3: 1 cells" "$dir/bad.csv" --run
lines 'program,velocity\nimpact,"1\n'
refused "line 2: cell 2 is no CSV" "$dir/bad.csv" --run
lines 'program,speed\nimpact,1\n'
refused "line 2: the program has no option 'speed'" "$dir/bad.csv" --run
lines 'program,velocity\nmud,1\n'
refused "there is no program 'mud'" "$dir/bad.csv" --run
lines 'velocity\n1\n'
refused "neither --program nor" "$dir/bad.csv" --run
lines 'program,out\nimpact,x\n'
refused "line 1: a column that is not the table's to set: 'out'" "$dir/bad.csv" --run
lines 'program,velocity,velocity\nimpact,1,2\n'
refused "two columns of the name 'velocity'" "$dir/bad.csv" --run
lines 'program,touch\nimpact,yes\n'
refused "neither on nor off: 'yes'" "$dir/bad.csv" --run
check "a key that no result has" says "--keys mud: no result has it" 1 build/sweep "$table" --out "$dir/serial" \
    --collect --keys mud
check "... leaves the collection" same_results serial killed_once
check "nothing was begun" [ ! -e "$dir/refused/plan.csv" ]
check_end
