#!/bin/sh
# SPDX-License-Identifier: MIT
# The rules of the house that a program can check (CONTRIBUTING.md has all of them).
#   check_style.sh [SOURCE]
# Ends with "N passed, N failed".
set -u
cd "${1:-$(dirname "$0")/..}" || exit 3
passed=0
failed=0

rule() { # rule NAME FINDINGS: holds when there are none
    if [ -z "$2" ]; then
        passed=$((passed + 1))
    else
        failed=$((failed + 1))
        echo "FAIL style: $1"
        printf '%s\n' "$2" | head -n 10 | sed 's/^/  /'
    fi
}

rooms="include src modules cli tests fuzz bench samples docs"
# shellcheck disable=SC2086 # a list
c_files=$(find $rooms -name '*.[ch]' 2>/dev/null | sort)
scripts="dev .ci/run $(find tests packaging -name '*.sh' | sort)"
python_files=$(find python tests/python -name '*.py' | sort)

# No file of ours has a blank in its name.
# shellcheck disable=SC2046,SC2086 # the lists are lists
{
    rule "the first line names the licence" "$(for file in $c_files; do
        head -n 1 "$file" | grep -q 'SPDX-License-Identifier: MIT' || echo "$file"
    done
    for file in $scripts $python_files; do
        head -n 2 "$file" | grep -q 'SPDX-License-Identifier: MIT' || echo "$file"
    done)"
    rule "no line over 100 columns" "$(awk 'length > 100 { print FILENAME ":" FNR }' \
        $c_files $scripts $python_files)"
    rule "no promises (TO""DO, FIX""ME)" "$(grep -nE 'TO''DO|FIX''ME' $c_files $scripts \
        $python_files)"
    rule "no type ends in _t" "$(grep -nE '^(typedef .*|\} *)[A-Za-z0-9_]+_t;' $c_files)"
    # The one public header is also the documentation of every call.
    rule "no file over 1000 lines" "$(for file in $c_files; do
        [ "$(wc -l <"$file")" -le 1000 ] || [ "$file" = include/glint/glint.h ] || echo "$file"
    done)"
    rule "memory comes from src/base" "$(grep -nE '\b(malloc|calloc|realloc|free)\(' \
        $(find src -name '*.[ch]' ! -path 'src/base/*'))"
    rule "the library never prints, exits or reads the environment" "$(grep -nE \
        '\b(printf|fprintf|puts|perror|exit|abort|getenv)\(' $(find src -name '*.[ch]'))"
}
echo "$passed passed, $failed failed"
[ $failed -eq 0 ]
