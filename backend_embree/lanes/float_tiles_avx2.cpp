#include "backend_embree/lanes/tile_masks.h"

const TileFunctions cistula_float_tiles_avx2 =
    cistula::tile_functions_of<cistula::Lanes<float, cistula::lane_bytes / int(sizeof(float))>>();
