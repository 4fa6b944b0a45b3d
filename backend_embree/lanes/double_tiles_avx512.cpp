// Compiled for AVX-512 (CMakeLists.txt), in a namespace of its own (tile_functions.h).
#define cistula cistula_avx512

#include "backend_embree/lanes/tile_masks.h"

const TileFunctions cistula_double_tiles_avx512 =
    cistula::tile_functions_of<cistula::Lanes<double, cistula::lane_bytes / int(sizeof(double))>>();
