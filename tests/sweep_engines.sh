#!/bin/sh
# One sweep under make -j, xargs -P, GNU parallel and Slurm's job arrays, and where answers of the file system get lost:
# each collection equals that of one worker.
# Called by `make sweep-test`; what is not installed is skipped. Slurm is a real one of this machine alone, with its
# settings, its key and its ports in build/tests/engines; one task of its array is cancelled and put back in the queue.
set -u
dir=build/tests/engines
. tests/check.sh
rm -rf "$dir"
mkdir -p "$dir"
top=$(pwd)
here=$top/$dir
keys=pbcp_percent,v_rest_mean_m_s,eps_mean,steps
tasks=16
long=9 # this one takes some seconds and goes on from a checkpoint
awk -v n=$tasks -v long=$long 'BEGIN {
    print "program,velocity,geometry,cell,spacing,time,frames"
    for (k = 0; k < n; k++)
        printf "impact,%d,axisymmetric,%s,0\n", 700 + 10 * k, k == long ? "0.7,0.35,80" : "2,1,10" }' >"$dir/tasks.csv"
sweep="build/sweep $dir/tasks.csv"
collected() { # folder: complete, and equal to one worker's
    $sweep --out "$dir/$1" --collect --keys $keys && cmp "$dir/serial/results.csv" "$dir/$1/results.csv"
}
numbers() { $sweep --out "$dir/$1" --list | cut -d' ' -f1; } # of the tasks that are left
there() { # program: or a line that says so
    command -v "$1" >/dev/null && return
    echo "skip - $1: not installed"
    false
}
until_true() { # seconds, command...
    tries=$((5 * $1))
    shift
    until "$@" >/dev/null 2>&1; do
        tries=$((tries - 1))
        [ $tries -gt 0 ] || return 1
        sleep 0.2
    done
}

check "one worker" $sweep --out "$dir/serial" --run --quiet
check "... collected" collected serial

cat >"$dir/Makefile" <<END
TASKS := \$(shell $sweep --out $dir/make --list | cut -d' ' -f1)
all: \$(TASKS:%=task-%)
task-%: ; $sweep --out $dir/make --task \$*
END
if there make; then
    check "make -j" env MAKEFLAGS= make -j2 -f "$dir/Makefile"
    check "... collected" collected make
fi
by_xargs() { numbers xargs | xargs -P 2 -n 1 $sweep --out "$dir/xargs" --task; }
workers() { seq 3 | xargs -P 3 -n 1 sh -c "$sweep --out $dir/workers --run"; }
if there xargs; then
    check "xargs -P, a process for each task" by_xargs
    check "... collected" collected xargs
    check "xargs -P, three workers" workers
    check "... collected" collected workers
fi
by_parallel() { numbers parallel | parallel -j 2 $sweep --out "$dir/parallel" --task; }
if there parallel; then
    check "GNU parallel" by_parallel
    check "... collected" collected parallel
fi

# ---- answers that get lost, as on NFS
lossy() { # every process of it: library before libc
    seq 3 | LD_PRELOAD="$here/nfs.so" xargs -P 3 -n 1 sh -c "$sweep --out $dir/nfs --run"
}
if [ "$(uname -s)" = Linux ] && cc -shared -fPIC -O1 tests/sweep_nfs.c -o "$dir/nfs.so" -ldl 2>"$dir/nfs.said"; then
    check "links and renamings whose answers are lost" lossy
    check "... collected" collected nfs
    check "... each task was run once" [ "$(find "$dir/nfs/claims" -name '*.2' | wc -l)" -eq 0 ]
else
    echo "skip - lost answers: no Linux, or no shared library here"
fi

# ---- Slurm
stop_slurm() {
    for name in slurmd slurmctld munged; do
        [ -s "$here/$name.pid" ] && kill "$(cat "$here/$name.pid")" 2>/dev/null
    done
}
start_slurm() {
    host=$(hostname -s)
    mkdir -p "$here/state" "$here/spool"
    cat >"$here/slurm.conf" <<END
ClusterName=sweep
SlurmctldHost=$host(127.0.0.1)
SlurmUser=$(id -un)
SlurmdUser=$(id -un)
AuthType=auth/munge
CredType=cred/munge
AuthInfo=socket=$here/munge.socket
SlurmctldPort=16817
SlurmdPort=16818
StateSaveLocation=$here/state
SlurmdSpoolDir=$here/spool
SlurmctldPidFile=$here/slurmctld.pid
SlurmdPidFile=$here/slurmd.pid
SlurmctldLogFile=$here/slurmctld.log
SlurmdLogFile=$here/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SlurmdParameters=config_overrides
SchedulerParameters=batch_sched_delay=0,sched_interval=1
ReturnToService=2
KillWait=20
MpiDefault=none
SwitchType=switch/none
NodeName=$host NodeAddr=127.0.0.1 CPUs=2 State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
END
    (umask 077 && dd if=/dev/urandom of="$here/munge.key" bs=128 count=1 2>/dev/null)
    export SLURM_CONF="$here/slurm.conf"
    munged --force --key-file="$here/munge.key" --socket="$here/munge.socket" --log-file="$here/munged.log" \
        --pid-file="$here/munged.pid" --seed-file="$here/munge.seed" >"$here/started" 2>&1 &&
        slurmctld -c >>"$here/started" 2>&1 && slurmd >>"$here/started" 2>&1 &&
        until_true 20 sh -c 'sinfo -h -o %t | grep -qx idle'
}
submit() { # folder, options...: by the line that the script itself names; its job's number in $job
    folder=$1
    shift
    line=$($sweep --out "$dir/$folder" "$@" --slurm | sed -n 's/^# submit: //p')
    echo "$line"
    job=$(sh -c "$line" | sed -n 's/^Submitted batch job //p')
    [ -n "$job" ]
}
submitted() { submit "$@" >"$dir/check.submit" 2>&1 || { cat "$dir/check.submit"; false; }; }
queue_empty() { [ -z "$(squeue -h)" ]; }
state() { scontrol show job "$job"_$long | sed -n 's/^ *JobState=\([A-Z]*\).*/\1/p'; }
is() { [ "$(state)" = "$1" ] || { echo "it is $(state)"; false; }; }
long_runs() { ls "$dir"/slurm/attempts/*/stdout.txt && is RUNNING; }
PATH=$PATH:/usr/sbin:/sbin
if there munged && there slurmctld && there slurmd && there sbatch; then
    trap stop_slurm EXIT
    trap 'exit 1' HUP INT TERM
    if start_slurm; then
        submitted slurm
        check "sbatch, by the line that --slurm prints" [ -n "$job" ]
        check "... its long task is under way" until_true 120 long_runs
        sleep 1
        check "... cancelled" scancel "$job"_$long
        check "... it is cancelled" until_true 30 is CANCELLED
        check "... the others end" until_true 120 queue_empty
        check "... and the collection is incomplete" sh -c "! $sweep --out $dir/slurm --collect --keys $keys"
        check "... back in the queue" scontrol requeue "$job"_$long
        scontrol update JobId="$job"_$long StartTime=now 2>/dev/null # Slurm would wait two minutes
        check "... and done" until_true 120 is COMPLETED
        check "... from its checkpoint" grep -q '"resume": "on"' "$dir"/slurm/runs/*/summary.json
        check "... collected" collected slurm
        submitted slurm_workers --workers 2
        check "an array of two workers" [ -n "$job" ]
        check "... ends" until_true 120 queue_empty
        check "... collected" collected slurm_workers
    else
        echo "skip - Slurm does not start here: $(tail -n 1 "$here/started")"
    fi
fi
check_end
