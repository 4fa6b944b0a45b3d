#!/usr/bin/env bash
# The rules of the source tree that a compiler does not see: which layer includes which, and what must not be used.
# usage: check_layering.sh ROOT | --self-test
set -euo pipefail
shopt -s nullglob globstar
source "$(dirname "${BASH_SOURCE[0]}")/tree_check.sh"
portable=libcore/cistula/numerics/portable.h

# The folders of libcore, bottom to top: each includes itself and those before it.
core_folders=(
    numerics   # numbers: exact, portable, the same everywhere
    model      # what scenes, cameras and pixels are, as arrays and records; which effects there are
    geometry   # where a ray meets a solid or a triangle
    shading    # what a point on a face looks like, and how much of a light reaches it
    traversal  # which solids and triangles a ray meets
    lights     # lights that are seen themselves
    transport  # a pixel's tree of rays
    adaptive   # how many samples a pixel needs
    lanes      # all that with many rays at once, on the host
)
scene_folders=(
    description  # a scene as people write it
    readers      # scene and mesh files to descriptions
    assets       # the meshes and textures that descriptions name, read once
    trees        # trees of boxes
    compile      # descriptions to the arrays that shading reads
)
# The rooms of libcore, bottom to top.
rooms=(
    cistula   # the shading library
    base      # errors, files, hashes, texts, boxes
    image     # pictures and their files
    scene     # scenes from files to arrays
    render    # what a renderer fills, what a frame shows, and the interface of backends
    sequence  # films: frames one after the other, written, resumed, put together
    compare   # pictures and suites of golden images
    verify    # hard cases, by which the renderer checks itself
)

fail() {  # fail RULE < matches
    local line
    while IFS= read -r line; do
        printf '%s\n    %s\n' "$line" "$1"
    done
}

# Lines FILE:NUMBER:TEXT of the given files, without // comments, that match a pattern.
code() {
    local pattern=$1
    shift
    [ $# -gt 0 ] || return 0
    awk -v pattern="$pattern" '{ text = $0; sub(/\/\/.*/, "", text); if (text ~ pattern) print FILENAME ":" FNR ":" $0 }' "$@"
}
includes() { code '^[ \t]*#[ \t]*include' "$@"; }

# layers NAME FOLDER...: files of libcore/NAME lie in one of the folders and include none that comes later. NAME ends in a slash, or
# is empty.
layers() {
    local name=$1 folder file found=() later
    shift
    for file in libcore/"$name"*; do
        [[ " $* " == *" ${file##*/} "* && -d $file || $file == libcore/CMakeLists.txt || $file == libcore/cistula.h ]] ||
            echo "$file" | fail "libcore/$name has the folders $*, and nothing beside them"
    done
    while [ $# -gt 0 ]; do
        folder=$1
        shift
        found=(libcore/"$name$folder"/**/*.{h,cpp,cu})
        later="$*"
        [ -z "$later" ] || includes "${found[@]}" | { grep -E "\"$name(${later// /|})/" || true; } |
            fail "$name$folder lies below ${later// /, }"
        # A folder that is not listed, or none.
        includes "${found[@]}" | { grep -E "\"$name[a-z0-9_]+\.h\"" || true; } | fail "libcore/$name has no files beside its folders"
    done
}

check() {
    cd "$1"
    local core=(libcore/cistula/*/*) below=(libcore/{base,image,scene,render}/**/*.{h,cpp}) above=(libcore/{sequence,compare,verify}/**/*.{h,cpp,cu})
    # What decides values of pictures.
    local pictures=(libcore/{base,image,scene,render/record,render/frame}/**/*.{h,cpp})
    local embree=(backend_embree/**/*.{h,cpp})
    local cuda=(backend_cuda/**/*.{h,cuh,cpp,cu,cu.in}) apps=(apps/**/*.{h,cpp,cu,cpp.in,cu.in}) bench=(bench/**/*.{h,cpp,cu})
    local testing=(testing/**/*.{h,cpp,cu})
    local headers=({libcore,backend_embree,backend_cuda,apps,testing}/**/*.h)
    if [ ${#core[@]} -eq 0 ] || [ ! -e "$portable" ]; then
        echo "no $portable under $1" >&2
        exit 2
    fi

    layers "" "${rooms[@]}"
    layers cistula/ "${core_folders[@]}"
    layers scene/ "${scene_folders[@]}"

    # Standard headers have neither a slash nor, but for C's, a suffix. Registers of lanes need the processor's own.
    includes "${core[@]}" | { grep -vE '^libcore/cistula/lanes/register_[a-z0-9]+\.h:[0-9]+:#include <immintrin\.h>|#[ \t]*include[ \t]*("cistula/[a-z0-9_/]+\.h"|<glm/[a-z0-9_/]+\.hpp>|<[a-z_0-9]+>)' || true; } |
        fail 'libcore/cistula includes "cistula/...", the standard library and GLM, nothing else'
    includes "${below[@]}" | { grep -E 'backend_|apps/|testing/|["<]cuda' || true; } |
        fail 'what backends stand on knows neither backends nor programs'
    includes "${above[@]}" | { grep -E 'apps/|testing/|["<]cuda_' || true; } |
        fail 'the library knows no programs'
    includes libcore/verify/**/*.{h,cpp,cu} | { grep '"compare/' || true; } |
        fail 'verify and compare do not know each other'
    code '(std::(cout|cerr|clog)|[^a-z_](printf|puts|fputs|perror|_exit|exit|signal|sigaction|set_new_handler) *[(])' "${below[@]}" "${above[@]}" |
        { grep -vE '^libcore/image/reader/(reader_main|reader_answer|picture_oiio)\.cpp:|snprintf' || true; } |
        fail 'the library prints nothing, ends no program and handles no signals'
    # Those of other programs, and CSS.
    code '"[^"]*--[a-z]' "${core[@]}" "${below[@]}" "${above[@]}" "${embree[@]}" "${cuda[@]}" |
        { grep -vE '^libcore/compare/(metrics/flip|page/page_style|suite/suite_page)\.cpp:' || true; } |
        fail 'the library knows no options: texts name a setting as `max_samples` (base/error.h)'
    includes "${embree[@]}" | { grep -E 'backend_cuda|apps/|testing/|["<]cuda|"(sequence|compare|verify)/' || true; } |
        fail 'backend_embree knows neither backend_cuda nor what stands on both'
    includes "${cuda[@]}" | { grep -E 'backend_embree|apps/|bench/|testing/|embree[34]/' || true; } |
        fail 'backend_cuda knows neither backend_embree nor programs'
    # Quoted are the rooms below it and itself.
    includes "${cuda[@]}" | { grep -E '#[ \t]*include[ \t]*"' || true; } | { grep -vE '"(cistula|base|image|scene|render|backend_cuda)/[a-z0-9_/]+\.(h|cuh)"' || true; } |
        fail 'backend_cuda includes what backends stand on, "backend_cuda/..." and installed libraries'
    includes "${apps[@]}" | { grep -E '"(bench|tests|testing)/' || true; } |
        fail 'programs know neither benchmarks nor tests'
    # Lines that include another program's folder.
    includes "${apps[@]}" | awk '{ split($0, at, "/"); if (match($0, /"apps\/[a-z_]+\//)) { to = substr($0, RSTART + 6, RLENGTH - 7); if (to != "common" && to != at[2]) print } }' |
        fail 'a program includes apps/common and its own folder, no other program'
    includes "${bench[@]}" | { grep -E '"(tests|testing/support)/' || true; } |
        fail 'benchmarks know no tests'
    includes "${testing[@]}" | { grep -E '"(bench|tests|apps/[a-z_]+)/' || true; } | { grep -v '"apps/common/' || true; } |
        fail 'testing knows neither benchmarks nor tests, and of programs what they share'

    for header in "${headers[@]}"; do
        if [ "$header" != "$portable" ]; then
            { grep -HnE '__CUDACC__|__CUDA_ARCH__|__NVCC__' "$header" || true; } |
                fail 'portable.h is the only header that asks which compiler it is in'
        fi
        grep -q '^#pragma once' "$header" || echo "$header" | fail 'a header without #pragma once'
    done

    local functions='(sin|cos|tan|asin|acos|atan|atan2|sinh|cosh|tanh|pow|exp|exp2|expm1|log|log2|log10|log1p|cbrt|hypot)'
    code "(std|glm)::${functions}f?[ \t]*[(]" "${core[@]}" "${pictures[@]}" |
        fail 'libm differs between systems: use elementary.h and trigonometry.h of cistula/numerics'
    code 'glm::(refract|reflect|normalize|dot|cross|length|distance|mix|clamp|min|max|inversesqrt|mod|fract)[ \t]*[(]' "${core[@]}" |
        fail "of GLM only types and exact operations: products that round are spelled out in cistula/numerics/vec.h"
    # A local function hides that of vec.h, and where sources are compiled together its neighbours then call GLM's.
    code '^[A-Za-z][^=;]*[ *&](cross|dot|length|normalized|along)[(]' "${below[@]}" "${above[@]}" "${embree[@]}" "${cuda[@]}" "${apps[@]}" "${testing[@]}" tests/**/*.{h,cpp} |
        fail 'cross, dot, length, normalized and along are those of cistula/numerics/vec.h: give a local function another name'
    code 'std::f?(min|max)[ \t]*[(<]' "${core[@]}" |
        fail 'library forms of min and max differ on NaN: use min_or_second and max_or_second of cistula/numerics/real.h'

    # Files that name the flags in order to refuse them do not count, nor do records of what was measured.
    { grep -rnE --include='*' -e '-ffast-math|-Ofast|-funsafe-math|-fassociative-math|-freciprocal-math|-ffinite-math-only|-use_fast_math' \
        $(for path in libcore backend_embree backend_cuda testing apps tests bench cmake CMakeLists.txt CMakePresets.json Makefile; do
            [ -e "$path" ] && echo "$path"
        done) || true; } |
        { grep -vE '^(libcore/cistula/numerics/portable\.h|cmake/CistulaContract\.cmake|tests/check_layering\.sh|bench/gpu/CMakeLists\.txt):' || true; } |
        fail 'fast-math flags break the floating-point contract'
    # What exactness costs is measured by a program that nothing else builds, links or installs.
    local fast=bench/gpu/CMakeLists.txt
    if [ -e "$fast" ] && grep -q 'use_fast_math' "$fast"; then
        grep -qE 'add_executable\( *gpu_check_fast +EXCLUDE_FROM_ALL' "$fast" || echo "$fast" | fail 'fast-math is for gpu_check_fast alone, outside of `all`'
        { grep -HnE '^[^#]*(install *\(|add_dependencies *\( *installed)' "$fast" || true; } | fail 'what is built with fast-math is never installed'
    fi
    { grep -rnE 'optimize *\( *"[^"]*(fast|unsafe)|#pragma +(GCC +optimize|STDC +FP_CONTRACT +ON|clang +fp)' \
        libcore $(for path in backend_embree backend_cuda apps; do [ -e "$path" ] && echo "$path"; done) || true; } |
        fail 'floating-point rules are set in cmake/CistulaContract.cmake alone'
}

good_tree() {
    mkdir -p "$1"/{libcore/cistula/{numerics,model,lights},libcore/{base,image/exr,sequence,compare,verify/cases},libcore/render/{record,frame},libcore/scene/compile,backend_embree/host,backend_cuda/kernels,testing/support,apps/{common,render},bench/gpu,cmake}
    printf '#pragma once\n#include <cmath>\n#ifdef __CUDACC__\n#endif\n#error "build without -ffast-math"\n' >"$1/$portable"
    printf 'add_executable(gpu_check_fast EXCLUDE_FROM_ALL a.cu)\ntarget_compile_options(gpu_check_fast PRIVATE --use_fast_math)\n' >"$1/bench/gpu/CMakeLists.txt"
    printf '#pragma once\n#include <glm/vec3.hpp>\n#include "cistula/numerics/portable.h"\n// not std::pow(x)\n' >"$1/libcore/cistula/model/good.h"
}

put() {
    printf '#pragma once\n%s\n' "$2" >"$1"
}

all_rules() {
    breaks libcore/cistula/model/a.h '#include <embree3/rtcore.h>'
    breaks libcore/cistula/model/a.h '#include "scene/description/description.h"'
    breaks libcore/cistula/model/a.h '#include <cuda_runtime.h>'
    breaks libcore/cistula/model/a.h '#include <immintrin.h>'
    breaks libcore/base/a.cpp '#include "backend_embree/embree/embree_renderer.h"'
    breaks libcore/base/a.h '#  include "apps/render/options.h"'
    breaks backend_embree/host/a.cpp '#include "backend_cuda/host/cuda_renderer.h"'
    breaks backend_embree/host/a.h '#include "apps/render/options.h"'
    breaks backend_cuda/kernels/a.cu '#include "backend_embree/embree/embree_renderer.h"'
    breaks backend_cuda/kernels/a.cuh '#include "embree_renderer.h"'
    breaks backend_cuda/kernels/a.cu.in '#include "bench/gpu/record.h"'
    breaks backend_cuda/kernels/a.h '#include <embree3/rtcore.h>'
    breaks libcore/cistula/model/a.h '#include "cistula/lights/visible_light.h"'
    breaks libcore/cistula/numerics/a.h '#  include "cistula/model/good.h"'
    breaks libcore/cistula/model/a.h '#include "cistula/portable.h"'
    breaks libcore/cistula/a.h '#include "cistula/numerics/portable.h"'
    breaks libcore/base/a.h '#include "render/record/film.h"'
    breaks libcore/base/a.cpp '#include "render/frame/frame_view.h"'
    breaks libcore/image/exr/a.cpp '#include "render/record/film.h"'
    breaks libcore/image/exr/a.cpp '#include "backend_embree/embree/embree_renderer.h"'
    breaks libcore/render/frame/a.cpp '#include "sequence/sequence_loop.h"'
    breaks libcore/render/frame/a.cpp '#include "verify/scenes/generated_scene.h"'
    breaks libcore/scene/compile/a.cpp '#include "render/renderer.h"'
    breaks libcore/scene/compile/a.cpp '#include "scene/a.h"'
    breaks libcore/sequence/a.cpp '#include "compare/suite/suite.h"'
    breaks libcore/sequence/a.cpp '#include "apps/common/command_line.h"'
    breaks libcore/compare/a.cpp '#include "verify/verify.h"'
    breaks libcore/verify/a.cpp '#include "compare/page/page_parts.h"'
    breaks libcore/verify/cases/a.cu '#include "testing/support/scene.h"'
    breaks libcore/compare/a.cpp 'void f() { std::fputs("", stderr); }'
    breaks libcore/base/a.cpp 'void f() { std::signal(2, f); }'
    breaks libcore/sequence/a.cpp 'const char* text = "raise --max-samples";'
    breaks backend_cuda/kernels/a.cu 'const char* text = "a smaller --res needs less";'
    breaks backend_embree/host/a.cpp '#include "sequence/sequence_loop.h"'
    breaks backend_embree/host/a.cpp '#include "verify/scenes/generated_scene.h"'
    breaks backend_cuda/kernels/a.h '#include "verify/draw.h"'
    breaks apps/render/a.cpp '#include "bench/gpu/record.h"'
    breaks apps/render/a.cpp '#include "testing/support/gpu.h"'
    breaks apps/render/a.cpp '#include "testing/parity/record.h"'
    breaks apps/render/a.cpp '#include "apps/render_merge/options.h"'
    breaks apps/common/a.cpp '#include "apps/render/options.h"'
    breaks bench/gpu/a.cpp '#include "tests/gpu.h"'
    breaks testing/a.cpp '#include "bench/gpu/record.h"'
    breaks testing/support/a.h '#include "apps/render/options.h"'
    breaks libcore/cistula/model/a.h '#ifdef __CUDA_ARCH__'
    breaks apps/render/a.h '#ifdef __CUDACC__'
    breaks libcore/cistula/model/a.h 'inline float f(float x) { return std::sin(x); }'
    breaks libcore/base/a.cpp 'double f(double x) { return std::pow(x, 2.4); }'
    breaks libcore/render/frame/a.cpp 'double cross(double ax, double ay, double bx, double by) {'
    breaks libcore/cistula/model/a.h 'auto f = glm::refract(d, n, eta);'
    breaks libcore/cistula/model/a.h 'float f(float x) { return std::max(x, 0.0f); }'
    breaks cmake/a.cmake 'add_compile_options(-ffast-math)'
    breaks backend_cuda/CMakeLists.txt 'target_compile_options(x PRIVATE --use_fast_math)'
    breaks bench/gpu/CMakeLists.txt 'target_compile_options(gpu_check PRIVATE --use_fast_math)'
    breaks bench/gpu/CMakeLists.txt "add_executable(gpu_check_fast EXCLUDE_FROM_ALL a.cu --use_fast_math)
install(TARGETS gpu_check_fast)"
    breaks backend_embree/host/a.cpp '__attribute__((optimize("fast-math"))) void f();'
    fresh
    printf 'int x;\n' >"$tree/t/libcore/base/a.h"
    must_detect 'no #pragma once'
}

run_check "$@"
