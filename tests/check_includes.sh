#!/bin/sh
# SPDX-License-Identifier: MIT
# Includes point downward only. Every #include between rooms is held against the table below, which
# is the plan of the house (docs/architecture.md).
#   check_includes.sh [SOURCE]
# Ends with "N passed, N failed".
set -u
cd "${1:-$(dirname "$0")/..}" || exit 3

# Room: the rooms that it may see besides itself, base, math and the public header.
all='mistake compare grade check sample light texture mesh render reader format scene image accel'
all="$all kernel shape shade camera sched port"
plan="
base:
math:
port:
mistake:
sample:
sched: port
shape:
mesh: shape sched port
image: sched port
light: image port
texture: port
scene: mesh shape light texture port
accel: shape sched port
kernel: accel light shape port
shade: scene shape light texture
camera: mistake scene
reader: scene mesh shape light texture sched port
format: reader scene mesh shape light texture sched port
compare: texture image sched port
grade: mistake compare sched
render: mistake sample light texture shade camera kernel accel image sched scene shape port
check: render reader accel camera kernel scene shape light mesh texture sched
glint.c: $all glint_scene.h
glint_build.c: $all glint_scene.h
glint_explain.c: $all glint_scene.h
glint_format.c: $all
glint_grade.c: $all glint_scene.h
glint_recipe.c: $all glint_scene.h
glint_scene.h: $all
"

found=$(grep -rnE '^[[:space:]]*#[[:space:]]*include[[:space:]]*"' src --include='*.[ch]')
report=$(printf '%s\n--\n%s\n' "$plan" "$found" | awk '
    /^--$/ { in_plan = 0; sources = 1; next }
    !sources {
        if (split($0, part, ":") < 2) next
        room = part[1]
        known[room] = 1
        count = split(part[2], names, " ")
        for (i = 1; i <= count; i++) allowed[room, names[i]] = 1
        next
    }
    {
        if (split($0, part, ":") < 3) next
        path = part[1]
        split(path, step, "/")
        room = step[2]
        match($0, /"[^"]*"/)
        target = substr($0, RSTART + 1, RLENGTH - 2)
        # A name without a folder lies in the same room.
        other = target ~ /\// ? substr(target, 1, index(target, "/") - 1) : room
        if (!(room in known)) bad = "is in a room that is not in the plan"
        else if (other == "glint" || other == room) bad = ""
        else if (other == "base" && room != "base") bad = ""
        else if (other == "math" && room != "base" && room != "port") bad = ""
        else if ((room, other) in allowed) bad = ""
        else bad = "may not include " target
        if (bad == "") good++
        else printf "FAIL includes: %s:%s: %s %s\n", path, part[2], room, bad
    }
    END { print good + 0 }')
passed=$(printf '%s\n' "$report" | tail -n 1)
problems=$(printf '%s\n' "$report" | grep '^FAIL')
failed=0

# The program sees the public header, its own files, and the system.
strangers=$(grep -nE '#[[:space:]]*include[[:space:]]*"' cli/*.[ch] cli/*/*.[ch] |
    while IFS= read -r line; do
    name=$(printf '%s\n' "$line" | sed 's/.*"\(.*\)".*/\1/')
    [ "$name" = glint/glint.h ] || [ -e "cli/$name" ] || echo "FAIL includes: $line"
done)
[ -n "$strangers" ] || passed=$((passed + 1))
if [ -n "$problems$strangers" ]; then
    printf '%s\n%s\n' "$problems" "$strangers" | sed '/^$/d'
    failed=$(printf '%s\n%s\n' "$problems" "$strangers" | grep -c FAIL)
fi
echo "$passed passed, $failed failed"
[ "$failed" -eq 0 ]
