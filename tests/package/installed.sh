#!/usr/bin/env bash
# What is installed under PREFIX beside libraries: scenes and documents without loose ends; completion and manuals with all options.
# usage: installed.sh PREFIX
set -euo pipefail
prefix=$1
fail() { echo "installed.sh: $*" >&2; exit 1; }

scenes=$prefix/share/cistula/scenes
for scene in "$scenes"/*.json; do
    "$prefix/bin/render" "$scene" --explain >/dev/null
    schema=$(sed -nE 's/.*"\$schema": "([^"]+)".*/\1/p' "$scene")
    [ -f "$(dirname "$scene")/$schema" ] || fail "$scene: there is no $schema"
done
pages=$(echo "$prefix"/share/doc/*/README.md)
shopt -s globstar
for page in "$pages" "${pages%README.md}"docs/**/*.md; do
    { grep -oE '\]\([^):]+\)' "$page" || true; } | sed -E 's/^\]\(//; s/\)$//; s/#.*//' | while read -r link; do
        [ -e "$(dirname "$page")/$link" ] || fail "$page: there is no $link"
    done
done

for header in $(sed -nE 's/^#include "([^"]+)".*/\1/p' "$prefix"/include/*/cistula.h); do
    grep -qF "\`$header\`" "${pages%README.md}docs/library.md" || fail "library.md does not have $header, which cistula.h lists"
done

# Completions of the last word of a command line.
source "$prefix/share/bash-completion/completions/render"
completed() {
    COMP_WORDS=("$@") COMP_CWORD=$(($# - 1)) COMPREPLY=()
    _cistula "$1" "${*: -1}" "${*: -2:1}"
    printf '%s\n' "${COMPREPLY[@]}"
}
[ -z "$(completed render scene.js)" ] || fail "a scene's name is completed as an option"
[ "$(completed "$prefix/bin/render-compare" suite golden --juni)" = --junit ] || fail "options of render-compare suite are not completed"

manuals=0
for program in "$prefix"/bin/*; do
    name=$(basename "$program")
    cmp -s "$prefix/share/bash-completion/completions/$name" "$prefix/share/bash-completion/completions/render" ||
        fail "bash does not complete $name"
    [[ " $(head -n 1 "$prefix/share/zsh/site-functions/_cistula") " == *" $name "* ]] || fail "zsh does not complete $name"
    options=$("$program" --help | awk '/^Options:/ { inside = 1; next } /^[^ ]/ { inside = 0 } inside' |
        grep -oE '^ +-[a-zA-Z,-]+' | tr ',' '\n' | tr -d ' ')
    [ "$(wc -l <<<"$options")" -gt 8 ] || fail "$name --help has no options"
    diff <(sort <<<"$options") <(completed "$program" - | sort) >&2 || fail "completion of $name is not its options"
    [ "$(completed "$program" --vers)" = --version ] || fail "$name --vers is not completed"
    if command -v zsh >/dev/null; then
        shown=$(timeout 60 zsh -f "$(dirname "${BASH_SOURCE[0]}")/completed.zsh" "$prefix" "$name")
        for option in $options; do
            [[ $option != --* || $shown == *$option* ]] || fail "zsh does not complete $option of $name: $shown"
        done
    fi
    manual=$prefix/share/man/man1/$name.1
    [ -f "$manual" ] || continue
    manuals=$((manuals + 1))
    text=$(sed 's/\\-/-/g; s/\\f[BIR]//g' "$manual")
    for option in $options; do
        grep -qE -e "^(-[a-zA-Z], )?$option( |,|\$)" <<<"$text" || fail "$manual has no $option"
    done
    grep -q "^$name - [A-Z]" <<<"$text" || fail "$manual does not say what $name is"
done
if command -v help2man >/dev/null; then
    [ "$manuals" -gt 3 ] || fail "$manuals programs have a manual"
fi
