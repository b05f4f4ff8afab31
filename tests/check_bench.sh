#!/bin/sh
# SPDX-License-Identifier: MIT
# The bench of whole programs measures, keeps what it measured before, and makes a page of it.
#   check_bench.sh PATH/TO/glint-bench
# Ends with "N passed, N failed".
set -u

[ $# -eq 1 ] || { echo "usage: $0 PATH/TO/glint-bench" >&2; exit 2; }
bench=$(cd "$(dirname "$1")" && pwd)/$(basename "$1")
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
trap 'exit 130' INT TERM
cd "$dir" || exit 3
passed=0
failed=0

check() { # check WHAT COMMAND...: the command must succeed
    what=$1
    shift
    if "$@"; then
        passed=$((passed + 1))
    else
        failed=$((failed + 1))
        echo "FAIL bench: $what"
        sed 's/^/  /' out err
    fi
}
run() { # run STATUS ARGUMENT...
    expected=$1
    shift
    "$bench" "$@" >out 2>err </dev/null
    test $? -eq "$expected"
}
has() { # has FILE TEXT COUNT: lines with the text
    test "$(grep -cF -- "$2" "$1")" -eq "$3"
}
well_formed() {
    /usr/bin/python3 -c 'import sys, xml.dom.minidom as x; x.parse(sys.argv[1])' "$1" 2>err
}

mkdir results
check "scenes are measured" run 0 --alone --reps 1 --threads 4 --results results --page page.md \
    --scenes tiny,mixed-1k,spheres-1k,torus-1k
check "progress is told" has err 'of 4, after' 4
check "with one thread, two and four" has results/*.csv ',glint,' 13 # and the encoder
check "every row has all fields" \
    test "$(grep -v '^#' results/*.csv | awk -F, '{ print NF }' | sort -u)" -eq 25
check "one scene of a kind is no curve" test ! -e page/*.svg

check "another scene is measured" run 0 --alone --reps 1 --results results \
    --scenes spheres-2k
check "the numbers of others stay" has results/*.csv 'spheres-1k,glint,' 3
check "and are replaced by new ones" run 0 --alone --reps 1 --threads 2 --results results \
    --page page.md --scenes spheres-1k
check "of the same scene" has results/*.csv 'spheres-1k,glint,' 2
# Two curves each: of two scenes of spheres and of one torus.
check "two scenes of a kind are a curve" has page/*.svg '<circle' 6
check "the plot is well-formed" well_formed page/*.svg
check "and on the page" has page.md '](page/' 1

# Of another machine, and of rays; with losses, which are to be told.
cat >results/other-avx2.csv <<'CSV'
# Other, avx2, 2 cores
scene,program,threads,surfaces,width,height,runs,wall_ms,peak_mib,wall_to_glint,trace_ms,date
spheres-1k,glint,1,1001,1024,1024,5,100,30,1,80,2026-01-01
spheres-1k,glint,2,1001,1024,1024,5,60,30,1,42,2026-01-01
spheres-1k,tachyon,1,1001,1024,1024,1,50,20,0.5,30,2026-01-02
CSV
trees=build_ms,embree_build_ms,tree_bytes,embree_tree_bytes
cat >results/other-avx2-rays.csv <<CSV
# Other, avx2, 2 cores; kernels avx2; Embree 3.13.5
scene,primitives,rays,glint_mray_per_second,embree_net_mray_per_second,embree_way,net_ratio,$trees
spheres-1k,1001,camera,20,10,8 user high,2,1,2,36000,18000
spheres-1k,1001,bounce,2,4,1 user high,0.5,1,2,36000,18000
CSV
check "a page without measuring" run 0 --only-page --results results --page page.md
check "has a section for each machine" has page.md '## Other, avx2, 2 cores' 1
check "and its dates" has page.md ': 5; measured on 2026-01-01 and until 2026-01-02.' 1
check "says what threads gain" has page.md '| spheres-1k, 2 | 1.67 | | | 1.90 |' 1
check "says how many rays" has page.md '| spheres-1k | camera | 20.00 | 10.00 | 2.00 |' 1
check "says who is faster" has page.md '1 thread: Tachyon needs 0.50 of the time.' 1
check "says who needs less memory" has page.md 'Tachyon needs 0.67 of the memory.' 1
check "says where Embree is faster" has page.md 'bounce rays: Embree (1 user high) traces 2.00' 1
check "and where its tree is smaller" has page.md 'the tree of Embree takes 0.50 of the' 1
check "and nothing of where it is not" \
    test "$(grep -cE 'camera rays: E|is built' page.md)" -eq 0

echo nonsense >results/broken.csv
check "a file of something else is told" run 0 --only-page --results results --page page.md
check "by its name" has err 'broken.csv is of another kind' 1
check "no such scene" run 1 --alone --scenes nothing-7
check "a page without results" run 2 --only-page --page page.md
check "no such option" run 2 --nothing

echo "$passed passed, $failed failed"
[ $failed -eq 0 ]
