#!/bin/sh
# SPDX-License-Identifier: MIT
# Pictures that tell how they were drawn: the recipe in the PNG, `glint verify`, scenes inside of
# pictures.
#   cli_verify_test.sh PATH/TO/glint
# Ends with "N passed, N failed".
set -u
. "$(dirname "$0")/cli.sh"

# texts FILE: the Glint texts of a PNG.
texts() {
    "$python" -c '
import struct, sys
data = open(sys.argv[1], "rb").read()
at = 8
while at < len(data):
    size, = struct.unpack(">I", data[at:at + 4])
    kind, body = data[at + 4:at + 8], data[at + 8:at + 8 + size]
    if kind == b"tEXt" and body.startswith(b"Glint\0"): sys.stdout.write(body[6:].decode("latin-1"))
    if kind == b"glFl": print("inside", body.split(b"\0")[0].decode())
    at += 12 + size' "$1"
}

mkdir -p home/scenes home/meshes
cat >home/scenes/a.xml <<'XML'
<scene dialect="glint">
  <image>40 30</image>
  <camera>
    <viewPoint>0.3 0.3 3</viewPoint><viewWidth>1.6</viewWidth><viewHeight>1.2</viewHeight>
  </camera>
  <light><position>1 2 3</position></light>
  <surface type="Mesh"><data>../meshes/a.obj</data></surface>
</scene>
XML
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' >home/meshes/a.obj

# ---- the recipe
run 0 -q -o a.png home/scenes/a.xml
texts a.png >recipe
for line in 'glint ' 'dialect glint' 'size 40 30' 'samples 1' \
    'scene [0-9]* [0-9a-f]* home/scenes/a.xml' 'mesh 32 [0-9a-f]* ../meshes/a.obj' \
    'pixels [0-9a-f]*'; do
    check "the recipe has $line" grep -q "^$line" recipe
done
check "a recipe has no more than that" test "$(wc -l <recipe)" -eq 7
run 0 -q --size 80x60 --crop 5,6,20,10 --samples 4 -o b.png home/scenes/a.xml
texts b.png >recipe
check "crop" grep -q '^crop 5 6 20 10$' recipe
check "samples" grep -q '^samples 4$' recipe
run 0 -q -t 1 -o c.png home/scenes/a.xml
check "threads do not show" cmp -s a.png c.png

# ---- verify
run 0 verify a.png b.png
check "two lines" test "$(wc -l <out)" -eq 2
silent "verify"
run 0 verify -q --isa portable -t 1 a.png
printed ""
cp a.png home/elsewhere.png
cd home || exit 3
run 1 verify elsewhere.png
says "its scene is not found"
run 0 verify --scene scenes/a.xml elsewhere.png
cp elsewhere.png scenes/
run 0 verify scenes/elsewhere.png
cd .. || exit 3
cp -r home changed
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 3 2\n' >changed/meshes/a.obj
run 1 verify --scene changed/scenes/a.xml a.png
says "a.png: error: the mesh '../meshes/a.obj' has changed since"
sed 's/1 2 3/1 2 4/' home/scenes/a.xml >changed/scenes/a.xml
run 1 verify --scene changed/scenes/a.xml a.png
says "the scene 'home/scenes/a.xml' has changed since"
"$python" - <<'PYTHON'
import struct, zlib

def chunks(data):
    at = 8
    while at < len(data):
        size, = struct.unpack(">I", data[at:at + 4])
        yield data[at + 4:at + 8], data[at + 8:at + 8 + size]
        at += 12 + size

def write(name, list):
    with open(name, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n")
        for kind, body in list:
            file.write(struct.pack(">I", len(body)) + kind + body)
            file.write(struct.pack(">I", zlib.crc32(kind + body)))

data = open("a.png", "rb").read()
parts = list(chunks(data))
raw = bytearray(zlib.decompress(b"".join(body for kind, body in parts if kind == b"IDAT")))
raw[500] ^= 1
others = [part for part in parts if part[0] not in (b"IDAT", b"IEND")]
write("touched.png", others + [(b"IDAT", zlib.compress(bytes(raw))), (b"IEND", b"")])
write("bare.png", [part for part in parts if part[0] != b"tEXt"])
write("later.png", [(kind, body.replace(b"samples 1\n", b"foam 7\n")) for kind, body in parts])
write("wrong.png", [(kind, body.replace(b"size 40 30", b"size 41 30")) for kind, body in parts])
write("broken.png", [(kind, body.replace(b"size 40 30", b"size 40 x")) for kind, body in parts])
open("cut.png", "wb").write(data[:-20])
open("flipped.png", "wb").write(data.replace(b"dialect", b"dialekt"))
PYTHON
run 1 verify touched.png
says "its pixels were changed after it was drawn"
run 1 verify bare.png
says "it has no recipe"
run 1 verify later.png
says "its recipe says \`foam\`"
run 1 verify wrong.png
says "its pixels are others"
run 1 verify broken.png
says "its recipe is broken"
run 1 verify cut.png
says "it ends too early"
run 1 verify flipped.png
says "a checksum is wrong"
run 1 verify home/scenes/a.xml
says "this is no PNG picture"
run 1 verify missing.png a.png
check "the others are verified" grep -q '^a.png: the same' out
run 2 verify
run 2 verify --scene x a.png b.png

# ---- the scene inside
run 0 -q --embed -o inside.png home/scenes/a.xml
check "both files are inside" test "$(texts inside.png | grep -c '^inside')" -eq 2
mkdir alone
cp inside.png alone/
cd alone || exit 3
run 0 verify inside.png
run 0 -q --embed -o again.png inside.png
check "drawn again it is the same file" cmp -s inside.png again.png
run 0 -q -o small.png --size 20x15 inside.png
texts small.png >recipe
check "options win" grep -q '^size 20 15$' recipe
run 0 inside.png
printed inside.png.png
run 1 small.png
says "drawn without --embed"
check "nothing is left in the temporary folder" \
    sh -c 'mkdir t && TMPDIR=$PWD/t '"$glint"' -q -o x.png inside.png && test -z "$(ls t)"'
cd ../home/scenes || exit 3
check "a scene from a pipe" sh -c '"$1" -q --embed -o piped.png - <a.xml' sh "$glint"
run 0 verify piped.png
cd ../.. || exit 3
sed 's|../meshes/a.obj|'"$dir"'/home/meshes/a.obj|' home/scenes/a.xml >absolute.xml
run 1 -q --embed -o absolute.png absolute.xml
says "absolute"
check "no picture" test ! -e absolute.png
run 0 -q --embed --layers lights -o layers.png home/scenes/a.xml
run 0 verify layers.png layers.light.1.png

finish
