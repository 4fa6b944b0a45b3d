// Pieces of a mesh as bodies, and bodies as solids (docs/rules.md, 2). Private to libcore/scene.
#pragma once

#include "scene/compile/piece_nesting.h"

namespace cistula {

/// The solids that a mesh's pieces make.
struct MeshSolids {
    std::vector<uint32_t> of_piece;  // numbers from 0, in the order of the pieces
    std::vector<double> thickness;   // of each solid: the least volume / area of its bodies
};

/// Makes a body of each piece at an even depth and of the holes in it. A body whose box, grown by more than what may be
/// taken for a contact (docs/rules.md, 11), meets that of another that is not nested with it is a solid of its own; all
/// others are one together.
MeshSolids part_solids(const std::vector<MeshPiece>& pieces);

}  // namespace cistula
