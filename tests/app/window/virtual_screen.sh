# virtual_screen.sh: what the tests of the windows have in common; sourced by them.
#
# Sets work (a temporary folder, deleted at the end), reads shots (folder of the screenshots), and expects the program's
# output in $work/log and its process in $shown.

# require_tools TOOL...: exit status 77 if one is not installed.
require_tools() {
  for tool in Xvfb xdotool convert "$@"; do
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
# screen WIDTHxHEIGHT: a screen of its own, whose pixels are in the file $pixels.
screen() {
  local folder
  folder=$(mktemp -d -p "$work")
  Xvfb -displayfd 3 -screen 0 "$1x24" -fbdir "$folder" -nolisten tcp -noreset 3> "$folder/display" > /dev/null 2>&1 &
  for _ in $(seq 600); do [[ -s $folder/display ]] && break; sleep 0.1; done
  DISPLAY=:$(cat "$folder/display")
  export DISPLAY
  pixels=$folder/Xvfb_screen0
}
pixel_sum() { cksum < "$pixels"; }
# until_changed SUM SECONDS: waits until the screen is another one than that of SUM, for at most SECONDS.
until_changed() {
  local end=$((${EPOCHREALTIME/[.,]/} + $2 * 1000000))
  while [[ $(pixel_sum) == "$1" && ${EPOCHREALTIME/[.,]/} -lt $end ]]; do sleep 0.02; done
}
# still: waits until the screen has not changed for 0.15 s; for at most 2 s, as some views always move.
still() {
  local before now
  before=$(pixel_sum)
  for _ in $(seq 14); do
    sleep 0.15
    now=$(pixel_sum)
    [[ $now == "$before" ]] && return
    before=$now
  done
}
# shot NAME [COLOURS]: waits until the screen shows more than COLOURS colours. Keeps it if the test was given a folder.
shot() {
  for _ in $(seq 300); do
    if [[ $(convert "xwd:$pixels" -format %k info:) -gt ${2:-500} ]]; then
      [[ $shots == "$work"* ]] || convert "xwd:$pixels" "$shots/$1.png"
      return
    fi
    sleep 0.1
  done
  fail "$1 is empty"
}
# over STATUS: waits for the program to end.
over() { local status=0; wait "$shown" || status=$?; [[ $status -eq $1 ]] || fail "exit status $status instead of $1"; }
