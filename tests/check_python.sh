#!/bin/sh
# SPDX-License-Identifier: MIT
# The Python package on the library of a build: with NumPy, and without it.
#   check_python.sh [BUILD]
# Ends with "N passed, N failed[, N skipped]".
set -u
build=$(cd "${1:-build}" && pwd) || exit 3
source=$(cd "$(dirname "$0")/.." && pwd) || exit 3
# The python3 that comes first in PATH may lack the packages.
python=/usr/bin/python3
[ -x "$python" ] || python=python3
export GLINT_LIBRARY="$build/libglint.so.0" GLINT_PROGRAM="$build/glint"
export PYTHONPATH="$source/python" PYTHONDONTWRITEBYTECODE=1

log=$(mktemp) || exit 3
trap 'rm -f "$log"' EXIT
trap 'exit 130' INT TERM
passed=0
failed=0
skipped=0

count() { # count COMMAND...: adds up what it ends with, and shows the rest
    "$@" >"$log" 2>&1
    grep -vE '^[0-9]+ passed, ' "$log"
    tally=$(grep -E '^[0-9]+ passed, [0-9]+ failed' "$log" | tail -n 1)
    # shellcheck disable=SC2046 # numbers
    set -- $(echo "${tally:-0 passed, 1 failed}" | tr -cs '0-9' ' ') 0
    passed=$((passed + $1))
    failed=$((failed + $2))
    skipped=$((skipped + $3))
}

count "$python" "$source/tests/python/run.py"
# Without the site's packages there is no NumPy.
count "$python" -S "$source/tests/python/run.py" --plain building image scene tracing

echo "$passed passed, $failed failed, $skipped skipped"
[ "$failed" -eq 0 ]
