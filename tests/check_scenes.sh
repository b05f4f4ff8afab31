#!/bin/sh
# SPDX-License-Identifier: MIT
# The scenes of scenes/: each opens with a comment, is drawn, very small, and has its picture in the
# gallery.
#   check_scenes.sh PATH/TO/glint [SOURCE]
# Ends with "N passed, N failed".
set -u

[ $# -ge 1 ] || { echo "usage: $0 PATH/TO/glint [SOURCE]" >&2; exit 2; }
glint=$(cd "$(dirname "$1")" && pwd)/$(basename "$1")
cd "${2:-$(dirname "$0")/..}" || exit 3
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
trap 'exit 130' INT TERM
passed=0
failed=0

check() { # check WHAT COMMAND...: the command must succeed
    what=$1
    shift
    if "$@"; then
        passed=$((passed + 1))
    else
        failed=$((failed + 1))
        echo "FAIL scenes: $what"
    fi
}
opens_with_comment() { sed -n 2p "$1" | grep -q '^<!-- '; }
at_most() { # at_most BYTES FILE
    [ "$(wc -c <"$2")" -le "$1" ]
}
is_in() { grep -qF "$1" "$2"; }

"$glint" --size 12x9 -o "$dir" scenes >"$dir/names" 2>"$dir/err" </dev/null
check "all are drawn, without a word: $(head -n 3 "$dir/err")" test $? -eq 0 -a ! -s "$dir/err"
for scene in scenes/*.xml; do
    name=$(basename "$scene" .xml)
    picture=docs/gallery/$name.png
    check "$scene is drawn" test -s "$dir/$name.xml.png"
    check "$scene says what it shows in its second line" opens_with_comment "$scene"
    check "$picture is there" test -s "$picture"
    check "$picture has at most 150 KB" at_most 153600 "$picture"
    check "docs/gallery.md shows $picture" is_in "(gallery/$name.png)" docs/gallery.md
    check "docs/gallery.md has the command for $scene" is_in "build/glint $scene" docs/gallery.md
done
for picture in docs/gallery/*.png; do
    check "$picture has a scene" test -f "scenes/$(basename "$picture" .png).xml"
done
for file in scenes/data/*; do
    check "$file has at most 1 MB" at_most 1048576 "$file"
done
echo "$passed passed, $failed failed"
[ $failed -eq 0 ]
