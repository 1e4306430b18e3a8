#!/usr/bin/env bash
# Shards under a real Slurm on this machine: an array with a limit, one task killed, one preempted, all
# continued, merged and compared with one unsharded run.
#
# `slurm.sh FOGBENCH` needs slurm-wlm and munge, and root. Where it cannot run it says why and skips, which is a
# failure with FOGBENCH_REQUIRE_SLURM=1. Daemons are started here and ended by their ids.
set -euo pipefail
fogbench=$(realpath "$1")

skip() {
    echo "skipped: slurm: $1"
    [ "${FOGBENCH_REQUIRE_SLURM:-0}" != 1 ] || exit 1
    exit 0
}
[ "$(id -u)" = 0 ] || skip "the daemons need root"
for program in slurmctld slurmd munged sbatch; do
    command -v "$program" > /dev/null || skip "there is no $program (Debian: slurm-wlm munge)"
done

at=$(mktemp -d)
chmod 755 "$at"
pids=()
finish() {
    local status=$?
    for pid in "${pids[@]}"; do kill "$pid" 2> /dev/null || true; done
    sleep 1
    for pid in "${pids[@]}"; do kill -9 "$pid" 2> /dev/null || true; done
    if [ "$status" -ne 0 ]; then
        tail -n 20 "$at"/work/*.log "$at"/slurm*.out "$at"/slurmctld.log "$at"/slurmd.log 2> /dev/null || true
    fi
    rm -rf "$at"
    exit "$status"
}
trap finish EXIT

# A minute at most for a condition that is about to hold.
wait_for() {
    local what=$1 tries=${2:-300}
    shift 2
    while ! "$@" > /dev/null 2>&1; do
        tries=$((tries - 1))
        [ "$tries" -gt 0 ] || { echo "never $what" >&2; squeue >&2 || true; return 1; }
        sleep 0.2
    done
}

# Keys, folders and configuration of their own: nothing of the system's is touched.
mkdir -p "$at"/{munge,state,spool,work}
head -c 1024 /dev/urandom > "$at/munge.key"
chmod 400 "$at/munge.key"
munged --foreground --force --key-file="$at/munge.key" --socket="$at/munge/socket" \
    --pid-file="$at/munge/pid" --seed-file="$at/munge/seed" --log-file="$at/munge/log" > /dev/null 2>&1 &
pids+=($!)
wait_for "munge" 100 test -S "$at/munge/socket"

host=$(hostname -s)
port=$((20000 + RANDOM % 10000))
cat > "$at/slurm.conf" << CONF
ClusterName=fogbench
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=$port
SlurmdPort=$((port + 1))
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket=$at/munge/socket
CredType=cred/munge
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
ReturnToService=2
StateSaveLocation=$at/state
SlurmdSpoolDir=$at/spool
SlurmctldPidFile=$at/slurmctld.pid
SlurmdPidFile=$at/slurmd.pid
SlurmctldLogFile=$at/slurmctld.log
SlurmdLogFile=$at/slurmd.log
PreemptType=preempt/partition_prio
PreemptMode=REQUEUE
SlurmctldParameters=preempt_send_user_signal
RequeueExit=75
SchedulerParameters=sched_interval=2,batch_sched_delay=0,requeue_delay=1
NodeName=$host NodeAddr=127.0.0.1 CPUs=2 State=UNKNOWN
PartitionName=low Nodes=$host Default=YES PriorityTier=1 GraceTime=10 MaxTime=10 OverSubscribe=NO
PartitionName=high Nodes=$host PriorityTier=10 PreemptMode=OFF MaxTime=10 OverSubscribe=NO
CONF
echo "CgroupPlugin=cgroup/v1" > "$at/cgroup.conf"
export SLURM_CONF=$at/slurm.conf
slurmctld -D -i > "$at/slurmctld.out" 2>&1 &
pids+=($!)
slurmd -D > "$at/slurmd.out" 2>&1 &
pids+=($!)
is_idle() { [ "$(sinfo -h -p low -o %T)" = idle ]; }
wait_for "idle" 100 is_idle

cd "$at/work"
export FOGBENCH=$fogbench SHARDS=shards OUTPUT=merged
# A shard has to last for some seconds, or none is at work when it is to be stopped: as long as this machine needs.
scenario() {
    cat > many.toml << SCENARIO
schema = 1
name = "many"
duration_s = $1
warm_up_s = 1.0
repeats = 48
SCENARIO
}
scenario 60.0
cpu_s=$("$fogbench" plan many.toml -o first.plan --shards 8 | sed -n 's/.*about \([0-9]*\) CPU seconds.*/\1/p')
scenario "${FOGBENCH_SLURM_DURATION_S:-$((60 * 48 / (cpu_s > 4 ? (cpu_s < 48 ? cpu_s : 48) : 4))).0}"
"$fogbench" plan many.toml -o suite.plan --shards 8 --slurm
"$fogbench" run many.toml -q -o whole > whole.txt

echo "the merge is job $(sh suite.plan.slurm --array=1-8%2)"
part() { echo "shards/.fogbench/shard-000$1-of-0008.fogshard.part"; }
at_work() { [ "$(stat -c %s "$(part "$1")" 2> /dev/null || echo 0)" -gt 20000 ]; }
# One task is killed with no time for anything, and is missing from then on: its lock says which process.
wait_for "shard 1 at work" 300 at_work 1
kill -9 "$(awk '{ print $2 }' shards/.fogbench/shard-0001-of-0008.fogshard.lock)"
# Others are preempted by a job that wants the whole node: they have ten seconds, and need none.
wait_for "shard 3 at work" 600 at_work 3
sbatch --parsable --partition=high --exclusive --output=/dev/null --wrap="sleep 2" > /dev/null
has_stopped() { grep -q "the same command goes on" fogbench-*.log; }
wait_for "a shard that was stopped" 300 has_stopped
echo "preempted: $(grep -l 'the same command goes on' fogbench-*.log | tr '\n' ' ')"

# A requeued task is held for two minutes; to wait is no part of the test.
release() {
    local id
    for id in $(squeue -h -r -t PD -o "%A"); do
        scontrol update jobid="$id" starttime=now > /dev/null 2>&1 || true
        scontrol release "$id" > /dev/null 2>&1 || true
    done
    [ -z "$(squeue -h)" ]
}
wait_for "the end of the array and of the merge" 600 release
"$fogbench" status shards
missing=$("$fogbench" status shards --missing)
[ "$missing" = 1 ] || { echo "missing: $missing, not the task that was killed" >&2; exit 1; }
grep -q "1 of 8 shards are missing: 1" fogbench-merge-*.log

# The list that `status` prints is what the script takes; what was finished is not run again.
sh suite.plan.slurm --array="$missing" > /dev/null
wait_for "the end" 600 release
cat fogbench-merge-*.log | tail -n 3
grep -hq "shard 1 of 8: .* of them before" fogbench-*.log
diff -r --exclude=.fogbench whole merged
echo "8 shards under Slurm, one killed, one preempted: the bytes of one run"
