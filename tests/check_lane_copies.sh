#!/usr/bin/env bash
# Objects that are compiled for AVX-512 define nothing but in their own namespace: a linker might take an inline function of theirs in
# place of another's, and the program would stop on processors without AVX-512.
# usage: check_lane_copies.sh LIBRARY | --self-test
set -euo pipefail

# foreign < output of nm -C: what is defined outside of the namespace. DW.ref... is a pointer that the runtime asks for.
foreign() { grep -E ' [A-TV-Zuvw] ' | grep -vE '\bcistula_avx512::|cistula_(float|double)_tiles_avx512$|DW\.ref\.__gxx_personality_v0$' || true; }

if [ "$1" = --self-test ]; then
    found=$(foreign <<<'0 W cistula_avx512::LaneTile<float>::render()
0 W std::vector<int, std::allocator<int> >::push_back(int)
0 R cistula_float_tiles_avx512' | wc -l)
    [ "$found" = 1 ] || { echo "found $found of 1" >&2; exit 1; }
    exit 0
fi

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cd "$scratch"
objects=$(ar t "$1" | grep -E 'avx512' || true)
[ "$(wc -w <<<"$objects")" -ge 2 ] || { echo "$1 has no objects for AVX-512" >&2; exit 1; }
for object in $objects; do
    ar x "$1" "$object"
    found=$(nm -C --defined-only "$object" | foreign)
    [ -z "$found" ] || { printf '%s defines outside of cistula_avx512:\n%s\n' "$object" "$found" >&2; exit 1; }
done
