# SPDX-License-Identifier: MIT
# What the tests of the program share; they source it with the path of the program as $1. It goes to
# a folder of its own, which is removed at the end, and gives `run`, `check`, `says` and the like.
[ $# -eq 1 ] || { echo "usage: $0 PATH/TO/glint" >&2; exit 2; }
glint=$(cd "$(dirname "$1")" && pwd)/$(basename "$1")
python=/usr/bin/python3
[ -x "$python" ] || python=python3
root=$(cd "$(dirname "$0")/.." && pwd)
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
trap 'exit 130' INT TERM
cd "$dir" || exit 3

passed=0
failed=0
skipped=0
pass() { passed=$((passed + 1)); }
fail() {
    failed=$((failed + 1))
    echo "FAIL $(basename "$0" .sh): $*"
    sed 's/^/  stdout: /' "$dir/out" | head -5
    sed 's/^/  stderr: /' "$dir/err" | head -5
}
check() { # check WHAT COMMAND...: the command must succeed
    what=$1
    shift
    if "$@"; then pass; else fail "$what"; fi
}

# run STATUS ARGUMENT...: runs glint and checks its exit status; the output is in out and err.
run() {
    expected=$1
    shift
    "$glint" "$@" >"$dir/out" 2>"$dir/err" </dev/null
    status=$?
    if [ $status -eq "$expected" ]; then
        pass
    else
        fail "glint $*: status $status, not $expected"
    fi
}
says() { check "standard error says: $1" grep -qF -e "$1" "$dir/err"; }
silent() { check "$1: nothing on standard error" test ! -s "$dir/err"; }
printed() {
    if [ "$(cat "$dir/out")" = "$1" ]; then pass; else fail "standard output is not: $1"; fi
}
finish() { # ends the script with "N passed, N failed"
    skips=
    [ $skipped -eq 0 ] || skips=", $skipped skipped"
    echo "$passed passed, $failed failed$skips"
    [ $failed -eq 0 ]
    exit
}
