#!/usr/bin/env bash
# Operates the window by real key and mouse events on a virtual screen. Checks the recorded events, screenshots and the
# report, then replays the session without a window and expects the same results. Repeats this in short with a Kinect's
# driver, with fakenect instead of the device.
#
# usage: window_test.sh ROOMRADAR [FOLDER]     FOLDER keeps the screenshots; exit status 77: something is not installed
set -euo pipefail
program=$1
source "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/virtual_screen.sh"
require_tools
shots=${2:-$work}
mkdir -p "$shots"

fail() { echo "FAILED: $*" >&2; tail -n 20 "$work/log" "$work/session/events.txt" >&2 || true; exit 1; }  # with the events
has_event() { grep -qE "$1" "$work/session/events.txt" 2> /dev/null; }
has_frames() { [[ $(grep -cv '^#' "$work/session/results.txt" 2> /dev/null) -ge $1 ]]; }
# Waits a few frames until the window shows the latest change.
settle() { until_true has_frames $(($(grep -cv '^#' "$work/session/results.txt") + 4)); }

"$program" prescan 'sim:table?frames=40&width=160' --map "$work/map" --resolution 0.03 > "$work/log" 2>&1 || fail prescan

screen 1280x800

"$program" run 'sim:table?frames=30&width=320&path=view&seed=2' --poses recorded --map "$work/map" --window --at-end loop \
  --record-session "$work/session" --report "$work/report.json" > "$work/log" 2>&1 &
shown=$!
# A window that exists but is not shown yet cannot have the focus.
has_focus() { xdotool windowfocus "$(xdotool search --onlyvisible --name '^roomradar - ' | head -n 1)" 2> /dev/null; }
until_true has_focus
until_true has_frames 3

echo "== a click drops the object where it points"
xdotool mousemove 590 390  # on the table, beside the object
xdotool click 1
until_true has_event '^frame [0-9]+ drop object near '
shot dropped

echo "== keys change policies, hold the camera, add and remove"
xdotool key u
until_true has_event ' unknown free$'
settle
xdotool key u
until_true has_event ' unknown solid$'
settle
xdotool key s
until_true has_event ' surfaces holes$'
for policy in skirt border map; do
  settle
  xdotool key s
  until_true has_event " surfaces $policy\$"
done
xdotool key x
until_true has_event ' radar sampled 64$'
xdotool key f
until_true has_event ' camera hold$'
xdotool key a
until_true has_event ' add teapot teapot$'
until_true has_event ' drop teapot view '
xdotool key Delete
until_true has_event ' remove teapot$'
settle

echo "== a key that is held down acts once"
before=$(grep -c ' unknown ' "$work/session/events.txt")
xdotool keydown u
sleep 1.5
xdotool keyup u
settle
[[ $(grep -c ' unknown ' "$work/session/events.txt") == $((before + 1)) ]] || fail "a key that was held down acted again"
xdotool key u
settle

echo "== drag, throw, turn"
xdotool key Tab
xdotool mousemove 494 330
settle  # keys act at the mouse position of the last picture
xdotool key p
until_true has_event ' place object '
settle
has_turned() {
  # The mouse button grabs what is under the mouse; repeated until the object is there.
  xdotool mousemove 494 322 mousedown 3 mousemove_relative 40 0 mouseup 3
  has_event ' turn object '
}
until_true has_turned
has_carried() {
  xdotool mousemove 494 322 mousedown 1
  sleep 0.3
  xdotool mousemove_relative -- 30 -30
  sleep 0.3
  xdotool mousemove_relative -- 30 -30
  sleep 0.3
  xdotool mouseup 1
  has_event ' carry object '
}
until_true has_carried
until_true has_event ' release object velocity '
releases() { grep -c ' release object ' "$work/session/events.txt"; }
has_let_go_outside() {  # over the side panel
  xdotool mousemove 494 330
  sleep 0.3
  xdotool key p
  sleep 0.3
  xdotool mousemove 494 322 mousedown 1
  sleep 0.3
  xdotool mousemove_relative -- 30 -30
  sleep 0.3
  xdotool mousemove 1200 650
  sleep 0.5
  local before
  before=$(releases)
  xdotool mouseup 1
  sleep 0.5
  [[ $(releases) -gt $before ]]
}
until_true has_let_go_outside
has_thrown() {  # keys act at the mouse position of the last picture
  xdotool mousemove 494 330
  sleep 0.3
  xdotool key t
  sleep 0.3
  has_event ' throw object '
}
until_true has_thrown
settle
xdotool key f
until_true has_event ' camera go$'

echo "== pause and step"
xdotool key space
sleep 1
before=$(wc -l < "$work/session/results.txt")
sleep 1
[[ $(wc -l < "$work/session/results.txt") == "$before" ]] || fail "frames go on while it is paused"
xdotool key period
stepped() { [[ $(wc -l < "$work/session/results.txt") == $((before + 1)) ]]; }
until_true stepped
xdotool key space

echo "== views"
xdotool key r v
until_true has_event ' drop object view '
settle
shot models
xdotool key v
settle
shot both
xdotool key v h
settle
shot help

echo "== a click closes the help, and does nothing else"
before=$(wc -l < "$work/session/events.txt")
xdotool mousemove 494 330 click 1
sleep 1
settle
[[ $(wc -l < "$work/session/events.txt") == "$before" ]] || fail "a click went through the help"
has_dropped() {  # keys act at the mouse position again
  xdotool key d
  sleep 0.3
  tail -n "+$((before + 1))" "$work/session/events.txt" | grep -q ' drop object near '
}
until_true has_dropped

echo "== quit, and play it again without a window"
xdotool key Escape
xdotool key ctrl+q
status=0
wait "$shown" || status=$?
[[ $status == 0 ]] || fail "exit status $status"
has_event '^frame [0-9]+ quit$' || fail "the session does not say where it ended"
grep -q '"object"' "$work/report.json" || fail "no object in the report"

# Replays the recorded session without a window: every frame must give the same result.
play_again() {
  DISPLAY='' "$program" run "$work/session" --video "$work/again.avi" > "$work/log" 2>&1 || fail replay
  grep -E '^replay: ' "$work/log"
  read -r same recorded < <(sed -nE 's/^replay: ([0-9]+) of ([0-9]+) frames.*/\1 \2/p' "$work/log")
  [[ $same == "$recorded" && $recorded -gt $1 ]] || fail "the replay is not the same"
}
play_again 20

echo "== Ctrl-C in the terminal ends the window, too, and the summary comes"
"$program" run 'sim:table?frames=30&width=320&path=view&seed=2' --poses recorded --map "$work/map" --objects none --window --at-end loop \
  > "$work/interrupted" 2>&1 &
shown=$!
until_true grep -q '^running .* located' "$work/interrupted"
kill -INT "$shown"
ended() { ! kill -0 "$shown" 2> /dev/null; }
for _ in $(seq 300); do ended && break; sleep 0.1; done
ended || fail "the window is still there"
status=0
wait "$shown" || status=$?
[[ $status == 0 ]] || fail "exit status $status after Ctrl-C"
grep -q '^camera located in ' "$work/interrupted" || fail "no summary after Ctrl-C"

if command -v fakenect > /dev/null; then
  echo "== a Kinect's driver, with fakenect in the device's place, and a French keyboard, whose Q is where A is"
  setxkbmap fr || echo "no French keyboard: setxkbmap is not installed (package x11-xkb-utils)"
  "$program" record 'sim:table?frames=15&path=view&seed=2' "$work/kinect" --format fakenect > "$work/log" 2>&1 || fail record
  rm -r "$work/map" "$work/session"
  "$program" prescan 'sim:table?frames=20&width=320&path=view&seed=2' --map "$work/map" --resolution 0.03 > "$work/log" 2>&1 ||
    fail prescan
  FAKENECT_LOOP=0 fakenect "$work/kinect" "$program" run kinect:0 --map "$work/map" --objects none --window \
    --record-session "$work/session" > "$work/log" 2>&1 &
  shown=$!
  until_true has_focus
  until_true has_frames 3
  xdotool mousemove 590 390 click 1  # on the table, beside the object
  until_true has_event '^frame [0-9]+ drop object near '
  settle
  shot kinect
  xdotool key ctrl+q
  status=0
  wait "$shown" || status=$?
  [[ $status == 0 ]] || fail "exit status $status with a Kinect"
  play_again 5
fi
echo "passed"
