#!/usr/bin/env bash
# A batch by Slurm and by GNU parallel, as integrations/ has it: Slurm's daemons on the loopback, an array of shards, one
# of whose programs is killed in the middle, and a merge that waits for all.
#
#   tests/batch_engines.sh PROGRAM OUTPUT_FOLDER
#
# Ends with "N passed, N failed".
set -uo pipefail

program=$(realpath "$1")
mkdir -p "$2"
output=$(realpath "$2")
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
export LIMBER=$program
passed=0 failed=0

check() {
  local what=$1
  shift
  if "$@"; then
    passed=$((passed + 1))
  else
    failed=$((failed + 1))
    echo "FAILED: $what"
  fi
}

# Copies of one sample, each by a generator of its own.
make_models() {
  local count=$1 i
  rm -rf "$output"/*
  mkdir -p "$output/models"
  "$program" sample biped -o "$output/models/biped.gltf" --quiet || return 1
  for i in $(seq -w "$count"); do
    sed "s/\"generator\": \"[^\"]*\"/\"generator\": \"copy $i\"/" "$output/models/biped.gltf" >"$output/models/m$i.gltf"
  done
  rm "$output/models/biped.gltf"
  cat >"$output/plan.json" <<'PLAN'
{"limber_batch": 1, "command": ["rig", "{input}", "-o", "{output}", "--handles", "12"], "output": ".glb", "inputs": ["models"],
 "limits": {"seconds": 60, "memory_mb": 2048}}
PLAN
}

outputs_of() { (cd "$1/models" && sha256sum *.glb); }
is_whole() { [ "$(outputs_of "$1")" = "$(outputs_of "$output/whole")" ]; }
is_well() { "$program" batch status "$1" --quiet; }
records_of() { wc -l <"$1.records.jsonl"; }

# Slurm of Debian 12 with all daemons on this machine; "cred_expire" lets a requeued task begin after seconds, not minutes.
start_slurm() {
  local host
  slurm=$(mktemp -d)
  chmod 755 "$slurm"
  mkdir "$slurm/state" "$slurm/spool" "$slurm/run"
  host=$(hostname -s)
  cat >"$slurm/slurm.conf" <<CONF
ClusterName=test
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=28817
SlurmdPort=28818
CommunicationParameters=NoCtldInAddrAny,NoInAddrAny
SlurmUser=root
AuthInfo=socket=$slurm/run/munge.socket,cred_expire=5
StateSaveLocation=$slurm/state
SlurmdSpoolDir=$slurm/spool
SlurmctldPidFile=$slurm/run/slurmctld.pid
SlurmdPidFile=$slurm/run/slurmd.pid
SlurmctldLogFile=$slurm/slurmctld.log
SlurmdLogFile=$slurm/slurmd.log
ProctrackType=proctrack/pgid
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU_Memory
DefMemPerCPU=500
SlurmdParameters=config_overrides
SchedulerParameters=sched_interval=1,bf_interval=1,batch_sched_delay=0
ReturnToService=2
KillWait=2
NodeName=$host NodeAddr=127.0.0.1 CPUs=8 RealMemory=8000
PartitionName=test Nodes=$host Default=YES MaxTime=60 State=UP
CONF
  head -c 1024 /dev/urandom >"$slurm/munge.key"
  chmod 600 "$slurm/munge.key"
  export SLURM_CONF=$slurm/slurm.conf
  munged --key-file="$slurm/munge.key" --socket="$slurm/run/munge.socket" --pid-file="$slurm/run/munged.pid" \
    --log-file="$slurm/munged.log" --seed-file="$slurm/run/munge.seed" && slurmctld && slurmd -N "$host" &&
    timeout 30 sh -c 'until [ "$(sinfo -h -o %t)" = idle ]; do sleep 0.1; done'
}

stop_slurm() {
  local daemon
  for daemon in slurmd slurmctld munged; do
    [ ! -f "$slurm/run/$daemon.pid" ] || kill "$(cat "$slurm/run/$daemon.pid")" 2>/dev/null
  done
  sleep 0.3
  rm -rf "$slurm"
}

# Waits for the job's end; whatever became of it.
wait_for() { timeout 120 sh -c 'while squeue -h -j "$1" 2>/dev/null | grep -q .; do sleep 0.2; done' - "$1"; }

# Does the command end with this code?
ends_with() {
  local code=$1
  shift
  "$@" >/dev/null 2>&1
  [ $? = "$code" ]
}

by_slurm() {
  local out=$output/slurm array merge killed
  trap stop_slurm EXIT
  check "Slurm starts" start_slurm || return
  read -r array merge < <(cd "$output" && "$root/integrations/slurm/submit.sh" plan.json "$out" 4 --output="$output/slurm-%A_%a.log")
  # One of the programs, once it is at work.
  timeout 30 sh -c 'until ls "$1"/.limber-batch/records/2-of-4.jsonl >/dev/null 2>&1; do sleep 0.02; done' - "$out"
  killed=$(pgrep -f "batch .* --shard 2/4" | head -n 1)
  check "a shard's program is killed" kill -KILL "$killed"
  wait_for "$merge"
  check "the killed task went back to the queue" grep -q "goes back to the queue" "$output"/slurm-"$array"_2.log
  check "all outputs are there" is_well "$out"
  check "they are those of one go" is_whole "$out"
  check "the merge has a line for each" test "$(records_of "$out")" = "$models"
  # The folder is whole, of a plan that could be read.
  echo "{" >"$output/broken.json"
  read -r array merge < <(cd "$output" && "$root/integrations/slurm/submit.sh" broken.json "$out" 2 --output="$output/slurm-%A_%a.log")
  wait_for "$merge"
  check "the merge tells tasks that could not read their plan" grep -q "task 2: code 2" "$output/slurm-$merge.out"
  check "the merge fails with them" sh -c 'scontrol show job "$1" | grep -q ExitCode=4:' - "$merge"
  stop_slurm
  trap - EXIT
}

by_parallel() {
  local out=$output/parallel plan="$output/a \$plan.json"
  cp "$output/plan.json" "$plan"
  # Killed in the middle, and told to go on while those that it had started may still be at work.
  setsid "$root/integrations/gnu-parallel/limber_parallel.sh" "$plan" "$out" 4 >/dev/null 2>&1 &
  timeout 30 sh -c 'until ls "$1"/models/*.glb >/dev/null 2>&1; do sleep 0.02; done' - "$out"
  kill -KILL -- "-$!" 2>/dev/null
  wait 2>/dev/null
  check "it was killed before the end" test "$(ls "$out"/models/*.glb | wc -l)" -lt "$models"
  check "it goes on to a good end" "$root/integrations/gnu-parallel/limber_parallel.sh" "$plan" "$out" 4 >/dev/null
  check "parallel's outputs are those of one go" is_whole "$out"
  check "parallel's merge has a line for each" test "$(records_of "$out")" = "$models"
  echo "{" >"$plan"
  check "a plan that cannot be read has no good end" ends_with 4 "$root/integrations/gnu-parallel/limber_parallel.sh" "$plan" "$out" 4
  sed 's/"models"\]/"models", {"path": "none.glb"}]/' "$output/plan.json" >"$plan"
  check "an entry that fails is told by the sum" ends_with 1 "$root/integrations/gnu-parallel/limber_parallel.sh" "$plan" "$out" 4
}

models=60
check "models are made" make_models $models
check "in one go" "$program" batch "$output/plan.json" -o "$output/whole" --quiet
if command -v parallel >/dev/null; then by_parallel; fi
if [ "$(id -u)" = 0 ] && command -v slurmctld >/dev/null; then by_slurm; fi
echo "$passed passed, $failed failed"
[ $failed -eq 0 ]
