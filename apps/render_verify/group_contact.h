// Bodies that touch: what stands on a floor, lies on something, leans in a corner.
#pragma once

#include "apps/render_verify/contact/broken.h"

namespace cistula::verify::contact {

using Cases = CaseList<InvisibleOnFloor, InvisibleOnMeshFloor, InvisibleOnSolid, InvisibleSideBySide, InvisibleOverEdge,
                       InvisibleInCorner, InvisibleAlongEdge, InvisibleStack, InvisibleSolids, InvisibleConvexMeshes,
                       InvisibleMeshes, InvisibleMeshesInCorner, OpticalContact, EightBlocks, Blocks27,
                       BlocksInAnyOrder, ConvexMeshBlocks, EightMeshes, DecalsOnFloor, DecalsOnMeshFloor, DecalsOnSolid,
                       DecalsOnMesh, LabelOnGlass, ApartOnFloor, ApartOnMeshFloor, ApartOnSolid, ApartSideBySide,
                       ApartOverEdge, ApartInCorner, ApartAlongEdge, ApartStack, ApartConvexMeshes, ApartMeshes,
                       TintedShadow, TintedShadowOnSolid, OpaqueShadow, OpaqueNeighbors, OpaqueInCorner, OpaqueOverEdge,
                       BrokenInvisible, BrokenInvisibleInCorner, BrokenBlocks, BrokenOptical, BrokenDecals,
                       BrokenDecalsOnSolid, BrokenTintedShadow, BrokenApart, BrokenApartStack>;

}  // namespace cistula::verify::contact
