#!/usr/bin/env bash
# Runs a sweep by Slurm, all of it on this machine: munged, slurmctld and three
# slurmd on the loopback, in a folder of their own. One task is started twice at
# once, one is requeued while it runs, and one dies together with its slurmd; in
# the end every result must be there once, and be that of a run without Slurm.
#   tests/slurm.sh [--no_install] [FOLDER OF THE PROGRAMS]
#   --no_install  where Slurm is missing, say so and exit with status 77
# Must be run by root. Otherwise installs what is missing: slurmctld, slurmd,
# slurm-client and munge, of Debian 12. Nothing that it starts is left running.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
export LC_ALL=C

skip() { echo "slurm not found: $1"; exit 77; }
say() { echo "slurm.sh: $(printf '%3d' $SECONDS) s: $1"; }
fail() {
  echo "slurm.sh: FAILED: $1" >&2
  tail -n 15 "$tmp"/log/*.log "$out"/slurm/*.log >&2 || true
  exit 1
}

install=1
if [[ "${1:-}" == --no_install ]]; then install=0; shift; fi
bin="$(realpath "${1:-build/release/bin}")"
for program in sf_batch sf_run sf_evaluate sf_synth; do
  [[ -x "$bin/$program" ]] && continue
  echo "slurm.sh: $bin/$program: not built" >&2
  exit 2
done
((EUID == 0)) || skip "its daemons must be started by root"
for program in slurmctld slurmd sbatch munged mungekey; do
  command -v "$program" >/dev/null && continue
  ((install)) || skip "install Debian's slurmctld, slurmd, slurm-client, munge"
  echo "slurm.sh: installing slurmctld, slurmd, slurm-client and munge"
  apt-get update -qq
  DEBIAN_FRONTEND=noninteractive apt-get install -qq -y \
    --no-install-recommends slurmctld slurmd slurm-client munge >/dev/null
  break
done

SECONDS=0
tmp="$(mktemp -d)"
chmod 755 "$tmp"  # munged wants its socket where all can reach it.
out="$tmp/the experiment's"
export SLURM_CONF="$tmp/slurm.conf"

# Kills daemons and jobs: all that was started with this configuration.
clean_up() {
  local status=$? environment
  trap '' INT TERM
  for environment in /proc/[0-9]*/environ; do
    if grep -qszxF "SLURM_CONF=$SLURM_CONF" "$environment"; then
      kill -9 "$(basename "$(dirname "$environment")")" 2>/dev/null || true
    fi
  done
  rm -rf "$tmp"
  exit "$status"
}
trap clean_up EXIT

# Waits until a command succeeds: wait_for SECONDS WHAT COMMAND...
wait_for() {
  local end=$((SECONDS + $1)) what="$2"
  shift 2
  until "$@"; do
    ((SECONDS < end)) || fail "waited too long for $what"
    sleep 0.2
  done
}

port_is_free() { ! (exec 3<>"/dev/tcp/127.0.0.1/$1") 2>/dev/null; }

# The first of four ports in a row that nobody listens on.
free_ports() {
  local first offset
  for ((first = 20000 + RANDOM % 20000; ; first += 4)); do
    for offset in 0 1 2 3; do
      port_is_free $((first + offset)) || continue 2
    done
    echo "$first"
    return
  done
}

configure() {
  local port host
  port="$(free_ports)"
  host="$(hostname -s)"
  mkdir "$tmp/log" "$tmp/state"
  echo "CgroupPlugin=cgroup/v1" >"$tmp/cgroup.conf"
  cat >"$SLURM_CONF" <<END
ClusterName=test
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=$port
SlurmUser=root
AuthType=auth/munge
AuthInfo=socket=$tmp/munge.socket,cred_expire=10
StateSaveLocation=$tmp/state
SlurmdSpoolDir=$tmp/spool_%n
SlurmctldPidFile=$tmp/slurmctld.pid
SlurmdPidFile=$tmp/%n.pid
SlurmctldLogFile=$tmp/log/slurmctld.log
SlurmdLogFile=$tmp/log/%n.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU_Memory
SlurmdParameters=config_overrides
SchedulerParameters=sched_interval=2,batch_sched_delay=0
ReturnToService=2
SlurmdTimeout=15
KillWait=30
MaxArraySize=4
MailProg=/bin/true
NodeName=node[1-3] NodeHostname=$host NodeAddr=127.0.0.1 \
  Port=[$((port + 1))-$((port + 3))] CPUs=1 RealMemory=4000
PartitionName=all Nodes=ALL Default=YES
END
}

nodes_are_idle() { [[ "$(sinfo -h -t idle -o %D 2>/dev/null)" == 3 ]]; }

start_daemons() {
  local node
  mungekey --create --keyfile="$tmp/munge.key"
  munged --force --socket="$tmp/munge.socket" --key-file="$tmp/munge.key" \
    --log-file="$tmp/log/munged.log" --pid-file="$tmp/munged.pid" \
    --seed-file="$tmp/munged.seed" 2>>"$tmp/log/munged.log"
  slurmctld -c 2>>"$tmp/log/start.log" || fail "slurmctld did not start"
  # With names of their own they are three computers to the locks.
  # shellcheck disable=SC2016
  local start='hostname "$1" && exec slurmd -N "$1"'
  for node in node1 node2 node3; do
    if unshare --uts true 2>/dev/null; then
      unshare --uts sh -c "$start" sh "$node"
    else
      slurmd -N "$node"
    fi 2>>"$tmp/log/start.log" || fail "slurmd did not start"
  done
  wait_for 30 "the nodes" nodes_are_idle
}

# What both sweeps, with Slurm and without, are made of.
sweep=(--sequences="$tmp/sequence" --grid="terms.arap.weight=4,8" --repeat=3
       --set="pictures_every=0; warped_every=0; checkpoint_every=4")

# Process of the sf_batch of a job.
batch_of() {
  local environment process
  for environment in /proc/[0-9]*/environ; do
    grep -qszxF "SLURM_JOB_ID=$1" "$environment" || continue
    process="$(basename "$(dirname "$environment")")"
    [[ "$(cat "/proc/$process/comm" 2>/dev/null)" == sf_batch ]] || continue
    echo "$process"
    return
  done
  return 1
}

# Name of a task by its line in the list.
task_name() {
  sed -n "$1"'s/{"task":"\([^"]*\)".*/\1/p' "$out"/slurm/*.jsonl
}

# Finds a job that has written a checkpoint: its $job, $node, process $batch,
# and the $line and name of its $task. The tasks of the lines in $spared are no use.
find_victim() {
  while read -r job node; do
    batch="$(batch_of "$job")" || continue
    line="$(tr '\0' '\n' <"/proc/$batch/cmdline" | sed -n 's/^--task=//p')"
    [[ -n "$line" && " $spared " != *" $line "* ]] || continue
    task="$(task_name "$line")"
    [[ -e "$out/tasks/$task/run/unfinished/checkpoint.bin" ]] && return
  done < <(squeue -h -t R -o "%A %N" 2>/dev/null)
  return 1
}

was_saved() { grep -q "interrupted after" "$out/slurm/"*.log 2>/dev/null; }
queue_is_empty() { local q; q="$(squeue -h 2>/dev/null)" && [[ -z "$q" ]]; }
attempts() { sed -n 's/^ *"attempts": \([0-9]*\),$/\1/p' "$1/task.json"; }

submit() {
  "$bin/sf_batch" emit-slurm "${sweep[@]}" --output="$out" --threads=1 \
    --max_wall_minutes=10 --max_memory_gb=2 --slurm_max_array=4 \
    >"$tmp/submit.sh"
  # The first task in a job of its own, too: it will run twice at once.
  { grep -v '^submit [0-9]' "$tmp/submit.sh"; echo 'submit 1 1 "$@"'; } |
    sh -s -- --job-name=again
  sh "$tmp/submit.sh"
}

requeue_one() {
  wait_for 60 "a checkpoint" find_victim
  scontrol requeue "$job"
  say "requeued $task, job $job"
  wait_for 30 "the interrupted run" was_saved
  grep -q 'interrupted after .* of 40 frames' "$out/tasks/$task/task.json" ||
    fail "sf_run did not say what it has saved"
  hit+=("$job $task")
  spared+=" $line"
}

kill_one() {
  wait_for 60 "a checkpoint" find_victim
  kill -9 "$(cat "$tmp/$node.pid")" "$(ps -o ppid= -p "$batch" | tr -d ' ')" \
    "$batch"
  say "killed the slurmd of $node, with job $job and its $task"
  hit+=("$job $task")
}

# Every task is there once, and is what it is without Slurm.
compare() {
  local folder name file entry
  "$bin/sf_batch" collect --output="$out" >"$tmp/table.txt" ||
    fail "sf_batch collect"
  (($(grep -c ',complete,' "$out/results.csv") == 6 &&
    $(wc -l <"$out/results.csv") == 7)) || fail "results.csv has no 6 runs"
  for folder in "$tmp"/local/tasks/*; do
    name="$(basename "$folder")"
    for file in trajectory.txt surfaces/000_background/mesh.ply \
                surfaces/001_person/motions.bin; do
      cmp "$folder/run/$file" "$out/tasks/$name/run/$file" || fail "$name"
    done
  done
  for entry in "${hit[@]}"; do
    name="${entry#* }"
    scontrol show job "${entry% *}" | grep -q "Restarts=1 " ||
      fail "job ${entry% *} was not started again"
    (($(attempts "$out/tasks/$name") == 2)) || fail "attempts of $name"
    tr -d ' \n' <"$out/tasks/$name/run/run.json" |
      grep -q '"resumed_at":\[[0-9]' || fail "$name began anew"
  done
  name="$(task_name 1)"
  cat "$out"/slurm/*.log >"$tmp/all.txt"
  (($(grep -c "$name done" "$tmp/all.txt") == 1 &&
    $(grep -c "$name kept" "$tmp/all.txt") == 1)) ||
    fail "the task that was started twice was not computed once"
}

say "$(slurmctld -V), $(nproc) cores"
"$bin/sf_synth" --output="$tmp/sequence" --width=160 --height=120 --frames=40 \
  --mesh_every=100 >/dev/null
configure
start_daemons
names="$(unshare --uts echo "each with a host name of its own" 2>/dev/null ||
         echo "all with one host name")"
say "3 slurmd are idle, $names"
submit
spared=1
hit=()
requeue_one
kill_one
# Meanwhile: the task of the dead computer is taken over after two minutes.
"$bin/sf_batch" run "${sweep[@]}" --output="$tmp/local" --threads=1 \
  >/dev/null 2>"$tmp/log/local.log" &
without_slurm=$!
wait_for 300 "the end of all jobs" queue_is_empty
say "all jobs have ended; node states: $(sinfo -h -o '%T: %D' | paste -sd ' ')"
"$bin/sf_batch" status --output="$out"
wait "$without_slurm" || fail "the sweep without Slurm"
say "the same sweep without Slurm has ended"
compare
"$bin/sf_batch" emit-slurm --output="$out" 2>&1 >"$tmp/submit.sh" |
  grep -q "all runs are finished" || fail "tasks are left"
say "PASSED: 6 tasks in 2 arrays, one of them also started twice at once, one \
requeued, one killed with its slurmd: 6 complete results, as without Slurm"
