#!/bin/sh
# SPDX-License-Identifier: MIT
# `glint why`: the text names what blocks a light, JSON reads back and adds up to the picture, OBJ
# is well-formed, and the page works in a browser, where there is one.
#   cli_why_test.sh PATH/TO/glint
# Ends with "N passed, N failed".
set -u
. "$(dirname "$0")/cli.sh"

cat >lamp.xml <<'XML'
<scene dialect="2013">
  <image>40 30</image>
  <camera type="PerspectiveCamera">
    <viewPoint>0 2 8</viewPoint>
    <viewDir>0 -0.15 -1</viewDir>
    <viewWidth>1.2</viewWidth>
    <viewHeight>0.9</viewHeight>
  </camera>
  <light name="key"><position>3 4 5</position></light>
  <surface name="lamp" type="Sphere"><center>3 4 5</center><radius>0.2</radius></surface>
  <surface name="b&amp;&lt;ll" type="Sphere"><center>0 1 0</center><radius>1</radius></surface>
</scene>
XML
tells() { check "the answer has: $1" grep -qF -e "$1" out; }

# ---- text
run 0 why lamp.xml 20,15
silent "why"
tells 'lamp.xml, pixel 20,15 of 40 x 30, dialect 2013: #000000 (0 0 0)'
tells 'meets surface 2, Sphere "b&<ll" (line 11)'
tells 'blocked by surface 1, Sphere "lamp" (line 10) after 5.6'
tells 'hint: the light stands inside of that surface'
tells 'nothing was added'
run 0 why lamp.xml 0,0
tells 'it meets nothing, and shows the background, 0 0 0'
cp lamp.xml in.xml
"$glint" why - 20,15 <in.xml >out 2>err
check "standard input" grep -q '^stdin, pixel 20,15' out
run 0 why --size 80x60 --samples 9 --sample 9 lamp.xml 40,30
tells 'pixel 40,30 of 80 x 60'
tells 'Sample 9 of 9, at 0.833, 0.833 of the pixel:'
tells '  9 at 0.833, 0.833:'
run 0 why --samples 25 lamp.xml 20,15
tells '  25 meet surface 2'
run 0 why --dialect 2018 "$root/tests/golden/glass-2012.xml" 50,45
tells 'diffuse colour / pi x n.l'

# ---- what cannot be answered
run 2 why
says 'no scene given'
run 2 why lamp.xml
says 'which pixel?'
run 2 why lamp.xml 20
says "a pixel is X,Y, counted from 0 at the top left, not '20'"
run 2 why lamp.xml 40,0
says 'there is no pixel 40,0: the picture has 40 x 30, so X is 0 to 39 from the left and Y 0 to 29'
run 2 why lamp.xml 1,2 3,4
says 'one scene and one pixel'
run 2 why --sample 2 lamp.xml 1,2
says 'there is no sample 2: the pixel has 1'
run 2 why --format yaml lamp.xml 1,2
says 'text, json, obj or html'
run 2 why --format html --region 0,0,41,1 lamp.xml
says '--region reaches outside of the 40 x 30 pixels'
run 2 why . 1,2
run 1 why missing.xml 1,2
says 'missing.xml'
run 3 why -o nowhere/a.txt lamp.xml 1,2
says 'nowhere/a.txt'
check "no half of an answer" test -z "$(find . -name '*.txt*')"
run 0 why -o a.txt lamp.xml 1,2
printed a.txt
check "the file is the answer" grep -q 'pixel 1,2' a.txt

# ---- JSON: read back, the sums are the picture's floats, bit for bit
cat >sums.py <<'PYTHON'
import json, math, random, struct, subprocess, sys
glint, scene = sys.argv[1:3]
subprocess.run([glint, "-q", "-o", "whole.pfm", scene], check=True)
with open("whole.pfm", "rb") as file:
    assert file.readline() == b"PF\n"
    width, height = map(int, file.readline().split())
    order = "<" if float(file.readline()) < 0 else ">"
    floats = struct.unpack(f"{order}{width * height * 3}f", file.read())
random.seed(scene)
for _ in range(12):
    x, y = random.randrange(width), random.randrange(height)
    text = subprocess.run([glint, "why", "--format", "json", scene, f"{x},{y}"], check=True,
                          capture_output=True).stdout
    told = json.loads(text)
    total = [0.0] * 3
    for sample in told["samples"]:
        total = [a + b for a, b in zip(total, sample["color"])]
    assert total == told["sum"], (x, y, total, told["sum"])
    count = len(told["samples"])
    single = [struct.unpack("<f", struct.pack("<f", s / count * told["exposure"]))[0]
              for s in total]
    row = height - 1 - y # from the bottom
    drawn = list(floats[3 * (row * width + x):][:3])
    assert single == told["color"] == drawn, (x, y, single, told["color"], drawn)
    detail = next(s for s in told["samples"] if "rays" in s)
    total = [0.0] * 3
    for addition in detail["additions"]:
        total = [a + b for a, b in zip(total, addition["amount"])]
        assert total == addition["sum"], (x, y)
        if addition["light"] is not None:
            light = detail["lights"][addition["light"]]
            part = detail["rays"][light["ray"]]["local_factor"]
            assert [a * b for a, b in zip(part, light["term"])] == addition["amount"], (x, y)
    assert total == detail["color"], (x, y)
PYTHON
for name in spheres-2011 glass-2012 lights-material light-2017b facets-2018b paths-glint; do
    check "JSON of $name adds up" "$python" sums.py "$glint" "$root/tests/golden/$name.xml"
done

# ---- OBJ: only known lines, every line element has its two vertices right before it
run 0 why --format obj "$root/tests/golden/glass-2012.xml" 50,45
check "OBJ is well-formed" awk '
    /^#/ || /^g [a-z]+$/ { next }
    /^v / { if (NF != 4) bad = 1; vertices++; next }
    $0 == "l -2 -1" { if (vertices != 2) bad = 1; vertices = 0; lines++; next }
    { bad = 1 }
    END { exit bad || lines < 3 || vertices != 0 }' out
for group in camera mirrored shadow blocked normal; do tells "g $group"; done

# ---- the page
run 0 why --format html lamp.xml
printed lamp.xml.why.html
check "the page is whole" sh -c 'tail -n 1 lamp.xml.why.html | grep -q "</html>"'
check "no text of the scene ends the page's data" \
    sh -c 'test "$(grep -c "</script>" lamp.xml.why.html)" -eq 2'
check "nothing is loaded from elsewhere" sh -c '! grep -qE "(src|href)=.?http" lamp.xml.why.html'
run 0 why --format html --step 3 --region 5,6,20,10 -o part.html lamp.xml 10,10
check "a step and a region" grep -q '"region":\[5,6,20,10\],"step":3' part.html
if command -v chromium >/dev/null && command -v chromedriver >/dev/null; then
    cp "$root/tests/golden/glass-2012.xml" "$root/tests/golden/gem.obj" .
    for what in "lamp.xml 20,15" "glass-2012.xml 50,45" "glass-2012.xml 62,40"; do
        set -- $what
        run 0 why --format html -o page.html "$1"
        check "the page of $what" "$python" "$root/tests/why_page.py" "$glint" "$1" page.html "$2"
    done
else
    skipped=$((skipped + 1))
    echo "skip cli_why_test: no chromium and chromedriver, so the page is not opened"
fi
finish
