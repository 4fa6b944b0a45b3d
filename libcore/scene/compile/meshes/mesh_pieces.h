// What a mesh encloses (docs/rules.md, 2): its pieces, which way they face, which of them are bodies and which holes.
// Private to libcore/scene.
#pragma once

#include <string>
#include <vector>

#include "base/error.h"
#include "scene/compile/meshes/mesh_edges.h"
#include "scene/description/mesh_source.h"

namespace cistula {

/// Counts of what was found in a mesh, for warnings.
struct MeshFaults {
    // triangles left out
    uint32_t repeated_vertex = 0;
    uint32_t not_finite = 0;
    uint32_t zero_area = 0;
    uint32_t doubled = 0;      // triangles left out: an earlier one, or an earlier pair, has the same corners
    uint32_t flat_pieces = 0;  // left out: they are closed, but have no volume
    uint32_t turned = 0;       // triangles that were wound unlike most of their piece
    uint32_t opposed = 0;      // triangles of a sheet that were wound against their normals, and are turned
    uint32_t passing = 0;      // pieces that pass through others, so that neither contains the other
    // that keep it from being closed: of one triangle, of more than two
    uint32_t open_edges = 0;
    uint32_t crowded_edges = 0;
    bool one_sided = false;  // it has no two sides, as a Klein bottle

    /// "left out 3 triangles with a repeated vertex and 1 triangle of zero area"; empty if there are none.
    std::string left_out() const;
    /// Why a mesh is not closed: "3 open edges and 1 edge of more than two faces".
    std::string why_not_closed() const;
};

/// The triangles of a mesh that are rendered. Vertices at one position count as one.
struct MeshPieces {
    bool closed = false;           // the triangles surround a volume; else they are a sheet
    std::vector<uint32_t> source;  // their numbers in the mesh, ascending
    std::vector<uint8_t> turned;   // for each whether it is wound the other way than in the mesh; empty: none is
    /// The solid that each belongs to, from 0, in the order of their first triangles. Bodies that come near no other
    /// are one solid.
    std::vector<uint32_t> solid;
    double volume = 0;  // six times that within its outermost pieces; negative if these are wound inward in the mesh
    std::vector<double> thickness;  // of each solid, in scene units: the least volume / area of its bodies
    MeshEdges edges;                // of a mesh that is closed by edges of two triangles each, all there are; else none
    MeshFaults faults;
};

/// Finds what a mesh encloses. Never throws for broken meshes; vertices of triangles must be in range. Throws Error
/// (interrupted).
MeshPieces find_pieces(const MeshSource& mesh, StopSignal stop = {});

}  // namespace cistula
