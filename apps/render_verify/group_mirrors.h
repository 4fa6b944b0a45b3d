// Cases on mirrors: paths and sums compared with closed forms, and no escapes from closed solids.
#pragma once

#include "apps/render_verify/mirrors/escapes.h"
#include "apps/render_verify/mirrors/folded_paths.h"
#include "apps/render_verify/mirrors/furnace.h"
#include "apps/render_verify/mirrors/mirror_images.h"
#include "apps/render_verify/mirrors/semi_mirror.h"
#include "apps/render_verify/mirrors/unit_length.h"

namespace cistula::verify::mirrors {

using Cases = CaseList<CubeFoldPlanes, CubeFoldTriangles, ParallelPlanes, ParallelSheets, ParallelSum, SemiMirror50,
                       SemiMirror90, SemiMirror99, DepthCut, FurnaceHalves, FurnaceGlass, EscapesPlanes, EscapesMeshes,
                       FirstLines, EscapesByEpsilon, EscapesByFaceAlone, DepthEnds, UnitLength, LengthsNotRenormalized>;

}  // namespace cistula::verify::mirrors
