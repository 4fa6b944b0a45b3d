// Cases on the light that reaches a point: self-shadowing of faces, shadows of closed bodies and of glass, lights in
// contact with these.
#pragma once

#include "apps/render_verify/shadows/acne.h"
#include "apps/render_verify/shadows/closed_box.h"
#include "apps/render_verify/shadows/exact_product.h"
#include "apps/render_verify/shadows/falloff.h"
#include "apps/render_verify/shadows/half_spaces.h"
#include "apps/render_verify/shadows/lights_in_contact.h"
#include "apps/render_verify/shadows/lights_on_star.h"
#include "apps/render_verify/shadows/own_light.h"
#include "apps/render_verify/shadows/permutations.h"
#include "apps/render_verify/shadows/visible_lights.h"

namespace cistula::verify::shadows {

using Cases = CaseList<AcnePlanes, AcneTriangles, AcneSheets, AcneFarPlanes, AcneFarTriangles, AcneTinyTriangles,
                       Terminator, BoxPlanes, BoxTriangles, BoxTiny, BoxPixels, InsideGlassPlanes, InsideGlassTriangles,
                       LightsOnPlanes, LightsOnTriangles, LightsOnStar, LightsInContact, OwnLightPlanes,
                       OwnLightTriangles, LightAtThePoint, Falloff, ThroughSheets, ThroughSolids, PermutedTriangles,
                       PermutedLights, VisibleLightTree, VisibleLightPixels>;

}  // namespace cistula::verify::shadows
