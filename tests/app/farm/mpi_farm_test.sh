#!/usr/bin/env bash
# Runs the same jobs on 1, 2, 3 and 7 ranks, with a failing one among them, and kills ranks: the results are the same to the
# byte, and nothing is done twice but what was cut.
#
# usage: mpi_farm_test.sh ROOMRADAR_MPI       exit status 77: Open MPI is not installed
set -euo pipefail
program=$1
command -v mpirun > /dev/null || { echo "skipped: mpirun is not installed (package openmpi-bin)"; exit 77; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() { echo "FAILED: $*" >&2; tail -n 20 "$work/log" >&2 || true; exit 1; }
ranks() { mpirun --allow-run-as-root --oversubscribe --mca btl vader,self -n "$1" "$program" farm "$work/jobs.txt" "${@:2}"; }
hashes() { (cd "$1" && find . -type f ! -name '*.log' ! -name inputs.sha256 | sort | xargs sha256sum); }

for seed in $(seq 8); do
  echo "room$seed (cost $((seed % 5 + 1))): record 'sim:table?seed=$seed&frames=2&width=80' {}/recording"
done > "$work/jobs.txt"
cat >> "$work/jobs.txt" << 'END'
broken: record sim:nowhere {}/recording
after: record {broken}/recording {}/copy
copy: record {room3}/recording {}/copy --format 7scenes
END

echo "== the same results on 1, 2, 3 and 7 ranks"
for k in 1 2 3 7; do
  status=0
  ranks $k --out "$work/k$k" --report "$work/k$k.json" > "$work/log" 2>&1 || status=$?
  [[ $status -eq 1 ]] || fail "$k ranks: exit status $status instead of 1, for the failed job"
  grep -q '9 jobs done, 0 were done before, 1 failed, 1 skipped' "$work/log" || fail "$k ranks: wrong counts"
  hashes "$work/k$k" > "$work/k$k.hashes"
  cmp "$work/k1.hashes" "$work/k$k.hashes" || fail "$k ranks: other results than one rank"
done

echo "== what is there is not done again"
ranks 2 --out "$work/k7" > "$work/log" 2>&1 || true
grep -q '0 jobs done, 9 were done before, 1 failed' "$work/log" || fail "jobs were done again"

echo "== killed ranks"
sed -i 's/frames=2/frames=25/' "$work/jobs.txt"
ranks 2 --out "$work/whole" > "$work/log" 2>&1 || true
hashes "$work/whole" > "$work/whole.hashes"
finished() { find "$work/cut" -maxdepth 2 -name job.json ! -path '*.running/*' | wc -l; }
for jobs in 0 2 5; do
  rm -rf "$work/cut"
  mkdir "$work/cut"
  ranks 3 --out "$work/cut" > "$work/log" 2>&1 &
  started=$!
  while [[ $(finished) -lt $jobs || -z $(find "$work/cut" -name '*.running') ]]; do sleep 0.02; done
  pkill -9 -n -f "^$program farm $work/jobs.txt" || fail "no rank to kill after $jobs jobs"
  wait $started || true
  before=$(finished)
  ranks 3 --out "$work/cut" > "$work/log" 2>&1 || true
  grep -q ", $before were done before, 1 failed" "$work/log" || fail "killed after $jobs jobs: some were done twice"
  hashes "$work/cut" | cmp - "$work/whole.hashes" || fail "killed after $jobs jobs: other results"
done

echo "== wrong usage and faults are said once"
for wrong in "--out $work/x --processes 2" "--out $work/x --emit make" ""; do
  status=0
  ranks 2 $wrong > "$work/log" 2>&1 || status=$?
  [[ $status -eq 2 ]] || fail "'$wrong': exit status $status instead of 2"
done
echo "a: nothing {}" > "$work/jobs.txt"
status=0
ranks 3 --out "$work/x" > "$work/log" 2>&1 || status=$?
[[ $status -eq 1 && $(grep -c "is not a command" "$work/log") -eq 1 ]] || fail "a wrong manifest: exit status $status"
