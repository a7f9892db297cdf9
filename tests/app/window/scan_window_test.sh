#!/usr/bin/env bash
# Operates the scan window by real keys on a virtual screen: pause, finish, discard, close. Checks that the finished map is
# the one of the same scan without a window.
#
# usage: scan_window_test.sh ROOMRADAR [FOLDER]     FOLDER keeps the screenshots; exit status 77: something is not installed
set -euo pipefail
program=$1
export SOURCE_DATE_EPOCH=1700000000  # maps saved twice have the same bytes
source "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/virtual_screen.sh"
require_tools
shots=${2:-$work}
mkdir -p "$shots"

has_focus() { xdotool windowfocus "$(xdotool search --onlyvisible --name '^roomradar scan - ' | head -n 1)" 2> /dev/null; }
tracked() { tr '\r' '\n' < "$work/log" | sed -n 's/^track \([0-9]*\).*/\1/p' | tail -n 1; }
has_tracked() { [[ $(tracked || true) -ge $1 ]]; }
says() { grep -q "$1" "$work/log"; }
# there_and_back FOLDER FRAMES: lengthens a recording at 5 frames per second by links: backwards, forwards and so on.
there_and_back() {
  awk -v frames="$2" '
    { lines[NR - 1] = $0 }
    END {
      n = NR / 3
      for (k = n; k < frames; ++k) {
        i = k % (2 * n - 2)
        if (i >= n) i = 2 * n - 2 - i
        for (j = 3 * i; j < 3 * i + 3; ++j) {
          kind = substr(lines[j], 1, 1)
          ending = lines[j]
          sub(/.*\./, "", ending)
          printf "%s %s-%.6f-%d.%s\n", lines[j], kind, 0.2 * k, 12000000 * k, ending
        }
      }
    }' "$1/INDEX.txt" > "$work/links"
  while read -r old new; do
    ln "$1/$old" "$1/$new"
    echo "$new" >> "$1/INDEX.txt"
  done < "$work/links"
}
# scan NAME SOURCE [OPTION...]: starts a scan in a window.
scan() {
  "$program" prescan "$2" --map "$work/$1" --resolution 0.03 --window "${@:3}" > "$work/log" 2>&1 &
  shown=$!
  until_true has_focus
}

# asked: the view asks whether to discard the scan; its pixels change with every frame until then.
asked() { xdotool key Delete; sleep 0.5; }

screen 1280x800

echo "== a scan that runs to its end gives the map of the same scan without a window"
short='sim:table?seed=3&frames=40&width=160&rate=10'
"$program" prescan "$short" --map "$work/plain" --resolution 0.03 > "$work/log" 2>&1 || fail "prescan without a window"
scan watched "$short"
until_true test -e "$work/watched/map.json"
for part in "$work"/plain/*; do
  [[ $part == */map.json ]] || cmp "$part" "$work/watched/${part##*/}" || fail "$part differs"
done
until_true says '^holes'
shot over
xdotool key Return
over 0

echo "== Space pauses, Space goes on, Return finishes"
long='sim:table?seed=3&frames=4000&width=160&rate=10'
scan finished "$long"
until_true has_tracked 20
shot scanning
xdotool key space
until_changed "$(pixel_sum)" 1
still  # the frame that was being read is tracked
before=$(tracked)
sleep 1
[[ $(tracked) == "$before" ]] || fail "the scan goes on while it is paused"
shot paused
xdotool key space
until_true has_tracked $((before + 5))
xdotool key Return
until_true says 'frames tracked'
[[ -e $work/finished/map.json ]] || fail "no map was saved"

echo "== P plays in the map just made, in the same window"
window=$(xdotool search --onlyvisible --name '^roomradar scan - ')
xdotool key p
plays() { [[ $(xdotool getwindowname "$window" 2> /dev/null) == "roomradar - "* ]]; }
until_true plays
until_true says '^run'
xdotool windowfocus "$window"
still
shot play
xdotool key ctrl+q
over 0

echo "== Delete asks, Escape goes on, Delete and Return discard the scan"
scan discarded "$long"
until_true has_tracked 10
asked
shot asks
xdotool key Escape
before=$(tracked)
until_true has_tracked $((before + 5))
asked
xdotool key Return
over 1
says 'was discarded' || fail "nothing is said about the end"
[[ ! -e $work/discarded && ! -e $work/discarded.unfinished ]] || fail "something is left of the discarded scan"

echo "== a window that is closed leaves a scan that can be resumed"
scan closed "$long" --checkpoint-every 0.5
until_true has_tracked 20
xdotool key ctrl+q
over 1
[[ -d $work/closed.unfinished ]] || fail "nothing to resume is left"
if command -v fakenect > /dev/null; then
  echo "== a Kinect's driver, with fakenect in the device's place"
  "$program" record 'sim:table?seed=3&frames=35&rate=5&pace=slow' "$work/kinect" --format fakenect > "$work/log" 2>&1 || fail record
  there_and_back "$work/kinect" 170
  FAKENECT_LOOP=0 fakenect "$work/kinect" "$program" prescan kinect:0 --map "$work/live" --resolution 0.03 --window \
    > "$work/log" 2>&1 &
  shown=$!
  until_true has_focus
  until_true has_tracked 1
  shot live
  xdotool key Return
  until_true says 'frames tracked'
  xdotool key Return
  over 0

  echo "== scan, play, scan more, play: all in one window"
  frames_of_map() { grep -c '^[0-9]' "$work/more/trajectory.txt" 2> /dev/null || echo 0; }
  saved_times() { grep -c 'frames tracked, ' "$work/log" || true; }
  is_saved_times() { [[ $(saved_times) -eq $1 ]]; }
  is_titled() { [[ $(xdotool getwindowname "$window" 2> /dev/null) == "$1"* ]]; }
  scans_again() { is_titled "roomradar scan - " && [[ $(grep -c '^track' "$work/log") -gt $1 ]]; }
  # fakenect goes on where the program has closed it, so the recording is long enough for all parts.
  FAKENECT_LOOP=0 fakenect "$work/kinect" "$program" prescan kinect:0 --map "$work/more" --resolution 0.03 --window \
    > "$work/log" 2>&1 &
  shown=$!
  until_true has_tracked 15
  until_true has_focus
  window=$(xdotool search --onlyvisible --name '^roomradar scan - ')
  xdotool key Return
  until_true is_saved_times 1
  still
  shot holes
  before=$(frames_of_map)
  xdotool key p
  until_true is_titled "roomradar - "
  until_true says '^running'
  shot played
  lines=$(grep -c '^track' "$work/log" || true)
  xdotool key m
  until_true scans_again "$lines"
  sleep 3
  shot more
  xdotool key Return
  until_true is_saved_times 2
  [[ $(frames_of_map) -gt $before ]] || fail "the map has not grown"
  xdotool key p
  until_true is_titled "roomradar - "
  sleep 2
  shot played_again
  xdotool key ctrl+q
  over 0
fi
echo "passed"
