#!/usr/bin/env bash
# Runs the commands of README.md and of pages, those in ```sh blocks, as a newcomer would: word by word, in their order, in a fresh copy
# of the tree; those of pages with the programs on the PATH, as they are installed.
# Commands in ```console blocks need a GPU, root or much time, and are not run.
# usage: check_readme.sh ROOT [BUILD] | --self-test
# BUILD: a folder in which `make render` has built already. Then `make` compiles nothing; what else its targets do is done.
# SETUP=no in the environment: no packages are installed.
set -euo pipefail
pages=(docs/grading.md docs/compare-yours.md)
unset MAKEFLAGS MAKELEVEL MFLAGS MAKEOVERRIDES GNUMAKEFLAGS  # those of the `make test` that runs this
self=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)/$(basename "${BASH_SOURCE[0]}")

# What git would check out, with what is not committed yet.
copy_tree() {  # copy_tree FROM TO
    if git -C "$1" rev-parse --is-inside-work-tree >/dev/null 2>&1 && [ -e "$1/.git" ]; then
        git -C "$1" ls-files -z --cached --others --exclude-standard |
            while IFS= read -r -d '' file; do [ ! -e "$1/$file" ] || printf '%s\0' "$file"; done |
            tar -C "$1" --null --files-from=- -cf - | tar -C "$2" -xf -
    else
        tar -C "$1" --exclude=./build --exclude=./out --exclude=./.git -cf - . | tar -C "$2" -xf -
    fi
}

# Stands in for make where all is built: the lines of a target's recipe that do not configure or build.
make_nothing() {
    local lines
    lines=$(command make -n "$@" SETUP=no | grep -vE '^[ \t]*(true$|cmake)')
    [ -n "$lines" ] || { echo "make $*: nothing but building is left of it" >&2; return 1; }
    bash -euo pipefail -c "$lines"
}

check() {  # check ROOT [BUILD]
    local root build copy log blocks='' page commands
    root=$(cd "$1" && pwd)
    [ -e "$root/README.md" ] || { echo "no README.md under $1" >&2; exit 2; }
    for page in README.md "${pages[@]}"; do
        [ "$page" = README.md ] || [ -e "$root/$page" ] || continue
        [ "$page" = README.md ] || blocks+=$'\nPATH=$PWD/build/release/bin:$PATH\n'
        commands=$(awk '/^```/ { inside = !inside && $0 == "```sh"; next } inside' "$root/$page")
        [ -n "$commands" ] || { echo "$page has no commands in sh blocks"; return 1; }
        blocks+=$commands
    done
    copy=$(mktemp -d)
    trap 'rm -rf "$copy"' RETURN
    mkdir "$copy/tree"
    copy_tree "$root" "$copy/tree"
    log=$copy/log
    {
        if [ $# -gt 1 ]; then
            build=$(cd "$2" && pwd)
            mkdir -p "$copy/tree/build"
            ln -s "$build" "$copy/tree/build/release"
            declare -f make_nothing
            echo 'make() { make_nothing "$@"; }'
        fi
        echo 'set -v'
        printf '%s\n' "$blocks"
    } >"$copy/commands"
    if ! (cd "$copy/tree" && bash -euo pipefail "$copy/commands" </dev/null >"$log" 2>&1); then
        echo "a command failed, the last of these:"
        tail -n 40 "$log"
        return 1
    fi
}

# What must be seen, and what must not be run.
self_test() {
    local failures=0
    tree=$(mktemp -d)
    trap 'rm -rf "$tree"' EXIT
    mkdir "$tree/t" "$tree/built"
    printf 'render:\n\t@true\n\tcmake --build build/release --target render\n\tmkdir -p out\n\tbuild/release/program\n' >"$tree/t/Makefile"
    printf '#!/bin/sh\necho image >out/image\n' >"$tree/built/program"
    chmod +x "$tree/built/program"
    holds() {  # holds yes|no README-TEXT
        printf '%b' "$2" >"$tree/t/README.md"
        local found=yes
        "$self" "$tree/t" "$tree/built" >/dev/null 2>&1 || found=no
        [ "$found" = "$1" ] || { echo "expected $1: $2"; failures=$((failures + 1)); }
    }
    holds yes '# T\n```sh\nmake render\ntest -s out/image\n```\n\n```console\nfalse\n```\n\n```sh\ncat < README.md | grep -q T\n```\n'
    holds no '# T\n```sh\ntest -s out/image\nmake render\n```\n'
    holds no '# T\n```sh\nfalse\n```\n'
    holds no '# T\n```sh\nfalse | true\ntrue\n```\n'
    holds no '# T\n```sh\nno-such-program\n```\n'
    holds no '# T\n```sh\nmake none\n```\n'
    holds no '# T\n```console\ntrue\n```\n'
    mkdir -p "$tree/t/docs" "$tree/built/bin"
    cp "$tree/built/program" "$tree/built/bin/installed"
    printf '# P\n```sh\ninstalled\ntest -s out/image\n```\n' >"$tree/t/docs/grading.md"
    holds yes '# T\n```sh\nmake render\n```\n'
    printf '# P\n```sh\nfalse\n```\n' >"$tree/t/docs/grading.md"
    holds no '# T\n```sh\nmake render\n```\n'
    [ ! -e "$tree/t/out" ] || { echo "the source tree was written to"; failures=$((failures + 1)); }
    echo "9 READMEs tried, $failures failures"
    [ "$failures" -eq 0 ]
}

case ${1:-} in
    --self-test) self_test ;;
    "" | -*) echo "usage: $0 ROOT [BUILD] | --self-test" >&2; exit 2 ;;
    *) check "$@" ;;
esac
