#!/usr/bin/env bash
# What documents and comments say of the source tree: what they name exists, what they quote is so, pages stay short, doc comments name
# their subject.
# usage: check_docs.sh ROOT | --self-test
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/tree_check.sh"

most_words=1200
references='^docs/(scene|rules)\.md$'  # may be longer
records='^(docs/decisions/|CHANGELOG\.md$)'      # tell of what is gone, too
foreign='^(quadmath|rtcore|embree3/rtcore|embree4/rtcore|cuda_runtime|immintrin|exp|main)\.h$'  # headers of others that comments name

# Files of the tree, without what is built or fetched.
tree_files() {
    find . \( -name .git -o -path ./build -o -path ./out -o -name '.cuda' -o -name '.venv' -o -name '.gpu' -o -name shared -o -name __pycache__ \) -prune -o -type f -print |
        sed 's,^\./,,' | LC_ALL=C sort
}

# GitHub's anchors of a page's headings, one a line.
anchors() {
    awk '/^```/ { code = !code } !code && /^#+ / { sub(/^#+ +/, ""); print tolower($0) }' "$1" |
        sed -E 's/[^a-z0-9 _-]//g; s/ /-/g'
}

# FILE:LINE:TARGET of the relative links of pages, outside code.
links() {
    awk 'FNR == 1 { code = 0 } /^```/ { code = !code } !code {
            text = $0
            gsub(/`[^`]*`/, "", text)
            while (match(text, /\]\([^)]+\)/)) {
                target = substr(text, RSTART + 2, RLENGTH - 3)
                text = substr(text, RSTART + RLENGTH)
                if (target !~ /^(https?|mailto):/) print FILENAME ":" FNR ":" target
            }
        }' "$@"
}

# FILE:LINE:TARGET of the blocks that quote a whole file: a link to it ends the text before them, "[file](path):".
quotes() {
    awk 'FNR == 1 { code = 0; target = "" }
        /^```/ { code = !code; if (code && target != "") print FILENAME ":" FNR ":" target; target = ""; next }
        code || /^[ \t]*$/ { next }
        { target = match($0, /\]\([^)]+\):$/) ? substr($0, RSTART + 2, RLENGTH - 4) : "" }' "$@"
}

# FILE:LINE:PATH of what looks like a file or a folder of this tree: in pages outside fenced code, in C++ and CUDA after //, in scripts after #.
named_paths() {
    awk 'BEGIN {
            tops = "(libcore|backend_embree|backend_cuda|apps|tests|testing|bench|docs|golden|scenes|cmake|python)"
            folders = "(cistula|scene|numerics|geometry|model|shading|lights|transport|adaptive|base|description|image|readers|trees|film|compile|frame)"
            below = tops "/[A-Za-z0-9_./*-]*[A-Za-z0-9_*]"
            file = folders "/[a-z0-9_/]*[a-z0-9_]\\.(h|cuh|cpp|cu)(\\.in)?"
            bare = "[a-z0-9_][a-z0-9_]+\\.(h|cuh|cpp|cu)(\\.in)?"
        }
        FNR == 1 { code = 0; page = FILENAME ~ /\.md$/; script = FILENAME !~ /\.(h|cuh|cpp|cu|in|md)$/ }
        page && /^```/ { code = !code }
        {
            text = $0
            gsub(/\.html/, "", text)
            if (page) { if (code) next; gsub(/\]\([^)]*\)/, "]", text) }
            else if (script) { if (text !~ /^[ \t]*#[ \t]/) next }
            else if (!sub(/^([^"]|"[^"]*")*\/\//, " ", text)) next
            gsub(/https?:[^ )]*/, "", text)
            while (match(text, "(^|[^A-Za-z0-9_./$<{}-])(" below "|" file "|" bare ")")) {
                found = substr(text, RSTART, RLENGTH)
                rest = substr(text, RSTART + RLENGTH)
                sub(/^[^A-Za-z0-9_]/, "", found)
                text = rest
                if (rest !~ /^[$<{(]/ && found !~ /(NAME|FOLDER|GROUP|PRESET|DIR|FILE|XXX|[*])/) print FILENAME ":" FNR ":" found
            }
        }' "$@"
}

check() {
    cd "$1"
    [ -e docs ] && [ -e README.md ] || { echo "no docs and README.md under $1" >&2; exit 2; }
    local list pages=() sources=() scripts=() headings
    list=$(mktemp)
    trap 'rm -f "$list"' RETURN
    tree_files >"$list"
    mapfile -t pages < <(grep -E '^(docs/.*|README|CONTRIBUTING|CHANGELOG)(\.md)$' "$list")
    mapfile -t sources < <(grep -E '\.(h|cuh|cpp|cu)(\.in)?$' "$list")
    mapfile -t scripts < <(grep -E '(^Makefile|CMakeLists\.txt|\.cmake|\.sh|\.py)$' "$list")

    # Links lead to files, and to headings in them.
    local file line target path anchor
    while IFS=: read -r file line target; do
        path=${target%%#*}
        anchor=
        [[ $target != *#* ]] || anchor=${target#*#}
        if [ -n "$path" ]; then path=$(dirname "$file")/$path; else path=$file; fi
        if [ ! -e "$path" ]; then
            echo "$file:$line: there is no $target"
        elif [ -n "$anchor" ] && [[ $path == *.md ]] && ! anchors "$path" | grep -qxF -e "$anchor"; then
            echo "$file:$line: $path has no heading for #$anchor"
        fi
    done < <(links "${pages[@]}")

    # What is quoted is the file.
    while IFS=: read -r file line target; do
        path=$(dirname "$file")/$target
        [ ! -f "$path" ] || awk -v line="$line" 'NR > line { if (/^```/) exit; print }' "$file" | cmp -s - "$path" ||
            echo "$file:$line: differs from $target, which it quotes"
    done < <(quotes "${pages[@]}")

    # What is named exists: from the root, or as the end of some file's or folder's path.
    { named_paths "${pages[@]}" "${sources[@]}" "${scripts[@]}" || true; } | { grep -vE "$records" || true; } |
        awk -F: -v list="$list" -v foreign="$foreign" '
            BEGIN {
                while ((getline path < list) > 0)
                    for (whole = path; whole != ""; ) {
                        for (tail = whole; ; sub(/^[^\/]*\//, "", tail)) { known[tail] = 1; if (tail !~ /\//) break }
                        if (!sub(/\/[^\/]*$/, "", whole)) break
                    }
            }
            $3 ~ foreign { next }
            {
                name = $3
                sub(/\/$/, "", name)
                sub(/[.]+$/, "", name)
                if (!(name in known)) print $1 ":" $2 ": there is no " $3
            }'

    # "docs/rules.md, 4", "rules 4": a section; "docs/design.md, Light", with or without quotes: a heading.
    if [ -e docs/rules.md ]; then
        headings=$(sed -nE 's/^## ([0-9]+) .*/\1/p' docs/rules.md)
        { grep -HnoE '(docs/rules\.md,|[^a-z]rules) [0-9]+((, [0-9]+)*,? (and|to) [0-9]+)?' "${pages[@]}" "${sources[@]}" || true; } |
            while IFS=: read -r file line target; do
                for section in $(grep -oE '[0-9]+' <<<"${target#*rules}"); do
                    grep -qx "$section" <<<"$headings" || echo "$file:$line: docs/rules.md has no section $section"
                done
            done
    fi
    { grep -HnoE 'docs/[a-z_/0-9-]+\.md, "?[A-Z][A-Za-z0-9 :'"'"'-]*[A-Za-z0-9]"?' "${sources[@]}" || true; } |
        while IFS=: read -r file line target; do
            path=${target%%,*}
            target=${target#*, }
            if [[ $target == \"* ]]; then target=${target//\"/}; else target=${target%% *}; fi
            [ ! -e "$path" ] || sed -nE 's/^#+ //p' "$path" | grep -qF -e "$target" || echo "$file:$line: $path has no heading \"$target\""
        done
    { grep -HnE '//.*\b(NUMERICS|DESIGN|HOUSE)\b' "${sources[@]}" || true; } | sed -E 's/^([^:]*:[0-9]*):.*/\1: names a document that is not here/'

    # Pages are read in one go.
    for file in "${pages[@]}"; do
        if ! [[ $file =~ $references || $file == CHANGELOG.md ]]; then
            line=$(wc -w <"$file")
            [ "$line" -le "$most_words" ] || echo "$file: $line words; a page has at most $most_words"
        fi
    done

    # A doc comment is read alone, in a tooltip.
    awk 'FNR == 1 { inside = 0 }
        /^[ \t]*\/\/\// {
            if (!inside && $0 ~ /^[ \t]*\/\/\/<?[ \t]+(The same|Of|As)([ \t,.;:]|$)/)
                print FILENAME ":" FNR ": a doc comment begins with its subject, not with \"The same\", \"Of\" or \"As\""
            inside = 1
            next
        }
        { inside = 0 }' "${sources[@]}"
}

good_tree() {
    mkdir -p "$1"/{libcore/cistula/geometry,docs/decisions,tests}
    printf '# Rules\n\n## 1 One thing\n\n## 2 Another thing: more\n' >"$1/docs/rules.md"
    printf '# T\n\n[rules](docs/rules.md#1-one-thing), [self](#t), [out](https://example.org/none.md), `geometry/hit.h`, `hit.h`, rules 2 of 1\n\n```\n[no](link.md) libcore/none.h\n```\n\n[quote](tests/quoted.md):\n\n```\nOne.\n\nTwo.\n```\n' >"$1/README.md"
    printf 'One.\n\nTwo.\n' >"$1/tests/quoted.md"
    printf '// A hit (docs/rules.md, 1), as in geometry/hit.h and libcore/cistula/geometry/hit.h.\n\n/// The nearest hit.\n/// Of all.\nint f();  // "docs/rules.md"\n' >"$1/libcore/cistula/geometry/hit.h"
    printf '# Records\n\nTold by `gone.h` of libcore/gone.h.\n' >"$1/docs/decisions/README.md"
}

put() {
    mkdir -p "$(dirname "$1")"
    printf '%s\n' "$2" >>"$1"
}

all_rules() {
    breaks README.md '[gone](docs/gone.md)'
    breaks README.md '[gone](docs/rules.md#3-none)'
    breaks README.md '[gone](#none)'
    breaks docs/page.md '[gone](rules.md#none)'
    breaks docs/decisions/README.md '[gone](0001-gone.md)'
    breaks docs/page.md "$(printf '[file](rules.md):\n\n```\n# Rules\n```')"
    breaks docs/page.md 'See `geometry/gone.h`.'
    breaks docs/page.md 'See `gone.cpp`.'
    breaks docs/page.md 'See libcore/cistula/gone.'
    breaks docs/page.md 'See rules 3.'
    breaks docs/page.md "$(printf 'word %.0s' $(seq 1201))"
    breaks README.md "$(printf 'word %.0s' $(seq 1201))"
    breaks libcore/cistula/a.h '// See tests/gone.cpp.'
    breaks libcore/cistula/a.h 'int x;  // as gone.h does'
    breaks libcore/cistula/a.h '// (docs/rules.md, 3)'
    breaks libcore/cistula/a.h '// (docs/rules.md, 1 and 7)'
    breaks libcore/cistula/a.h '// (docs/rules.md, "None")'
    breaks libcore/cistula/a.h '// (docs/gone.md)'
    breaks libcore/cistula/a.h '// (NUMERICS, 1)'
    breaks libcore/cistula/a.h '/// The same, out of line.'
    breaks libcore/cistula/a.cuh '    /// Of the mask.'
    breaks libcore/cistula/a.cu '/// As it is called.'
    breaks tests/a.sh '# See tests/gone.sh.'
}

run_check "$@"
