#!/bin/sh
# SPDX-License-Identifier: MIT
# The program as a stranger uses it: names of pictures, messages, exit statuses, signals.
#   cli_test.sh PATH/TO/glint
# Ends with "N passed, N failed".
set -u

. "$(dirname "$0")/cli.sh"

# pixels FILE "W H": the size that the PNG's header tells.
pixels() {
    size=$("$python" -c 'import struct, sys
data = open(sys.argv[1], "rb").read(24)
is_png = data[:8] == b"\x89PNG\r\n\x1a\n"
print(*(struct.unpack(">2I", data[16:24]) if is_png else ["no", "PNG"]))' "$1")
    if [ "$size" = "$2" ]; then pass; else fail "$1 is $size, not $2"; fi
}

# scene NAME "IMAGE" [MORE]: a sphere.
scene() {
    cat >"$1" <<XML
<scene>
  <camera>
    <viewPoint>5 4 3</viewPoint>
    <viewDir>-5 -4 -3</viewDir>
    <projDistance>5</projDistance>
    <viewWidth>2.5</viewWidth>
    <viewHeight>2.5</viewHeight>
  </camera>
  <image>$2</image>
  <light><position>3 4 5</position><intensity>1 1 1</intensity></light>
  <surface type="Sphere"><center>0 0 0</center><radius>1</radius></surface>
  ${3:-}
</scene>
XML
}

# ---- one scene
scene a.xml "40 30"
run 0 a.xml
printed a.xml.png
silent "one scene in a pipe"
pixels a.xml.png "40 30"
cp a.xml.png first.png
run 0 render a.xml
printed a.xml.png
check "the same picture twice" cmp -s a.xml.png first.png
run 0 -q a.xml
printed ""
run 0 -o b.png a.xml
printed b.png
check "the same picture under another name" cmp -s b.png first.png
run 0 --output=c.pfm -t1 a.xml
check "a PFM" test "$(head -c 2 c.pfm)" = PF
if [ -e "${glint%/*}/modules/glint-exr.so" ]; then
    run 0 --output=c.exr -t1 a.xml
    check "an EXR" test "$(head -c 4 c.exr | od -An -tx1)" = " 76 2f 31 01"
fi
run 0 -qt 1 -ob.png -- a.xml
run 0 --threads 3 -o t.png a.xml
check "threads do not change the picture" cmp -s t.png first.png
mkdir "with space"
cp a.xml "with space/-a.xml"
run 0 "with space/-a.xml"
printed "with space/-a.xml.png"
(cd "with space" && "$glint" -- -a.xml) >out 2>err
printed -a.xml.png

# ---- standard input
"$glint" - <a.xml >out 2>err
check "standard input" test $? -eq 0
printed stdin.png
pixels stdin.png "40 30"
"$glint" -o s.png - <a.xml >out 2>err
printed s.png
echo '<scene>' | "$glint" -o none.png - >out 2>err
check "bad standard input" test $? -eq 1
says "stdin:"
check "bad standard input leaves no picture" test ! -e none.png

# ---- folders
mkdir folder empty pictures
scene folder/b.xml "8 8"
scene folder/B.xml "8 8"
scene folder/a.xml "8 8"
scene folder/.hidden.xml "8 8"
mkdir folder/sub.xml
echo no scene >folder/notes.txt
run 0 folder
printed "folder/B.xml.png
folder/a.xml.png
folder/b.xml.png"
run 0 -o pictures folder/
printed "pictures/B.xml.png
pictures/a.xml.png
pictures/b.xml.png"
run 0 -o pictures a.xml
printed pictures/a.xml.png
run 1 empty
says "empty"
run 1 empty a.xml
printed a.xml.png
run 2 -o new.png a.xml folder
says "folder"
check "nothing is drawn after wrong use" test ! -e new.png
run 2 -o pictures a.xml folder
says "would both be drawn"

# ---- wrong scenes
scene bad.xml "8 8" "<surfase type='Sphere'/>
  <surface type='Sphere'><radius>x</radius></surface>"
rm -f a.xml.png
run 1 bad.xml a.xml
printed a.xml.png
says "bad.xml:12:"
says "bad.xml: 2 errors"
check "a bad scene leaves no picture" test ! -e bad.xml.png
echo old >bad.xml.png
run 1 bad.xml
check "a bad scene leaves an old picture alone" test "$(cat bad.xml.png)" = old
run 1 missing.xml a.xml
says "missing.xml: "
printed a.xml.png
: >nothing.xml
run 1 nothing.xml

# ---- options
run 0 --size 20x10 a.xml
pixels a.xml.png "20 10"
run 0 --crop 5,6,7,8 a.xml
pixels a.xml.png "7 8"
run 0 --size=20x10 --crop=0,0,20,10 a.xml
pixels a.xml.png "20 10"
run 2 --crop 35,0,6,8 a.xml
says "reaches outside"
for value in 0x5 5 5x 5x5x5 -5x5 99999x99999 99999999999999999999x1; do
    run 2 --size "$value" a.xml
    says "640x480"
done
for value in 1,2,3 1,2,3,0 -1,2,3,4 1,2,3,4,5; do run 2 --crop "$value" a.xml; done

run 0 --samples 4 a.xml
run 2 --samples 0 a.xml
says "from 1 to 65536"

# Layers are files beside the picture.
run 0 --layers depth,lights -o layers.png a.xml
for file in layers.png layers.depth.pfm layers.light.none.png; do
    check "--layers leaves $file" test -s "$file"
done
check "--layers leaves nothing else" test ! -e layers.normal.pfm
run 2 --layers dept a.xml
says "did you mean 'depth'?"
run 2 --layers depth, a.xml
for value in 0 x 4x 1025 ''; do
    run 2 "--threads=$value" a.xml
    says "from 1 to 1024"
done
run 0 --dialect 2013 a.xml
run 2 --dialect materail a.xml
says "did you mean 'material'"
run 2 --isa nonsense a.xml
says portable
run 2 --treads 4 a.xml
says "glint: unknown option '--treads'; did you mean '--threads'?"
says "try 'glint --help'"
run 2 -x a.xml
says "unknown option '-x'"
run 2 -o
says "needs a value"
run 2 --quiet=yes a.xml
run 2
says "no scene"
run 2 - -
run 2 -o a.gif a.xml
says ".png, .pfm or .exr"
run 2 -o missing/ a.xml
for isa in $("$glint" --list-isa); do
    run 0 --isa "$isa" -o isa.png a.xml
    check "isa $isa draws the same picture" cmp -s isa.png first.png
done
run 0 --list-isa
check "the last instruction set is portable" test "$(tail -n 1 out)" = portable

# ---- help
run 0 --version
check "version" grep -Eq '^glint [0-9]+\.[0-9]+\.[0-9]+$' out
run 0 --help
silent "help"
cp out overview
verbs=$(sed -n 's/^  \([a-z]*\) .*/\1/p' overview | grep -v '^glint$')
for verb in '' $verbs; do
    # shellcheck disable=SC2086 # none or one
    run 0 $verb --help
    lines=$(wc -l <out)
    check "help $verb fits a screen" test "$lines" -ge 8 -a "$lines" -le 40
    check "help $verb has 80 columns" test -z "$(awk 'length > 80' out)"
    # shellcheck disable=SC2086
    run 0 $verb --help=man
    check "man $verb has its parts" test "$(grep -c '^\.SH' out)" -ge 6
done
check "render is a verb" grep -q '^  render ' overview
for form in man markdown; do
    run 0 --help=$form
    check "$form tells of --crop" grep -q crop out
done
run 2 rendr a.xml
says "did you mean 'glint render'?"
run 2 --help=html

# ---- numbers
run 0 --stats=json a.xml folder
check "a JSON object a picture" test "$(wc -l <out)" -eq 4
silent "JSON"
check "JSON is well formed" sh -c '
    head -n 1 out | '"$python"' -m json.tool >/dev/null && '"$python"' -c "
import json
for line in open(\"out\"):
    row = json.loads(line)
    assert row[\"picture\"] == row[\"scene\"] + \".png\", row
    assert set(row[\"seconds\"]) == {\"read\", \"build\", \"trace\", \"write\", \"total\"}, row
    assert row[\"rays\"][\"camera\"] >= row[\"size\"][0] * row[\"size\"][1], row
    assert row[\"threads\"] >= 1 and row[\"tree\"][\"primitives\"] >= 1, row
    assert row[\"memory\"][\"resident_peak\"] > 0, row
"'
run 0 --stats a.xml
printed a.xml.png
for word in read build trace write total camera shadow; do says "$word"; done
run 2 --stats=xml a.xml
says "text or json"

# ---- the machine
if [ -e /dev/full ]; then
    "$glint" a.xml >/dev/full 2>err
    check "a full standard output" test $? -eq 3
    ln -s /dev/full full.png
    run 3 -o full.png a.xml
    says "full.png"
fi
run 3 -o missing/a.png a.xml
says "missing/a.png"
mkdir taken.png
run 0 -o taken.png a.xml
printed taken.png/a.xml.png
scene large.xml "300 300"
echo old >large.xml.png
(ulimit -f 1 && "$glint" large.xml 2>&1) | cat >err
check "a failing write is reported" grep -q "large.xml.png" err
check "a failing write leaves the old picture" test "$(cat large.xml.png)" = old
"$python" - "$glint" <<'PY' >out 2>err
import subprocess, sys
reader = subprocess.Popen(["true"], stdin=subprocess.PIPE)
reader.wait()
status = subprocess.run([sys.argv[1], "a.xml", "folder"], stdout=reader.stdin).returncode
sys.exit(status)
PY
check "a reader that went away" test $? -eq 0

# ---- signals: a scene that takes minutes, then a standard input and a pipe with a name that stay
# silent. The shell starts background jobs deaf to SIGINT, hence Python.
scene slow.xml "2000 2000" "<samples>65536</samples>"
mkfifo silent.xml
exec 9<>silent.xml
cat >interrupt.py <<'PY'
import os, signal, subprocess, sys, time
number, glint = getattr(signal, sys.argv[1]), sys.argv[2:]
def awake():
    for name in (signal.SIGINT, signal.SIGTERM): signal.signal(name, signal.SIG_DFL)
process = subprocess.Popen(glint, preexec_fn=awake, stdin=subprocess.PIPE)
time.sleep(1)
began = time.time()
process.send_signal(number)
status = process.wait(timeout=60)
if time.time() - began > 5: sys.exit("took %.1f s to stop" % (time.time() - began))
sys.exit(0 if status == -number else "ended with %d" % status)
PY
for name in SIGINT SIGTERM; do
    for input in slow.xml - silent.xml; do
        rm -f slow.xml.png stdin.png silent.xml.png
        : >after
        ls -A >before
        "$python" interrupt.py $name "$glint" "$input" >out 2>err
        check "$name on '$input'" test $? -eq 0
        silent "$name on '$input'"
        ls -A >after
        check "$name on '$input' leaves nothing" cmp -s before after
    done
done
exec 9>&-
rm silent.xml
# What the shell sees: 128 + 2.
"$python" -c 'import os, signal, sys
signal.signal(signal.SIGINT, signal.SIG_DFL)
os.execvp("timeout", ["timeout", "--preserve-status", "-s", "INT", "1"] + sys.argv[1:])' \
    "$glint" slow.xml >out 2>err
check "the shell sees 130" test $? -eq 130

# ---- a large file that another program cuts short while it is read: an error like others, whenever
# it happens.
cat >shorten.py <<'PY'
import subprocess, sys, time
glint, path = sys.argv[1], "cut.xml"
ball = "<surface type=\"Sphere\"><center>1 2 3</center><radius>0.5</radius></surface>\n"
for delay in (0.001, 0.004, 0.008, 0.016, 0.03):
    with open(path, "w") as file:
        file.write("<scene><camera/><image>8 8</image>\n" + 200000 * ball + "</scene>\n")
    process = subprocess.Popen([glint, "-q", "-o", "cut.png", path], stderr=subprocess.PIPE)
    time.sleep(delay)
    with open(path, "r+") as file: file.truncate(3000000)
    said = process.communicate()[1].decode()
    if process.returncode not in (0, 1): sys.exit("ended with %d" % process.returncode)
    if process.returncode == 1 and "error" not in said: sys.exit("says " + said)
PY
rm -f cut.png
ls -A >before
"$python" shorten.py "$glint" >out 2>err
check "a file that is cut short" test $? -eq 0
rm -f cut.xml cut.png
ls -A >after
check "a file that is cut short leaves nothing" cmp -s before after

# ---- a terminal: progress that leaves nothing behind, and colours
cat >terminal.py <<'PY'
import os, pty, select, signal, sys, time
pid, fd = pty.fork()
if pid == 0:
    os.environ["TERM"] = "xterm"
    os.execv(sys.argv[2], sys.argv[2:])
seen, began, sent = b"", time.time(), False
while time.time() - began < 60:
    if select.select([fd], [], [], 0.1)[0]:
        try: data = os.read(fd, 4096)
        except OSError: break
        if not data: break
        seen += data
    if sys.argv[1] == "interrupt" and not sent and time.time() - began > 1.5:
        os.write(fd, b"\x03")
        sent = True
os.write(1, seen)
status = os.waitpid(pid, 0)[1]
sys.exit(128 + os.WTERMSIG(status) if os.WIFSIGNALED(status) else os.WEXITSTATUS(status))
PY
if "$python" -c 'import os; os.openpty()' 2>/dev/null; then
    "$python" terminal.py interrupt "$glint" slow.xml >out 2>err
    check "Ctrl-C in a terminal" test $? -eq 130
    check "progress is shown" grep -q "trace .*%" out
    check "progress is erased" "$python" -c '
seen = open("out", "rb").read().split(b"\r\x1b[K")
assert seen[-1].strip() in (b"", b"^C"), seen[-1]'
    check "Ctrl-C leaves no picture" test ! -e slow.xml.png
    env -u NO_COLOR "$python" terminal.py watch "$glint" bad.xml >out 2>err
    check "a bad scene in a terminal" test $? -eq 1
    check "colours" grep -q "$(printf '\033')" out
    NO_COLOR=1 "$python" terminal.py watch "$glint" bad.xml >out 2>err
    check "NO_COLOR" test -z "$(grep "$(printf '\033\[1')" out)"
else
    skipped=1
    echo "skip cli: this machine lends no terminals"
fi

finish
