#!/bin/sh
# SPDX-License-Identifier: MIT
# What shells complete: in bash as it happens there, in fish by asking it, in zsh by its own check.
# A shell that is not installed is skipped.
#   cli_completion_test.sh PATH/TO/glint
# Ends with "N passed, N failed".
set -u
. "$(dirname "$0")/cli.sh"

touch scene.xml
run 0 completion bash
cp out glint.bash
run 0 completion zsh
cp out _glint
run 0 completion fish
cp out glint.fish
run 2 completion
run 2 completion tcsh
says "bash, zsh or fish"
says "glint completion --help"

verbs=$("$glint" --help | sed -n 's/^  \([a-z]*\) .*/\1/p' | grep -v '^glint$')

# ---- bash
if command -v bash >/dev/null; then
    cat >ask.bash <<'SCRIPT'
source ./glint.bash
COMP_WORDS=("$@")
COMP_CWORD=$((${#COMP_WORDS[@]} - 1))
_glint
printf '%s\n' "${COMPREPLY[@]}"
SCRIPT
    offers() { # offers WORD WORDS...: the last of the words can be completed to the first
        wanted=$1
        shift
        check "bash completes: $* to $wanted" sh -c 'wanted=$1; shift
            bash ask.bash "$@" | grep -qx -e "$wanted"' sh "$wanted" "$@"
    }
    offers render glint ren
    offers scene.xml glint sc
    offers --samples glint --sa
    offers --scene glint verify --sc
    offers 2017b glint --dialect 2017
    offers portable glint verify --isa po
    offers fish glint completion f
    offers scene.xml glint render -o sc
    for verb in $verbs; do
        offers --help glint "$verb" --h
        "$glint" "$verb" --help | sed -n 's/^ *\(-., \)*\(--[a-z-]*\).*/\2/p' >options
        while read -r option; do offers "$option" glint "$verb" "$option"; done <options
    done
else
    skipped=$((skipped + 1))
fi

# ---- the others
if command -v zsh >/dev/null; then
    check "zsh reads it" zsh -n _glint
else
    skipped=$((skipped + 1))
fi
if command -v fish >/dev/null; then
    check "fish reads it" fish -n glint.fish
    for case in "glint ver:verify" "glint verify --sc:--scene" "glint --dialect 2017:2017b" \
        "glint completion z:zsh"; do
        check "fish completes ${case%%:*}" sh -c 'fish -c "source glint.fish; complete -C \"$1\"" |
            cut -f 1 | grep -qx -e "$2"' sh "${case%%:*}" "${case##*:}"
    done
else
    skipped=$((skipped + 1))
fi

finish
