// Cases on what is small beside the extent of its scene: large floors, far solids, a sun, far origins.
#pragma once

#include "apps/render_verify/size/far_things.h"
#include "apps/render_verify/size/floors.h"

namespace cistula::verify::size {

using Cases = CaseList<FloorShadow, FloorShadowOfMesh, FloorInBody, FloorInMesh, FloorMirror, FloorGlass,
                       FloorGlassMesh, FloorTexture, FloatOnFloor, FarSolidShadow, FarSolidReflection, FarSolidTexture,
                       SunShadow, SunReflection, SunTexture, SunSeen, OffsetShadow, OffsetReflection, OffsetTexture>;

}  // namespace cistula::verify::size
