#!/bin/sh
# SPDX-License-Identifier: MIT
# `glint check` as a stranger uses it: exit statuses, the three formats, what is allowed.
#   cli_check_test.sh PATH/TO/glint [SOURCE]
# Ends with "N passed, N failed".
set -u

[ $# -ge 1 ] || { echo "usage: $0 PATH/TO/glint [SOURCE]" >&2; exit 2; }
glint=$(cd "$(dirname "$1")" && pwd)/$(basename "$1")
cd "${2:-$(dirname "$0")/..}" || exit 3
python=/usr/bin/python3
[ -x "$python" ] || python=python3
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
trap 'exit 130' INT TERM
passed=0
failed=0
pass() { passed=$((passed + 1)); }
fail() {
    failed=$((failed + 1))
    echo "FAIL cli check: $*"
    sed 's/^/  stdout: /' "$dir/out" | head -5
    sed 's/^/  stderr: /' "$dir/err" | head -5
}
check() { # check WHAT COMMAND...: the command must succeed
    what=$1
    shift
    if "$@"; then pass; else fail "$what"; fi
}
run() { # run STATUS ARGUMENT...: runs glint check; the output is in out and err
    expected=$1
    shift
    "$glint" check "$@" >"$dir/out" 2>"$dir/err" </dev/null
    status=$?
    if [ $status -eq "$expected" ]; then pass; else fail "check $*: $status, not $expected"; fi
}
says() { check "standard error says: $1" grep -qF -e "$1" "$dir/err"; }
silent() { check "$1" test ! -s "$dir/err"; }
last_line() {
    if [ "$(tail -n 1 "$dir/err")" = "$1" ]; then pass; else fail "the last line is not: $1"; fi
}
# python_says CODE: the code, given the file, must run through.
python_says() { check "$1" "$python" -c "import json, sys
data = json.load(open('$dir/out'))
$2"; }

t=tests/check

# ---- exit statuses and the closing line
run 0 $t/clean.xml
last_line "1 scene: 0 errors, 0 warnings"
run 0 $t/light-dark.xml
says "$t/light-dark.xml:9:3: warning: the light has no intensity [light-dark]"
last_line "1 scene: 0 errors, 1 warning"
run 1 --strict $t/light-dark.xml
run 0 --strict --allow light-dark $t/light-dark.xml
last_line "1 scene: 0 errors, 0 warnings"
run 0 --strict --allow=no-light,light-dark $t/light-dark.xml
run 1 $t/scene.xml $t/light-dark.xml
says "did you mean \`radius\`?"
last_line "2 scenes: 1 error, 1 warning"
run 1 no-such-file.xml
last_line "1 scene: 1 error, 0 warnings"
run 2
run 2 --allow no-such-rule $t/clean.xml
run 2 --allow light-drak $t/clean.xml
says "did you mean 'light-dark'?"
run 2 --allow syntax $t/clean.xml
says "is an error"
run 2 --format xml $t/clean.xml

# ---- notes
run 0 $t/surface-out-of-view.xml
last_line "1 scene: 0 errors, 0 warnings"
run 0 --strict --notes $t/surface-out-of-view.xml
last_line "1 scene: 0 errors, 0 warnings, 2 notes"
run 0 -q $t/clean.xml
silent "nothing is said of a clean scene with --quiet"

# ---- standard input and folders
"$glint" check - <$t/no-light.xml >"$dir/out" 2>"$dir/err"
says "stdin:2:1: warning: the scene has no light"
run 1 $t
check "a folder is checked, all of it" grep -qE '^[0-9]+ scenes: 3 errors, ' "$dir/err"
check "no picture is made" test -z "$(find $t -name '*.png')"

# ---- rules
run 0 --list-rules
check "rules are listed" grep -q '^warning  light-inside-solid  ' "$dir/out"
# Every rule has its section in the documentation, and the sections no rule that is not there.
cut -c 10- "$dir/out" | cut -d' ' -f1 | sort >"$dir/rules"
sed -n 's/^### `\(.*\)`$/\1/p' docs/check.md | sort >"$dir/documented"
check "docs/check.md has every rule" cmp -s "$dir/rules" "$dir/documented"

# What the documentation shows is what is said.
awk '/^```/ { open = !open; plain = $0 == "```"; next }
    open && plain && !/^(build\/)?glint check /' docs/check.md |
    while IFS= read -r line; do
        cat $t/*.expected | grep -qxF -e "$line" || echo "$line"
    done >"$dir/out"
check "the examples of docs/check.md are true" test ! -s "$dir/out"
run 0 scenes/solids.xml
run 0 --strict scenes
run 0 --format json scenes

# ---- a dialect that is said is not guessed
run 0 --strict --dialect 2018 $t/ambiguous-dialect.xml
last_line "1 scene: 0 errors, 0 warnings"

# ---- JSON
run 0 --format json $t/light-dark.xml $t/stretched-window.xml
silent "JSON comes alone"
python_says "JSON has what there is" "
assert data['scenes'] == 2 and data['errors'] == 0 and data['warnings'] == 2, data
first, second = data['findings']
assert first['rule'] == 'light-dark' and first['severity'] == 'warning', first
assert (first['path'], first['line'], first['column'], first['length']) == (
    '$t/light-dark.xml', 9, 3, 6), first
assert second['hint'] == 'make viewWidth 2', second"
run 0 --format json $t/clean.xml
python_says "JSON of nothing" "assert data['findings'] == []"
run 1 --format json $t/syntax.xml
python_says "JSON of an error" "assert data['findings'][0]['rule'] == 'syntax'"

# ---- SARIF
cp $t/light-dark.xml "$dir/a b.xml"
run 1 --format sarif --notes --strict \
    $t/scene.xml "$dir/a b.xml" $t/surface-out-of-view.xml no-such.xml
silent "SARIF comes alone"
python_says "SARIF is as the standard has it" "
assert data['version'] == '2.1.0' and data['\$schema'].endswith('sarif-2.1.0.json')
(run,) = data['runs']
driver = run['tool']['driver']
assert driver['name'] == 'glint' and driver['version']
rules = driver['rules']
assert len({rule['id'] for rule in rules}) == len(rules) > 20
for rule in rules:
    assert set(rule) == {'id', 'shortDescription', 'help', 'defaultConfiguration'}, rule
    assert rule['shortDescription']['text'].endswith('.') and rule['help']['text'].endswith('.')
    assert rule['defaultConfiguration']['level'] in ('error', 'warning', 'note')
assert run['columnKind'] == 'unicodeCodePoints'
for result in run['results']:
    assert set(result) == {'ruleId', 'ruleIndex', 'level', 'message', 'locations'}, result
    assert rules[result['ruleIndex']]['id'] == result['ruleId']
    assert result['level'] == rules[result['ruleIndex']]['defaultConfiguration']['level']
    assert result['message']['text']
    (place,) = result['locations']
    region = place['physicalLocation'].get('region')
    assert place['physicalLocation']['artifactLocation']['uri']
    if region:
        assert region['startLine'] >= 1 and 1 <= region['startColumn'] < region['endColumn']
results = [(result['ruleId'], result['level']) for result in run['results']]
assert results == [('scene', 'error'), ('light-dark', 'warning'),
    ('surface-out-of-view', 'note'), ('surface-out-of-view', 'note'), ('file', 'error')], results
assert run['results'][1]['locations'][0]['physicalLocation']['artifactLocation']['uri'].endswith(
    '/a%20b.xml')"
run 0 --format sarif $t/clean.xml
python_says "SARIF of nothing" "assert data['runs'][0]['results'] == []"

echo "$passed passed, $failed failed"
[ $failed -eq 0 ]
