// Which pieces of a mesh lie in which (docs/rules.md, 2). Private to libcore/scene.
#pragma once

#include <vector>

#include "base/box.h"
#include "base/error.h"
#include "scene/description/mesh_source.h"

namespace cistula {

/// A connected closed part of a mesh's surface.
struct MeshPiece {
    std::vector<uint32_t> triangles;  // ascending
    Box box;
    double volume = 0, area = 0;    // six times and twice
    uint32_t depth = 0;             // the number of pieces that contain it
    uint32_t container = no_piece;  // the least of these

    static constexpr uint32_t no_piece = 0xffffffffu;
};

/// Sets depths and containers. `triangles` are wound counter-clockwise seen from outside their piece. A piece contains
/// another of less volume if points inside that one, beside up to 23 of its triangles, are all in it. Returns how many
/// pieces have some of these points in another and some not: they pass through it, and it does not contain them.
uint32_t nest_pieces(std::span<const glm::dvec3> vertices, std::span<const TriangleCorners> triangles,
                     std::vector<MeshPiece>& pieces, StopSignal stop);

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
