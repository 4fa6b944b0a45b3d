#!/usr/bin/env bash
# All sources are as clang-format 14 writes them, by .clang-format.
# usage: check_format.sh ROOT
# Ends with 0 where they are, 1 where they are not, 77 where there is no clang-format 14: other versions write other code.
set -euo pipefail
cd "$1"

program=""
for name in clang-format-14 clang-format; do
    if "$name" --version 2>/dev/null | grep -q 'version 14\.'; then
        program=$name
        break
    fi
done
if [ -z "$program" ]; then
    echo "skipped: no clang-format 14 here (Debian 12: apt-get install clang-format)"
    exit 77
fi

folders=()
for folder in libcore backend_embree backend_cuda apps python bench testing tests examples; do
    [ ! -d "$folder" ] || folders+=("$folder")
done
find "${folders[@]}" -type f \( -name '*.h' -o -name '*.cpp' -o -name '*.cu' -o -name '*.cuh' \) -print0 |
    xargs -0 -n 32 -P "$(nproc)" "$program" --dry-run -Werror --ferror-limit=3 ||
    { echo "$program -i FILE formats them"; exit 1; }
