# virtual_screen.sh: what the tests of the windows have in common; sourced by them.
#
# Sets work (a temporary folder, deleted at the end), reads shots (folder of the screenshots), and expects the program's
# output in $work/log and its process in $shown.

# require_tools TOOL...: exit status 77 if one is not installed.
require_tools() {
  for tool in Xvfb xdotool import identify "$@"; do
    command -v "$tool" > /dev/null ||
      { echo "skipped: $tool is not installed (packages xvfb xdotool imagemagick bsdutils)"; exit 77; }
  done
}
work=$(mktemp -d)
trap 'kill $(jobs -p) 2> /dev/null || true; wait; rm -rf "$work"' EXIT

fail() { echo "FAILED: $*" >&2; tail -n 20 "$work/log" >&2 || true; exit 1; }
# until_true COMMAND...: repeats a command until it succeeds, for as long as a slow machine may need.
until_true() {
  for _ in $(seq 1800); do
    "$@" && return
    kill -0 "$shown" 2> /dev/null || fail "the window is gone, while waiting for: $*"
    sleep 0.1
  done
  fail "in vain waited for: $*"
}
# screen WIDTHxHEIGHT: a screen of its own.
screen() {
  rm -f "$work/display"
  Xvfb -displayfd 3 -screen 0 "$1x24" -nolisten tcp -noreset 3> "$work/display" > /dev/null 2>&1 &
  for _ in $(seq 600); do [[ -s $work/display ]] && break; sleep 0.1; done
  DISPLAY=:$(cat "$work/display")
  export DISPLAY
}
# shot NAME [COLOURS]: a screenshot, of more than so many colours.
shot() {
  import -window root "$shots/$1.png"
  [[ $(identify -format %k "$shots/$1.png") -gt ${2:-500} ]] || fail "$1.png is empty"
}
# over STATUS: waits for the program to end.
over() { local status=0; wait "$shown" || status=$?; [[ $status -eq $1 ]] || fail "exit status $status instead of $1"; }
