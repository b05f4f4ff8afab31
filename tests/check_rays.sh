#!/bin/sh
# SPDX-License-Identifier: MIT
# The bench of rays prints its table and its CSV, and both sides meet the same surfaces.
#   check_rays.sh PATH/TO/glint-bench-rays
# Ends with "N passed, N failed, N skipped".
set -u

[ $# -eq 1 ] || { echo "usage: $0 PATH/TO/glint-bench-rays" >&2; exit 2; }
bench=$(cd "$(dirname "$1")" && pwd)/$(basename "$1")
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
trap 'exit 130' INT TERM
cd "$dir" || exit 3
passed=0
failed=0
skipped=0

check() { # check WHAT COMMAND...: the command must succeed
    what=$1
    shift
    if "$@"; then
        passed=$((passed + 1))
    else
        failed=$((failed + 1))
        echo "FAIL rays: $what"
        sed 's/^/  /' out err
    fi
}
run() { # run STATUS ARGUMENT...
    expected=$1
    shift
    "$bench" "$@" >out 2>err </dev/null
    test $? -eq "$expected"
}
# Every scene with every kind of rays, and a number in the column: 4 is glint, 6 Embree.
has_rates() { # has_rates COLUMN COUNT
    rows=$(awk -v column="$1" '$2 ~ /^(camera|shadow|bounce)$/ && $column > 0' out | wc -l)
    test "$rows" -eq "$2"
}

check "--quick is measured, and hits agree" run 0 --quick --reps 1 --csv csv
check "rates of glint" has_rates 4 9
if grep -q 'not installed' out; then
    skipped=$((skipped + 1))
    echo "skip rays: no Embree"
else
    check "rates of Embree" has_rates 6 6
fi
check "the CSV has them all" test "$(grep -c '^[mst].*,\(camera\|shadow\|bounce\),' csv)" -eq 9
check "every line of it has all fields" \
    test "$(grep -v '^#' csv | awk -F, '{ print NF }' | sort -u)" -eq 21
# Together 1024 rays ask less of the tree than one by one, and no ray gets away without a question.
# shellcheck disable=SC2016 # a program of awk
check "nodes, leaves and shapes are counted" awk -F, '
    $3 == "camera" { good += $18 > 0 && $18 < 0.5 && $19 > 0 && $19 < 0.5 && $20 > 0.5 }
    $3 == "bounce" { good += $18 > 1 && $19 > 0.5 && $20 > 0.3 }
    END { exit good != 6 }' csv

mkdir results
check "numbers go to the folder" run 0 --quick --reps 1 --scenes spheres-1k --results results
check "and those of another scene" run 0 --quick --reps 1 --scenes torus-1k --results results
check "which leave the first" test "$(grep -c '^[st].*,\(camera\|shadow\|bounce\),' \
    results/*-rays.csv)" -eq 6

cat >scene.xml <<'XML'
<scene dialect="glint">
  <image>40 30</image>
  <camera type="PerspectiveCamera"><viewPoint>0 0 4</viewPoint></camera>
  <surface type="Sphere"/>
  <surface type="Cylinder"/>
  <light><position>4 5 6</position></light>
</scene>
XML
check "a scene from a file, with a shape that Embree lacks" run 0 --reps 1 --scenes scene.xml
check "rates of glint" has_rates 4 3
check "no such scene" run 1 --scenes nothing-7
check "no such instruction set" run 1 --isa nothing
check "no such option" run 2 --nothing

echo "$passed passed, $failed failed, $skipped skipped"
[ $failed -eq 0 ]
