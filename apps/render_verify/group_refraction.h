// Cases on refraction: Snell, Fresnel, total reflection, and nested media.
#pragma once

#include "apps/render_verify/refraction/brewster.h"
#include "apps/render_verify/refraction/camera_inside.h"
#include "apps/render_verify/refraction/critical_angle.h"
#include "apps/render_verify/refraction/fresnel.h"
#include "apps/render_verify/refraction/grazing.h"
#include "apps/render_verify/refraction/index_one.h"
#include "apps/render_verify/refraction/media.h"
#include "apps/render_verify/refraction/prism.h"
#include "apps/render_verify/refraction/reversibility.h"
#include "apps/render_verify/refraction/slab.h"

namespace cistula::verify::refraction {

using Cases = CaseList<IndexOne, CriticalAngle, CriticalAngleTraced, FresnelNormal, FresnelEqual, FresnelGrazing,
                       AnyAngle, BrewsterShare, BrewsterAngle, Reversibility, SlabParallel, SlabDisplacement,
                       PrismDeviation, MediaPlanes, MediaTriangles, MediaMixed, MediaMovedPlanes, MediaMovedTriangles,
                       MediaOctants, MediaMixedOctants, GrazingShared, GrazingMoved, CameraInside>;

}  // namespace cistula::verify::refraction
