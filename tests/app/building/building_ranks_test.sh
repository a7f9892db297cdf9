#!/usr/bin/env bash
# Makes one building of simulated recordings alone and on 1, 3 and 7 ranks, kills ranks, and changes one recording: the same
# bytes, and nothing is done twice.
#
# usage: building_ranks_test.sh ROOMRADAR [ROOMRADAR_MPI]
set -euo pipefail
program=$1 mpi=${2:-}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() { echo "FAILED: $*" >&2; tail -n 20 "$work/log" >&2 || true; exit 1; }
options=(--recordings "$work/list.txt" --resolution 0.03 --tile-edge 128)
alone() { "$program" building "$work/$1" "${options[@]}" --report "$work/$1.json" > "$work/log" 2>&1 || fail "$1: exit status $?"; }
ranks() { mpirun --allow-run-as-root --oversubscribe --mca btl vader,self -n "$2" "$mpi" building "$work/$1" "${options[@]}"; }
hashes() { (cd "$work/$1" && find . -type f ! -path './work/*' | sort | xargs sha256sum); }
value() { python3 -c "import json,sys; r=json.load(open('$work/$1.json')); print($2)"; }

for seed in 1 2 5; do
  echo "table-$seed: sim:table?seed=$seed&frames=48&rate=8&width=160"
done > "$work/list.txt"
echo "elsewhere: sim:shelf?frames=20&rate=8&width=160" >> "$work/list.txt"

echo "== one building of three recordings; the fourth shows another room"
alone whole
hashes whole > "$work/whole.hashes"
grep -q 'elsewhere: not in it' "$work/log" || fail "the recording of another room is not named"
[[ $(value whole 'r["ate_rmse_m"] < 0.02') == True ]] || fail "poses are $(value whole 'r["ate_rmse_m"]') m off"
[[ -s $work/whole/tileset.json ]] || fail "no tileset.json"

echo "== the same command again does nothing"
alone whole
[[ $(value whole 'sum(stage["jobs_done"] for stage in r["jobs"].values())') == 0 ]] || fail "jobs were done again"
hashes whole | cmp - "$work/whole.hashes" || fail "other files than before"

echo "== one recording is added and another left out"
cp "$work/list.txt" "$work/all.txt"
grep -v elsewhere "$work/all.txt" > "$work/list.txt"
alone whole
[[ $(value whole 'r["jobs"]["track"]["jobs_done"] + r["jobs"]["fuse"]["jobs_done"] + r["jobs"]["tile"]["jobs_done"]') == 0 ]] ||
  fail "recordings that did not change were tracked or fused again"
cp "$work/all.txt" "$work/list.txt"

echo "== bad input is said in a sentence"
for list in "" "no colon" "a: /nowhere/at/all"; do
  echo "$list" > "$work/list.txt"
  status=0
  "$program" building "$work/bad" "${options[@]}" > "$work/log" 2>&1 || status=$?
  [[ $status -eq 1 ]] && grep -q '^roomradar: ' "$work/log" || fail "'$list': exit status $status"
done
cp "$work/all.txt" "$work/list.txt"

[[ -n $mpi ]] && command -v mpirun > /dev/null || { echo "ranks skipped: no Open MPI"; exit 0; }
echo "== the same bytes on 3 ranks, one of which was killed twice"
for moment in 1 4; do
  ranks cut 3 > "$work/log" 2>&1 &
  started=$!
  while [[ $(find "$work/cut/work" -maxdepth 2 -name job.json ! -path '*.running/*' 2> /dev/null | wc -l) -lt $moment ]]; do
    sleep 0.05
  done
  pkill -9 -n -f "^$mpi building $work/cut" || fail "no rank to kill"
  wait $started && fail "the killed run says that all is well"
done
ranks cut 3 > "$work/log" 2>&1 || fail "after the kills: exit status $?"
hashes cut | cmp - "$work/whole.hashes" || fail "after the kills: other bytes"

[[ -n ${ROOMRADAR_LONG_TESTS:-} ]] || exit 0
echo "== the same bytes after a rank was killed at each of 100 random moments, and no job is done twice"
RANDOM=1
kills=0 building=0
jobs_done() { { find "$work/often-$building/work" -maxdepth 2 -name job.json ! -path '*.running/*' -printf '%p %i %T@\n' 2> /dev/null || true; } | sort; }
while [[ $kills -lt 100 ]]; do
  jobs_done > "$work/before"
  ranks often-$building 3 > "$work/log" 2>&1 &
  started=$!
  sleep "$((RANDOM % 4)).$((RANDOM % 10))"
  mapfile -t pids < <(pgrep -f "^$mpi building $work/often-$building ")
  if [[ ${#pids[@]} -gt 0 ]] && kill -9 "${pids[RANDOM % ${#pids[@]}]}" 2> /dev/null; then kills=$((kills + 1)); fi
  status=0
  wait $started || status=$?
  jobs_done | comm -23 "$work/before" - > "$work/again"
  [[ ! -s $work/again ]] || fail "done twice: $(head -n 1 "$work/again")"
  if [[ $status -eq 0 ]]; then
    hashes often-$building | cmp - "$work/whole.hashes" || fail "after $kills kills: other bytes"
    rm -rf "$work/often-$building"
    building=$((building + 1))
  fi
done
ranks often-$building 3 > "$work/log" 2>&1 || fail "after all kills: exit status $?"
hashes often-$building | cmp - "$work/whole.hashes" || fail "after all kills: other bytes"
echo "$kills kills, $((building + 1)) buildings"
