#!/usr/bin/env bash
# Operates the start view by real keys on a virtual screen: choose, scan, play, scan more, compare, export, rename, delete,
# doctor, text size; in three sizes of window.
#
# usage: start_window_test.sh ROOMRADAR [FOLDER]     FOLDER keeps the screenshots; exit status 77: something is not installed
set -euo pipefail
program=$(readlink -f "$1")
source "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/virtual_screen.sh"
require_tools script
shots=${2:-$work/shots}
mkdir -p "$shots" "$work/here"
shots=$(readlink -f "$shots")
export XDG_CONFIG_HOME=$work/config
settings=$XDG_CONFIG_HOME/roomradar/start.json
source='sim:table?seed=3&frames=25&width=160&rate=10'
more='sim:table?seed=3&frames=20&width=160'
cd "$work/here"

window() { xdotool search --onlyvisible --name "$1" 2> /dev/null | head -n 1; }
has_focus() { local id; id=$(window "$1"); [[ -n $id ]] && xdotool windowfocus "$id" 2> /dev/null; }
says() { grep -qE -- "$1" "$work/log"; }
has_scans() { [[ $(grep -c '^holes' "$work/log") -ge $1 ]]; }
settled_shot() { still; shot "$1" 200; }
# keys KEY...: types keys one after the other, each once the screen shows what the one before has done.
keys() {
  local before
  for key in "$@"; do
    before=$(pixel_sum)
    xdotool key "$key"
    until_changed "$before" 1
    sleep 0.2  # what changed may be something else, and two keys must not come in one frame
    still
  done
}
start() { "$program" start "$@" > "$work/log" 2>&1 & shown=$!; until_true has_focus '^roomradar$'; still; }

# copied NAME [TEXT]: copies the map, with TEXT after its mesh; the view lists folders every two seconds.
copied() {
  cp -r maps/kitchen "$work/copy"
  printf %s "${2:-}" >> "$work/copy/mesh.ply"
  mv "$work/copy" "maps/$1"
  sleep 6  # the next list, on a busy machine, too: other changes of the screen do not tell that it is there
  still
}

screen 1280x800
echo "== S asks for a name, Enter scans in the same window, Enter comes back"
start "$more" "$source"
first=$(window '^roomradar$')
keys s
settled_shot scan-asks
xdotool type 'maps/table'
keys Return
until_true test -e maps/table/map.json
until_true says '^holes'
until_true has_focus '^roomradar scan - '
settled_shot scan-over
[[ $(window '^roomradar scan - ') == "$first" ]] || fail "the scan has another window"
keys Return
until_true has_focus '^roomradar$'
settled_shot back-from-scan
[[ $(window '^roomradar$') == "$first" ]] || fail "the start view has another window"
grep -q '"last_map": "maps/table"' "$settings" || fail "the map is not remembered"

echo "== P plays in the chosen map, Ctrl+Q comes back"
keys p
until_true has_focus '^roomradar - '
until_true says "^roomradar run '?sim:table.*path=view.*'? --map maps/table --window"
until_true says '^running'
settled_shot play
keys ctrl+q
until_true has_focus '^roomradar$'

echo "== M adds to the map; a recording that it holds already is named"
before=$(sha256sum < maps/table/map.json)
keys m
until_true says ': already contains '
until_true has_focus '^roomradar scan - '
settled_shot held-already
keys Return
until_true has_focus '^roomradar$'
[[ $(sha256sum < maps/table/map.json) == "$before" ]] || fail "the map has changed"
keys Tab Up m
has_changed() { [[ $(sha256sum < maps/table/map.json) != "$before" ]]; }
until_true has_changed
until_true has_focus '^roomradar scan - '
until_true has_scans 2
keys Return
until_true has_focus '^roomradar$'
settled_shot back-from-scan-more

echo "== R renames, E exports, C compares"
keys r
settled_shot rename-asks
xdotool type 'kitchen'
keys Return
[[ -e maps/kitchen/map.json && ! -e maps/table ]] || fail "the map is not renamed"
sleep 1  # the view reads the renamed map
keys e
settled_shot export-asks
keys p
until_true test -s maps/kitchen.ply
copied other
keys c
settled_shot compare-asks
keys Return
until_changed "$(pixel_sum)" 4
settled_shot compared
keys Return

echo "== a damaged map: a sentence in the view, and nothing is lost"
copied zzz x
keys Home
settled_shot damaged
keys p
until_true says 'roomradar: maps/zzz/mesh.ply'
until_true has_focus '^roomradar$'
settled_shot damaged-play
keys Escape
[[ -e maps/zzz/mesh.ply ]] || fail "the damaged map is gone"

echo "== Delete asks; Escape keeps the map, Return deletes it"
keys Delete
settled_shot delete-asks
keys Escape
[[ -e maps/zzz/map.json ]] || fail "the map was deleted although it was to be kept"
keys Delete Return
[[ ! -e maps/zzz ]] || fail "the map was not deleted"
[[ -z $(compgen -G 'maps/*.deleted-*') ]] || fail "something is left of the map"
[[ -e maps/kitchen/map.json && -e maps/other/map.json ]] || fail "another map was deleted"

echo "== a scan that is quit leaves the view, and can be continued from it"
keys Tab End s
xdotool type 'maps/cut'
keys Return
until_true test -e maps/cut.unfinished/work.json
until_true has_focus '^roomradar scan - '
keys ctrl+q
until_true has_focus '^roomradar$'
says 'roomradar: .*maps/cut' || fail "nothing is said about the scan that was quit"
settled_shot quit-scan
keys Escape Delete Return
[[ ! -e maps/cut.unfinished ]] || fail "the interrupted scan was not deleted"

echo "== D shows what of the set-up works; + is remembered"
keys d
until_changed "$(pixel_sum)" 3
settled_shot doctor
keys Return plus ctrl+q
over 0
grep -q '"ui_scale": 1.25' "$settings" || fail "the text size is not remembered"

echo "== damaged settings: a sentence and the defaults"
echo '{"ui_scale": "huge"}' > "$settings"
start maps/kitchen
says 'ui_scale must be a number; the default settings are used' || fail "nothing is said about the settings"
settled_shot default-settings
keys ctrl+q
over 0

for look in '640x480 2' '1280x960 1' '3840x2160 2'; do
  read -r size scale <<< "$look"
  echo "== $size, scale $scale"
  screen "$size"
  start maps/kitchen --ui-scale "$scale"
  id=$(window '^roomradar$')
  xdotool windowmove "$id" 0 0
  xdotool windowsize "$id" "${size%x*}" "${size#*x}"
  settled_shot "$size-maps"
  keys Tab
  settled_shot "$size-sources"
  keys s
  settled_shot "$size-scan"
  keys Escape ctrl+q
  over 0
done

echo "== alone: on a terminal with a display the view opens, else the first commands are printed"
view=$$
script -qec "$program" /dev/null > "$work/log" 2>&1 < /dev/null &
shown=$!
until_true has_focus '^roomradar$'
keys ctrl+q
over 0
status=0
DISPLAY='' WAYLAND_DISPLAY='' script -qec "$program" /dev/null > "$work/log" 2>&1 < /dev/null || status=$?
[[ $status -eq 2 ]] || fail "exit status $status without a display"
says 'roomradar prescan kinect:0' || fail "the first commands are missing"
status=0
"$program" < /dev/null > "$work/log" 2>&1 || status=$?
[[ $status -eq 2 ]] || fail "exit status $status in a pipe"
echo "passed"
