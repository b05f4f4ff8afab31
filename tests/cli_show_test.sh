#!/bin/sh
# SPDX-License-Identifier: MIT
# `glint --show`: names of pictures, lights by name, and the commands of docs/views.md.
#   cli_show_test.sh PATH/TO/glint [SOURCE]
# Ends with "N passed, N failed".
set -u

[ $# -ge 1 ] || { echo "usage: $0 PATH/TO/glint [SOURCE]" >&2; exit 2; }
glint=$(cd "$(dirname "$1")" && pwd)/$(basename "$1")
source=$(cd "${2:-$(dirname "$0")/..}" && pwd) || exit 3
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
trap 'exit 130' INT TERM
cd "$dir" || exit 3
passed=0
failed=0
pass() { passed=$((passed + 1)); }
fail() {
    failed=$((failed + 1))
    echo "FAIL cli show: $*"
    sed 's/^/  stdout: /' out | head -5
    sed 's/^/  stderr: /' err | head -5
}
check() { # check WHAT COMMAND...: the command must succeed
    what=$1
    shift
    if "$@"; then pass; else fail "$what"; fi
}
run() { # run STATUS ARGUMENT...: runs glint; the output is in out and err
    expected=$1
    shift
    "$glint" "$@" >out 2>err </dev/null
    status=$?
    if [ $status -eq "$expected" ]; then pass; else fail "glint $*: $status, not $expected"; fi
}
says() { check "standard error says: $1" grep -qF -e "$1" err; }
silent() { check "$1" test ! -s err; }

cat >a.xml <<'XML'
<scene dialect="glint">
  <camera><viewPoint>0 0 5</viewPoint></camera>
  <image>40 40</image>
  <light name="left"><position>-5 0 5</position></light>
  <light name="2"><position>5 0 5</position><intensity>0.5 0.5 0.5</intensity></light>
  <light name="right"><position>5 0 5</position></light>
  <surface type="Sphere"/>
</scene>
XML

# ---- names of pictures
for kind in normal depth uv id cost shadow; do
    run 0 --show $kind a.xml
    check "the picture of $kind has its name" test -s a.xml.$kind.png
    check "and is told" grep -qx a.xml.$kind.png out
done
check "the picture itself is not touched" test ! -e a.xml.png
mkdir folder
run 0 --show id -o folder a.xml
check "into a folder" test -s folder/a.xml.id.png
run 0 --show id -o named.pfm a.xml
check "as it is named" test -s named.pfm
run 0 --show picture a.xml
check "the picture is one of them" test -s a.xml.png

# ---- ranges
run 0 --show depth a.xml
says "a.xml: a distance of 4.003 is white, 4.66 is black"
run 0 --show cost a.xml
says "nodes, leaves and exact tests of a pixel are white"
run 0 -q --show depth a.xml
silent "no range with --quiet"

# ---- one light
run 0 --show light:left a.xml
mv a.xml.light.png left.png
run 0 --show light:1 a.xml
check "a light by its number" cmp -s a.xml.light.png left.png
run 0 --show light:right a.xml
mv a.xml.light.png right.png
check "another light is another picture" sh -c '! cmp -s left.png right.png'
run 0 --show light:3 a.xml
check "the third is that one" cmp -s a.xml.light.png right.png
run 0 --show light:2 a.xml
check "a name goes before a number" sh -c '! cmp -s a.xml.light.png right.png'
run 2 --show light:4 a.xml
says "no light of 'a.xml' is named '4', and it has 3, from 1"
run 2 --show light:middle a.xml

# ---- wrong use
run 2 --show a.xml
run 2 --show dept a.xml
says "did you mean 'depth'?"
run 2 --show light: a.xml
run 2 --show depth --layers normal a.xml
run 2 --show depth --embed a.xml

# ---- the commands of the documentation
mkdir -p docs/views
ln -s "$source/scenes" scenes
sed -n 's/^build\/glint \(--show .*\)$/\1/p' "$source/docs/views.md" >commands
while IFS= read -r command; do
    # shellcheck disable=SC2086 # words
    run 0 $command
done <commands
for picture in "$source"/docs/views/*.png; do
    check "$picture is made by a command" test -s "docs/views/${picture##*/}"
    check "$picture is shown" grep -qF "(views/${picture##*/})" "$source/docs/views.md"
done
run 0 --show depth --size 384x216 -o x.png scenes/solids.xml
check "the range is the documented one" grep -qxFf err "$source/docs/views.md"

echo "$passed passed, $failed failed"
[ $failed -eq 0 ]
