// Cases on changes that must leave an image unchanged or change it in a known way: scales, flips, effects, threads,
// samples, brightness.
#pragma once

#include "apps/render_verify/metamorphic/brightness.h"
#include "apps/render_verify/metamorphic/effects.h"
#include "apps/render_verify/metamorphic/flips.h"
#include "apps/render_verify/metamorphic/floor_texture.h"
#include "apps/render_verify/metamorphic/one_hash.h"
#include "apps/render_verify/metamorphic/overflow.h"
#include "apps/render_verify/metamorphic/powers.h"
#include "apps/render_verify/metamorphic/samples.h"
#include "apps/render_verify/metamorphic/sizes.h"
#include "apps/render_verify/metamorphic/transforms.h"

namespace cistula::verify::metamorphic {

using Cases =
    CaseList<MoreEffects, OneHash, ThreadsAndTiles, PowersOfTwo, DyadicTranslation, TranslatedImages, FoundCenter,
             FlipsOfPlanes, FlipsOfTriangles, FlippedImages, ConstantScene, HalfPlane, SharedBorder, CellBorders,
             RepeatedNear, RepeatedFar, FarFloor, IntegerPowers, RealPowers, Highlights, OnePixel, Strips, WideFields,
             Brightness, ColorsAgainstLights, ExtremeRadiance, OverflowIsSaid>;

}  // namespace cistula::verify::metamorphic
