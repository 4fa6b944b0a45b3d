#include "scene/compile/meshes/piece_nesting.h"

#include "cistula/numerics/vec.h"
#include "scene/trees/tree_build.h"

namespace cistula {
namespace {

using glm::dvec3;

constexpr uint32_t none = 0xffffffffu;

/// Whether a piece lies in another, as far as containers tell.
bool lies_in(const std::vector<MeshPiece>& pieces, uint32_t inner, uint32_t outer) {
    while (inner != MeshPiece::no_piece && inner != outer) inner = pieces[inner].container;
    return inner == outer;
}

/// The pieces that begin bodies and come near another body that they are not nested with.
std::vector<uint8_t> bodies_that_meet(const std::vector<MeshPiece>& pieces) {
    // A contact is 2^-10 of a body's thickness at most, and that half of its box's least width.
    constexpr double growth = 0x1p-11;
    std::vector<uint32_t> outer;
    Box all;
    for (uint32_t i = 0; i < pieces.size(); ++i) {
        if (pieces[i].depth % 2 == 0) outer.push_back(i);
        for (const dvec3& end : {pieces[i].box.low, pieces[i].box.high}) all.add(end);
    }
    std::vector<uint8_t> meets(pieces.size(), 0);
    if (outer.size() < 2) return meets;
    const double size = largest_component(all.high - all.low);
    const auto grown = [&](uint32_t i) {  // in units of the mesh, which floats can hold
        const dvec3 low = (pieces[i].box.low - all.low) / size;
        const dvec3 high = (pieces[i].box.high - all.low) / size;
        const dvec3 width = high - low;
        const double pad = growth * min_or_second(width.x, min_or_second(width.y, width.z));
        return Box{low - dvec3(pad), high + dvec3(pad)};
    };
    std::vector<RTCBuildPrimitive> primitives;
    for (const uint32_t i : outer) primitives.push_back(padded_primitive(grown(i), 0, i));
    const Tree tree = build_tree(primitives, 0);
    for (const uint32_t i : outer)
        meets[i] = any_in_box(tree, grown(i), [&](uint32_t other) {
            return other != i && !lies_in(pieces, i, other) && !lies_in(pieces, other, i);
        });
    return meets;
}

}  // namespace

MeshSolids part_solids(const std::vector<MeshPiece>& pieces) {
    const std::vector<uint8_t> meets = bodies_that_meet(pieces);
    std::vector<uint32_t> body(pieces.size());  // of each piece its outer one
    std::vector<double> volume(pieces.size(), 0), area(pieces.size(), 0);
    for (uint32_t i = 0; i < pieces.size(); ++i) {
        body[i] = i;
        while (pieces[body[i]].depth % 2 != 0) body[i] = pieces[body[i]].container;
        volume[body[i]] += body[i] == i ? pieces[i].volume : -pieces[i].volume;
        area[body[i]] += pieces[i].area;
    }
    MeshSolids solids;
    std::vector<uint32_t> own(pieces.size(), none);  // numbers of the solids that begin with a piece
    uint32_t together = none;
    for (uint32_t i = 0; i < pieces.size(); ++i) {
        uint32_t& number = meets[body[i]] ? own[body[i]] : together;
        if (number == none) {
            number = static_cast<uint32_t>(solids.thickness.size());
            solids.thickness.push_back(INFINITY);
        }
        solids.of_piece.push_back(number);
        // Six times the volume over twice the area.
        double& thickness = solids.thickness[number];
        thickness = min_or_second(magnitude(volume[body[i]]) / (3 * area[body[i]]), thickness);
    }
    return solids;
}

}  // namespace cistula
