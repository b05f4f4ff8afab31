#!/bin/sh
# SPDX-License-Identifier: MIT
# `glint grade` and `glint render --break` as a stranger uses them, and what docs/grade.md shows.
#   cli_grade_test.sh PATH/TO/glint
# Ends with "N passed, N failed".
set -u
. "$(dirname "$0")/cli.sh"

ln -s "$root/tests" tests
mkdir build && ln -s "$glint" build/glint
scene=tests/golden/solids-2012.xml
out_says() { check "standard output says: $1" grep -qF -e "$1" "$dir/out"; }
# value KEY: of the JSON in out.
value() { "$python" -c 'import json, sys; print(json.load(open("out"))[sys.argv[1]])' "$1"; }
has() { # has KEY VALUE
    found=$(value "$1")
    if [ "$found" = "$2" ]; then pass; else fail "$1 is $found, not $2"; fi
}

# Mistakes on purpose.
run 0 render --break list
check "the list has a line for each" test "$(wc -l <out)" -ge 45
out_says 'no-shadows           shadows are missing'
run 2 render --break no-shadow $scene
says "did you mean 'no-shadows'?"
run 2 render --break light-missing=x $scene
says "what follows 'light-missing' is not understood"
run 1 render -q -o x.png --break light-missing=9 $scene
says 'light that is to be missing is not there'
check "no picture of a scene that fails" test ! -e x.png
run 0 render -q -o right.png $scene
run 0 render -q -o wrong.png --break no-shadows $scene
run 0 render -q -t 3 --isa portable -o again.png --break no-shadows $scene
check "the same bytes for other threads and instruction sets" cmp -s wrong.png again.png
check "a mistake is seen" sh -c '! cmp -s wrong.png right.png'
run 0 render -q -o wrong.exr --break flipped $scene
run 0 render -q --embed -o whole.png --break transforms-reversed,light-missing=2 \
    tests/mistakes.xml
run 0 verify whole.png
run 0 render -q -o once-more.png whole.png
run 0 verify once-more.png

# Numbers and verdicts.
run 0 grade right.png $scene
out_says 'right.png: the same'
silent "a right picture"
run 0 grade -q right.png $scene
printed ''
run 1 grade wrong.png $scene
out_says 'wrong.png: shadows are missing (no-shadows): explains 100 % of the difference'
run 0 grade --max-pct 4 wrong.png $scene
run 1 grade --max-pct 3.9 wrong.png $scene
run 1 grade wrong.exr $scene
out_says 'upside down (flipped)'
run 1 grade --format json wrong.png $scene
has passed False
has verdict explained
has mistakes no-shadows
has from_scene True
has size '[150, 112]'
run 0 grade --format json right.png right.png
has verdict same
has mistakes ''
has from_scene False
run 1 grade wrong.png right.png
out_says 'of finished pictures only'
out_says 'unclear'
run 0 render -q --break truncated -o cut.png $scene
run 0 grade --format json cut.png $scene
has verdict rounding
has mistakes truncated
run 0 grade --format json cut.png right.png
has mistakes truncated

# Two mistakes, and one at a time.
run 0 render -q --break no-shadows,gamma-missing -o two.png $scene
run 1 grade --format json two.png $scene
has mistakes no-shadows,gamma-missing
run 1 grade --single --format json two.png $scene
has mistakes gamma-missing
has pairs_tried 0

# Sizes.
run 0 render -q --size 75x56 -o small.png $scene
run 1 grade small.png $scene
out_says 'the size is wrong, it should be 150 x 112; apart from that: the same'
run 0 grade --size 75x56 small.png $scene
run 0 render -q --size 112x150 -o swapped.png $scene
run 1 grade swapped.png $scene
out_says 'width and height are exchanged'

# A picture of the differences.
run 1 grade --diff diff.png wrong.png $scene
run 0 grade --diff none.png right.png $scene
check "the differences have the size of the picture" "$python" -c '
import struct, sys
sizes = {open(name, "rb").read(24)[16:24] for name in ("diff.png", "none.png", "wrong.png")}
sys.exit(len(sizes) != 1)'
run 3 grade --diff no/folder.png wrong.png $scene

# What cannot be compared.
run 2 grade right.png
says 'grade takes a picture and what it should be'
run 2 grade missing.png $scene
says 'missing.png'
run 2 grade right.png missing.xml
says 'missing.xml'
printf 'no picture' >broken.png
run 2 grade broken.png $scene
says 'broken.png'
sed 's/Sphere/Sfere/' "$root/$scene" >wrong.xml
run 2 grade right.png wrong.xml
says 'did you mean "Sphere"'
run 2 grade --max-pct 101 right.png $scene
says '--max-pct takes a number from 0 to 100'
run 2 grade --diff x.txt right.png $scene
says '--diff'

# The course's pictures against the course's scenes: nothing is found where nothing is wrong.
shared=$root/../shared/reference
if [ -d "$shared" ]; then
    for name in 2012/TEST2/four-spheres 2012/TEST2/snow-man 2012/TEST2/two-boxes \
        2012/TEST5/boxgroup; do
        run 0 grade --format json "$shared/$name.xml.soln.png" "$shared/$name.xml"
        check "$name: same or rounding" grep -qE '"verdict": "(same|rounding)"' out
    done
    ours=$shared/2019/ray/data/scenes/ray1/fast_scenes
    run 0 grade "$ours/two-boxes.xml_ref.exr" "$ours/two-boxes.xml" --dialect 2019
else
    skipped=$((skipped + 1))
    echo "skip course's pictures: there is no ../shared/reference"
fi

# What the page shows: the commands of its console blocks and what they print, and its scripts.
"$python" - "$root/docs/grade.md" <<'PYTHON' >shown 2>&1
import re, subprocess, sys
text = open(sys.argv[1]).read()
bad = 0
for block in re.findall(r"```console\n(.*?)```", text, re.S):
    for part in re.split(r"^\$ ", block, flags=re.M)[1:]:
        command, _, expected = part.partition("\n")
        done = subprocess.run(command, shell=True, capture_output=True, text=True,
                              stdin=subprocess.DEVNULL)
        if done.stdout != expected:
            print("docs/grade.md:", command, "prints\n" + done.stdout + done.stderr)
            bad = 1
sys.exit(bad)
PYTHON
status=$?
cp shown out
check "the examples of docs/grade.md" test $status -eq 0
mkdir pictures && cp right.png other.png pictures
"$python" -c 'import re, sys
blocks = re.findall(r"```sh\n(.*?)```", open(sys.argv[1]).read(), re.S)
print("\n".join(blocks))' "$root/docs/grade.md" >script.sh
check "the scripts of docs/grade.md" sh script.sh
check "a line for each picture" test "$(wc -l <grades.csv)" -eq 3
check "a picture of each mistake" test -s mistakes/wrapped.png
finish
