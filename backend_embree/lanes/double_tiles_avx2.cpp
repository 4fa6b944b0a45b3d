#include "backend_embree/lanes/tile_masks.h"

const TileFunctions cistula_double_tiles_avx2 =
    cistula::tile_functions_of<cistula::Lanes<double, cistula::lane_bytes / int(sizeof(double))>>();
