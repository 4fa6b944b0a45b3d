#!/usr/bin/env bash
# How `make` configures build folders, one target after another, with a cmake that only shows its arguments: `make render` takes a new
# folder for the renderer alone and leaves others as they are. And which packages of a list cmake/install-packages wants.
# usage: check_configure.sh ROOT
set -euo pipefail
unset MAKEFLAGS MAKELEVEL MFLAGS MAKEOVERRIDES GNUMAKEFLAGS CUDA PRESET CMAKE_ARGS  # those of the `make test` that runs this
root=$(cd "${1:?usage: check_configure.sh ROOT}" && pwd)
tree=$(mktemp -d)
trap 'rm -rf "$tree"' EXIT
mkdir -p "$tree/cmake" "$tree/bin" "$tree/python"
cp "$root/Makefile" "$root/CMakePresets.json" "$root/packages.txt" "$tree"
cp "$root/cmake/configure" "$root/cmake/install-packages" "$tree/cmake"
cat >"$tree/bin/cmake" <<'CMAKE'
#!/bin/sh
[ "$1" = --preset ] || exit 0
echo "configured: $*"
mkdir -p "build/$2" && touch "build/$2/CMakeCache.txt" "build/$2/build.ninja"
CMAKE
printf '#!/bin/sh\nexit 1\n' >"$tree/bin/nvidia-smi"  # no GPU
printf '#!/bin/sh\n' >"$tree/python/make-venv"  # no Python
chmod +x "$tree/python/make-venv" "$tree/bin/cmake" "$tree/bin/nvidia-smi"
cd "$tree"

failures=0
expect() {  # expect EXPECTED FOUND WHAT
    [ "$1" = "$2" ] || { printf '%s\n  expected: %s\n  found:    %s\n' "$3" "$1" "$2"; failures=$((failures + 1)); }
}
# made EXPECTED ARGUMENTS...: what `make ARGUMENTS` asks of cmake; the program that it would start is none of this
made() {
    local found expected=$1
    shift
    found=$(PATH=$tree/bin:$PATH make "$@" SETUP=no 2>/dev/null | sed -n 's/^configured: --preset //p' || true)
    expect "$expected" "$found" "make $*"
}
alone='-DCISTULA_THIS_MACHINE=ON -DCISTULA_WITH_OIIO=OFF -DCISTULA_BUILD_TESTS=OFF -DCISTULA_BUILD_BENCH=OFF'
made "release $alone -DCISTULA_WITH_CUDA=OFF" render
made '' render
made "release --fresh $alone -DCISTULA_WITH_CUDA=ON" render CUDA=yes
made '' render
made 'release --fresh -DCISTULA_EVERY_KERNEL=ON' build
made '' render
made '' render CUDA=yes
made "release --fresh -DCISTULA_EVERY_KERNEL=ON -DCMAKE_CUDA_ARCHITECTURES=75;80 -DX=1" build CMAKE_ARGS="'-DCMAKE_CUDA_ARCHITECTURES=75;80' -DX=1"
made '' render
made 'release --fresh -DCISTULA_EVERY_KERNEL=ON' build
rm build/release/.configured  # as by `cmake --preset release`
made '' render
rm -r build
made "release $alone -DCISTULA_WITH_CUDA=OFF -DCISTULA_WITH_OIIO=ON" render CMAKE_ARGS=-DCISTULA_WITH_OIIO=ON
made 'debug -DCISTULA_EVERY_KERNEL=OFF' build PRESET=debug
made '' test PRESET=debug
made '' render PRESET=debug
made 'debug --fresh -DCISTULA_EVERY_KERNEL=ON' render PRESET=debug CUDA=yes
made '' build PRESET=debug
made 'release-all -DCISTULA_EVERY_KERNEL=ON' build PRESET=release-all
for target in install package gpu-check; do
    rm -r build
    made 'release -DCISTULA_EVERY_KERNEL=OFF' build
    made 'release --fresh -DCISTULA_EVERY_KERNEL=ON' "$target"
    made '' test
done
mkdir build/python && touch build/python/requirements.txt  # Python
made "release --fresh -DCISTULA_BUILD_PYTHON=ON -DPython_EXECUTABLE=$tree/build/python/bin/python -DCISTULA_EVERY_KERNEL=ON" build
made '' render
made '' test
made 'asan -DCISTULA_EVERY_KERNEL=OFF' test PRESET=asan

# wanted LIST: what install-packages says that it wants where there is no apt-get
wanted() { bash -c 'command() { return 1; }; source cmake/install-packages "$1"' wanted "$1" 2>&1 | sed -n 2p; }
printf '# head\n\n# one: the first\na  # why\nb\n\n# two: the second\nc\n' >list.txt
expect 'setup: a b c' "$(wanted list.txt)" 'install-packages list.txt'
expect 'setup: a b' "$(wanted list.txt:one)" 'install-packages list.txt:one'
expect 'setup: c' "$(wanted list.txt:two)" 'install-packages list.txt:two'
for missing in list.txt:three none.txt; do
    code=0
    cmake/install-packages "$missing" >/dev/null 2>&1 || code=$?
    expect 2 "$code" "install-packages $missing"
done
[ "$failures" -eq 0 ]
