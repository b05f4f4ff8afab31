#!/bin/sh
# SPDX-License-Identifier: MIT
# `glint watch` as a stranger uses it: in a terminal that a script plays, in a window of a display
# that nobody sees, and where it is refused.
#   cli_watch_test.sh PATH/TO/glint
# Ends with "N passed, N failed[, N skipped]".
set -u
. "$(dirname "$0")/cli.sh"
unset DISPLAY WAYLAND_DISPLAY
# check_leaks 0|1: for a program built with the address sanitizer. What D-Bus and the display's
# drivers, which SDL loads for a window, keep to themselves is not the program's.
sanitizer=${ASAN_OPTIONS:-}
check_leaks() { export ASAN_OPTIONS="${sanitizer:+$sanitizer:}detect_leaks=$1"; }

cat >a.xml <<'XML'
<scene dialect="glint">
  <image>300 200</image>
  <camera type="PerspectiveCamera">
    <viewPoint>0 0 4</viewPoint>
    <viewHeight>0.6667</viewHeight>
  </camera>
  <light><position>4 5 6</position></light>
  <surface name="ball" type="Sphere"/>
</scene>
XML

# ---- refused
run 2 watch a.xml
says "there is no display (neither DISPLAY nor WAYLAND_DISPLAY is set), and standard input and"
run 2 watch
says "which scene? glint watch SCENE"
run 2 watch a.xml a.xml
says "glint watch takes one scene"
run 2 watch -
says "standard input cannot be watched"
run 1 watch nowhere.xml
says "nowhere.xml: No such file or directory"
run 2 watch --terminal=sixl a.xml
says "did you mean 'sixel'?"
run 2 watch --terminal a.xml
says "--terminal needs a terminal"
check_leaks 0
DISPLAY=:nowhere run 2 watch a.xml
says "no window can be opened"
DISPLAY=:nowhere run 3 watch --window a.xml
says "\`glint watch --terminal\` needs no window"
check_leaks 1

# ---- once, into a file
run 0 watch --once --terminal=blocks --size 30x20 a.xml
check "ten rows of thirty cells" test "$(grep -c '▀' out)" -eq 10
sed 's/Sphere/Sfere/' a.xml >wrong.xml
run 1 watch --once --terminal=blocks wrong.xml
says 'unknown surface type "Sfere": did you mean "Sphere"?'
check "no picture of a wrong scene" test ! -s out

# ---- the program does not know the window's library
if command -v ldd >/dev/null 2>&1; then
    check "no SDL in the program" sh -c "! ldd '$glint' | grep -qi sdl"
fi

# ---- the terminal
mkdir terminal
(cd terminal && "$python" "$root/tests/watch_terminal.py" "$glint") >terminal.log 2>&1 </dev/null
status=$?
grep -v ' passed, ' terminal.log
tally=$(grep -E '^[0-9]+ passed, [0-9]+ failed$' terminal.log)
if [ -n "$tally" ]; then
    passed=$((passed + ${tally%% passed*}))
    tally=${tally##*, }
    failed=$((failed + ${tally%% failed*}))
else
    fail "the terminal test ended with status $status"
fi

# ---- the window
missing=
for name in Xvfb xdotool import convert; do
    command -v $name >/dev/null 2>&1 || missing="$missing $name"
done
[ -e "$(dirname "$glint")/modules/glint-window.so" ] || missing="$missing glint-window.so"
if [ -n "$missing" ]; then
    echo "skip the window: there is no$missing"
    skipped=$((skipped + 1))
    finish
fi

# The display's number is the first that is free; Xvfb writes it when it is ready.
mkfifo display
Xvfb -displayfd 3 -screen 0 1000x700x24 3>display >xvfb.log 2>&1 &
xvfb=$!
watcher=
trap 'kill $xvfb $watcher 2>/dev/null; rm -rf "$dir"' EXIT
read -r number <display
DISPLAY=:$number
export DISPLAY
check_leaks 0

# waits_for COMMAND...: until it succeeds; ten seconds are more than it takes.
waits_for() {
    tries=0
    until "$@"; do
        tries=$((tries + 1))
        [ $tries -lt 100 ] || return 1
        sleep 0.1
    done
}
window_name() { xdotool getwindowname "$window" 2>/dev/null; }
named() { window_name | grep -q -e "$1"; }
found() {
    window=$(xdotool search --onlyvisible --name 'a\.xml' 2>/dev/null | head -n 1)
    [ -n "$window" ]
}
# shows PPM: whether the window shows just these pixels.
shows() { import -window "$window" -depth 8 ppm:shown.ppm && cmp -s shown.ppm "$1"; }
said() { grep -q -e "$1" said; }
expect_picture() { # expect_picture WHAT
    "$glint" render -q -o expected.png a.xml
    convert expected.png -depth 8 ppm:expected.ppm
    check "$1" waits_for shows expected.ppm
}

"$glint" watch a.xml >said 2>&1 </dev/null &
watcher=$!
if ! waits_for found; then
    fail "no window appears: $(cat said)"
    finish
fi
check "the title tells name, size, samples" waits_for named '^a.xml  300 x 200  1 sample  .* ms$'
expect_picture "the window shows the picture"
eval "$(xdotool getwindowgeometry --shell "$window")"

xdotool mousemove $((X + 150)) $((Y + 100)) click 1
check "a click tells about the pixel" waits_for said '^pixel 150,100$'
check "... the surface and its place" waits_for said 'surface   1 "ball", a.xml:8:3'
check "... and why it has its colour" waits_for said 'light 1, point (line 7): lights it'

xdotool mousedown 1 mousemove $((X + 180)) $((Y + 110)) mousemove $((X + 210)) $((Y + 120)) \
    mouseup 1
xdotool windowfocus "$window"
xdotool key s
check "s writes the camera" waits_for named 'camera written to a.xml'
check "... that the mouse has turned" sh -c '! grep -q "<viewPoint>0 0 4<" a.xml'
check "... and the rest stays" grep -q '^  <surface name="ball" type="Sphere"/>$' a.xml
expect_picture "the turned picture is the one of the file"

xdotool click 4
xdotool key s
check "the wheel moves the camera" waits_for named 'camera written'
expect_picture "and what is shown is what is written"

sed 's/Sphere/Sfere/' a.xml >b.xml && cp a.xml good.xml && mv b.xml a.xml
check "the title tells of errors" waits_for named 'errors'
check "the errors stand over the picture" sh -c \
    'import -window "$0" -depth 8 ppm:shown.ppm && ! cmp -s shown.ppm expected.ppm' "$window"
mv good.xml a.xml
expect_picture "and go away with them"

xdotool key v
check "v shows normals" waits_for named '  normal'
xdotool key 1 r
check "r and 1 lead back" waits_for shows expected.ppm

xdotool windowsize "$window" 600 400
convert expected.png -filter point -resize 200% -depth 8 ppm:double.ppm
check "a larger window shows larger pixels" waits_for shows double.ppm

"$glint" watch --window --once a.xml >out 2>err </dev/null
check "--once ends by itself" test $? -eq 0
xdotool windowfocus "$window"
xdotool key q
waits_for sh -c "! kill -0 $watcher 2>/dev/null" || kill -9 $watcher
wait $watcher
check "q quits: $?" test $? -eq 0
watcher=

finish
