#!/usr/bin/env bash
# Runs `trade` as jobs and in one process, kills a job, and compares the results: every error is the same, and the killed job's
# row is marked. With ROOMRADAR_LONG_TESTS also `fallthrough`, with jobs killed at random.
#
# usage: jobs_test.sh ROOMRADAR [SCENARIOS [JOB_SIZE [KILLED]]]
set -euo pipefail
program=$1 scenarios=${2:-60} size=${3:-5} killed=${4:-2}
work=$(mktemp -d)
killer=
trap '[[ -z $killer ]] || kill "$killer" 2> /dev/null || true; rm -rf "$work"' EXIT
fail() { echo "FAILED: $*" >&2; tail -n 20 "$work/log" >&2 || true; exit 1; }

# wait_and_kill FILE WORDS...: kills the job process whose command line holds WORDS, once for each WORDS; appends them to FILE.
wait_and_kill() {
  local file=$1 pid
  for words in "${@:2}"; do
    until pid=$(pgrep -o -f -- "$words"); do sleep 0.05; done
    kill -9 "$pid" && echo "$words" >> "$file"
  done
}

# Columns of a CSV file by name, without those of times and memory.
errors_of() {
  awk -F, 'NR == 1 { for (i = 1; i <= NF; ++i) kept[i] = $i !~ /_ms|_mb|ratio|default_|rank/ }
    { line = ""; for (i = 1; i <= NF; ++i) if (kept[i]) line = line "," $i; print line }' "$1" | sort
}

room="$work/my room's {1}"
"$program" simulate "$room" --room 'table?width=160' --frames 30 > "$work/log" 2>&1 || fail "no recording"
sweep=("$program" trade "$room" --rooms none --quick --only prescan --settings 1 --repeats 2)

echo "== trade: the same errors in one process and by jobs"
"${sweep[@]}" --csv "$work/alone.csv" > "$work/log" 2>&1 || fail "one process"
"${sweep[@]}" --csv "$work/jobs.csv" --jobs "$work/jobs" --html "$work/jobs.html" --report "$work/jobs.json" > "$work/log" 2>&1 ||
  fail "jobs"
[[ $(wc -l < "$work/jobs.csv") -eq 7 ]] || fail "not 4 measurements and 2 settings"
diff <(errors_of "$work/alone.csv") <(errors_of "$work/jobs.csv") || fail "other errors than in one process"
grep -q 'Times are not comparable' "$work/jobs.html" || fail "the page compares times"
grep -q '"times_comparable": false' "$work/jobs.json" || fail "the report compares times"

echo "== trade: what is done is not done again, also for another --time"
"${sweep[@]}" --time cpu --jobs "$work/jobs" > "$work/log" 2>&1 || fail "again"
grep -q '0 jobs done, 2 were done before' "$work/log" || fail "jobs were done again"

echo "== trade: a killed job"
last=$(sed -n '$s/:.*//p' "$work/jobs/jobs.txt")
words=$(sed -n '$s/.*\(--setting [^ ]*\).*/\1/p' "$work/jobs/jobs.txt")
rm -r "$work/jobs/$last"
wait_and_kill "$work/killed" "$words $work" &
killer=$!
status=0
"${sweep[@]}" --csv "$work/killed.csv" --jobs "$work/jobs" --html "$work/killed.html" > "$work/log" 2>&1 || status=$?
wait $killer
killer=
[[ $status -eq 1 ]] || fail "exit status $status instead of 1, for the killed job"
[[ $(grep -c "job $last: was killed: Killed" "$work/killed.csv") -eq 2 ]] || fail "the two measurements are not marked in the CSV file"
grep -q "Not measured:</b> .*: job $last: was killed" "$work/killed.html" || fail "the page does not mark the killed job"
grep -q "not measured: .*: job $last: was killed" "$work/log" || fail "the killed job is not printed"
others() { errors_of "$1" | awk -F, '$4 != 1'; }  # without the setting of the killed job
diff <(others "$work/alone.csv") <(others "$work/killed.csv") || fail "other rows changed"

[[ -n ${ROOMRADAR_LONG_TESTS:-} ]] || exit 0

echo "== fallthrough: $scenarios scenarios in jobs of $size, $killed of them killed"
drops=("$program" fallthrough --scenarios "$scenarios" --random-rooms 0 --job-size "$size" --jobs "$work/drops")
parts=$(seq 0 "$size" $((scenarios - 1)) | shuf -n "$killed" | sort -n)
for first in $parts; do
  last=$((first + size > scenarios ? scenarios - 1 : first + size - 1))
  ways+=("--part $first:$last --threads 1 --maps $work")
  seq "$first" "$last"
done > "$work/left_out"
wait_and_kill "$work/killed" "${ways[@]}" &
killer=$!
status=0
"${drops[@]}" --csv "$work/crashed.csv" > "$work/crashed.log" 2>&1 || status=$?
wait $killer
killer=
cp "$work/crashed.log" "$work/log"
[[ $status -eq 1 ]] || fail "exit status $status instead of 1, for the killed jobs"
[[ $(grep -c 'was killed: Killed' "$work/log") -eq $killed ]] || fail "not every killed job is printed"
"$program" fallthrough --scenarios "$scenarios" --random-rooms 0 --maps "$work/drops/rooms/maps" --csv "$work/whole.csv" \
  > "$work/log" 2>&1 || fail "one process"
diff <(grep -v -w -f <(sed 's/^/^/' "$work/left_out") <(cut -d, -f1-13 "$work/whole.csv")) <(cut -d, -f1-13 "$work/crashed.csv") ||
  fail "other results than without crashes"
"${drops[@]}" > "$work/log" 2>&1 || fail "the killed jobs run again"
grep -q " $killed jobs done, " "$work/log" || fail "not only the killed jobs were run again"
