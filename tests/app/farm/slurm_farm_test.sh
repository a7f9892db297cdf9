#!/usr/bin/env bash
# Runs the arrays that `farm --emit slurm` prints on a Slurm of one node, and compares with the same jobs run here.
#
# usage: slurm_farm_test.sh ROOMRADAR       exit status 77: not asked for by ROOMRADAR_LONG_TESTS, or Slurm is not installed
set -euo pipefail
program=$1
[[ -n ${ROOMRADAR_LONG_TESTS:-} ]] || { echo "skipped: set ROOMRADAR_LONG_TESTS=1 to run it"; exit 77; }
for tool in munged slurmctld slurmd sbatch; do
  command -v "$tool" > /dev/null ||
    { echo "skipped: $tool is not installed (packages munge slurmctld slurmd slurm-client)"; exit 77; }
done
work=$(mktemp -d)
trap 'kill $(jobs -p) 2> /dev/null || true; wait; rm -rf "$work"' EXIT
fail() { echo "FAILED: $*" >&2; tail -n 5 "$work"/*.log >&2 || true; exit 1; }
hashes() {
  (cd "$1" && find . -type f ! -name '*.log' ! -name inputs.sha256 ! -name 'slurm-*' | sort | xargs sha256sum)
}

host=$(hostname -s)
chmod 755 "$work"
mkdir "$work/state" "$work/spool"
dd if=/dev/urandom of="$work/key" bs=1024 count=1 2> /dev/null
chmod 400 "$work/key"
munged --foreground --force --key-file="$work/key" --socket="$work/munge" --pid-file="$work/munge.pid" \
  --log-file="$work/munge.log" --seed-file="$work/seed" > /dev/null 2>&1 &
cat > "$work/slurm.conf" << END
ClusterName=one
SlurmctldHost=$host
SlurmctldPort=16817
SlurmdPort=16818
AuthType=auth/munge
AuthInfo=socket=$work/munge
CredType=cred/munge
SlurmUser=$(id -un)
SlurmdUser=$(id -un)
StateSaveLocation=$work/state
SlurmdSpoolDir=$work/spool
SlurmctldPidFile=$work/ctld.pid
SlurmdPidFile=$work/d.pid
SlurmctldLogFile=$work/ctld.log
SlurmdLogFile=$work/d.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
ReturnToService=2
MpiDefault=none
NodeName=$host CPUs=$(nproc) State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
END
export SLURM_CONF=$work/slurm.conf
for _ in $(seq 100); do [[ -S $work/munge ]] && break; sleep 0.1; done
slurmctld -D > "$work/ctld.log" 2>&1 &
for _ in $(seq 100); do sinfo -h > /dev/null 2>&1 && break; sleep 0.2; done
slurmd -D -N "$host" > "$work/d.log" 2>&1 &
for _ in $(seq 100); do [[ $(sinfo -h -o %t) == idle ]] && break; sleep 0.2; done
[[ $(sinfo -h -o %t) == idle ]] || fail "Slurm's node is not ready"

for seed in $(seq 8); do
  echo "room$seed (cost $((seed % 5 + 1))): record 'sim:table?seed=$seed&frames=2&width=80' {}/recording"
done > "$work/jobs.txt"
cat >> "$work/jobs.txt" << 'END'
copy: record {room3}/recording {}/copy --format 7scenes
broken: record sim:nowhere {}/recording
END
"$program" farm "$work/jobs.txt" --out "$work/here" > /dev/null 2>&1 || true
"$program" farm "$work/jobs.txt" --out "$work/there" --emit slurm > "$work/submit.sh"
bash "$work/submit.sh"
for _ in $(seq 600); do [[ -z $(squeue -h) ]] && break; sleep 0.2; done
[[ -z $(squeue -h) ]] || fail "the arrays do not end"
hashes "$work/here" > "$work/here.hashes"
[[ $(grep -c job.json "$work/here.hashes") -eq 9 ]] || fail "not all jobs are done"
hashes "$work/there" | cmp - "$work/here.hashes" || fail "other results than here"
[[ -e $work/there/broken.failed ]] || fail "the failing job was not run"
echo "the arrays gave the same results"
