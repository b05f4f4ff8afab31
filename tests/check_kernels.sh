#!/bin/sh
# SPDX-License-Identifier: MIT
# What a kernel compiled for a newer processor may leave in the library: symbols that end in the
# name of its instruction set, and constants. Anything else might be picked by the linker for code
# that an older machine runs (a shared inline function), or run at start (a constructor).
#   check_kernels.sh BUILD
# Ends with "N passed, N failed".
set -u
build=${1:-build}
passed=0
failed=0

for folder in "$build"/libkernel_*.a.p; do
    isa=${folder##*/libkernel_}
    isa=${isa%.a.p}
    for object in "$folder"/*.o; do
        # Sanitizers and coverage bring tables of their own.
        symbols=$(nm -P "$object" | grep -vE '(asan|ubsan|tsan|sancov|gcov|llvm|__odr|profc|profd)')
        # Defined and not local: the second column is a capital other than U, or a weak w or v.
        shared=$(printf '%s\n' "$symbols" |
            awk -v isa="_$isa" '$2 ~ /^[A-TV-Z]$/ || ($2 ~ /^[wvu]$/ && NF > 2) {
                if (substr($1, length($1) - length(isa) + 1) != isa) print $1 " (" $2 ")" }')
        # Writable data, also static: d, b, and their common and small forms.
        writable=$(printf '%s\n' "$symbols" |
            awk '$2 ~ /^[DdBbCcGgSs]$/ && $1 !~ /^\.?(LC|LASAN|\.data|\.bss)/ {
                print $1 " (" $2 ")" }')
        # Tables of function pointers are constant, but need relocation: nm calls .data.rel.ro "d".
        if [ -n "$writable" ]; then
            writable=$(for name in $(printf '%s\n' "$writable" | sed 's/ .*//'); do
                objdump -t "$object" | awk -v name="$name" '
                    $NF == name && $0 !~ /\.rodata|\.data\.rel\.ro/ { print name }'
            done)
        fi
        starters=
        if ! nm "$object" | grep -qE '(asan|ubsan|tsan|sancov|gcov)'; then
            starters=$(objdump -h "$object" | grep -E '\.(init_array|ctors)')
        fi
        if [ -z "$shared$writable$starters" ]; then
            passed=$((passed + 1))
        else
            failed=$((failed + 1))
            echo "FAIL kernels: $object"
            [ -z "$shared" ] || printf '  does not end in _%s: %s\n' "$isa" "$shared"
            [ -z "$writable" ] || printf '  writable: %s\n' "$writable"
            [ -z "$starters" ] || printf '  runs at start: %s\n' "$starters"
        fi
    done
done
if [ $((passed + failed)) -eq 0 ]; then
    echo "FAIL kernels: no kernel objects in $build"
    failed=1
fi
echo "$passed passed, $failed failed"
[ $failed -eq 0 ]
