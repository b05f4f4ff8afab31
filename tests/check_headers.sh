#!/bin/sh
# SPDX-License-Identifier: MIT
# Every header compiles alone, and the public one also as C++ and in a strict C11.
#   check_headers.sh [SOURCE]
# CC and CXX choose the compilers. Ends with "N passed, N failed[, N skipped]".
set -u
cd "${1:-$(dirname "$0")/..}" || exit 3

cc=${CC:-gcc}
cxx=${CXX:-g++}
passed=0
failed=0
skipped=0

check() { # check HEADER COMMAND...
    header=$1
    shift
    if said=$(printf '#include "%s"\n' "$header" | "$@" -fsyntax-only -Iinclude -Isrc - 2>&1); then
        passed=$((passed + 1))
    else
        failed=$((failed + 1))
        echo "FAIL headers: $header with $1"
        printf '%s\n' "$said" | head -n 5
    fi
}

check glint/glint.h "$cc" -std=c11 -Wall -Wextra -Wpedantic -Werror -x c
if command -v "$cxx" >/dev/null 2>&1; then
    check glint/glint.h "$cxx" -std=c++11 -Wall -Wextra -Wpedantic -Werror -x c++
else
    skipped=1
    echo "skip headers: no C++ compiler"
fi
for file in src/*/*.h; do
    case $file in
    # Parts of kernel.c, which sets the stage for them.
    src/kernel/wide*.h | src/kernel/area.h | src/kernel/bundle.h | src/kernel/certain.h | \
        src/kernel/decide.h | src/kernel/frustum.h | src/kernel/gamma.h | src/kernel/inside.h | \
        src/kernel/light.h | src/kernel/many.h | src/kernel/parallel.h | \
        src/kernel/regroup_order.h | src/kernel/single.h | src/kernel/solid.h | \
        src/kernel/stream.h | src/kernel/triangle.h | \
        *_template.h) continue ;;
    esac
    check "${file#src/}" "$cc" -std=c11 -Wall -Wextra -x c
done
for file in cli/*.h cli/*/*.h; do
    check "${file#cli/}" "$cc" -std=c11 -Wall -Wextra -Icli -x c
done

echo "$passed passed, $failed failed, $skipped skipped"
[ $failed -eq 0 ]
