// The copies of the tile renderers for different instruction sets. Each lies in a namespace of its own, so that no
// linker takes an inline function that was compiled for AVX-512 in place of another's; so copies share plain functions
// only.
#pragma once

#include <cstdint>

extern "C" {

/// Tiles that are rendered in lanes (LaneTile). Pointers are those of the arguments of TileRenderer.
struct TileFunctions {
    int lanes;
    void* (*make)(int mask, const void* scene, const void* frame);
    void* (*make_by_sample)(const void* scene, const void* frame);  // with all effects
    void (*add)(void* tile, const void* pixel);
    void (*render)(void* tile, const void* stop, void* rays, uint32_t* flags);
    void (*destroy)(void* tile);
    // LaneRayQueries, of at most `lanes` rays at once.
    void (*closest)(const void* scene, const void* rays, int count, void* hits);
    void (*transmittance)(const void* scene, const void* shadows, int count, void* shares);
};

extern const TileFunctions cistula_float_tiles_avx2, cistula_double_tiles_avx2;
extern const TileFunctions cistula_float_tiles_avx512, cistula_double_tiles_avx512;

/// The copies of one precision that this build has; null are those that it has not.
struct TileCopies {
    const TileFunctions *avx512, *avx2;
};
extern const TileCopies cistula_float_tiles, cistula_double_tiles;
}
