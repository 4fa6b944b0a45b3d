// Cases on hits: edges, vertices, planes, scales, distances, and degenerate triangles.
#pragma once

#include "apps/render_verify/geometry/broken_on_purpose.h"
#include "apps/render_verify/geometry/coincident.h"
#include "apps/render_verify/geometry/degenerate.h"
#include "apps/render_verify/geometry/edges_from_inside.h"
#include "apps/render_verify/geometry/edges_from_outside.h"
#include "apps/render_verify/geometry/face_planes.h"
#include "apps/render_verify/geometry/fans.h"
#include "apps/render_verify/geometry/far_cameras.h"
#include "apps/render_verify/geometry/not_finite.h"
#include "apps/render_verify/geometry/origins_on_faces.h"
#include "apps/render_verify/geometry/random_rays.h"
#include "apps/render_verify/geometry/slab_planes.h"
#include "apps/render_verify/geometry/slivers.h"
#include "apps/render_verify/geometry/special_directions.h"

namespace cistula::verify::geometry {

using Cases =
    CaseList<EdgesFromInsidePlanes, EdgesFromInsideTriangles, EdgesFromOutsidePlanes, EdgesFromOutsideTriangles, Fans,
             Slivers, ContractedProducts, InclusiveEdges, UnpaddedBoxes, SignedZeros, Subnormals, AxisParallel,
             OnSlabPlanes, OriginsOnPlanes, OriginsOnTriangles, OriginsOnTinyTriangles, NotFiniteRays, ExtremeRays,
             RandomRays, FarCameras, FacePlanes, Coincident, Degenerate>;

}  // namespace cistula::verify::geometry
