#include "scene/compile/meshes/mesh_pieces.h"

#include <algorithm>

#include "cistula/numerics/vec.h"
#include "scene/compile/meshes/mesh_edges.h"
#include "scene/compile/meshes/piece_nesting.h"
#include "scene/description/mesh_source.h"

namespace cistula {
namespace {

using glm::dvec3;

constexpr double least_volume = 0x1p-30;  // of the sum of its terms' magnitudes; less may be rounding

/// Some of a mesh's triangles: their numbers in it, and their corners as edges are compared.
struct Selection {
    std::vector<uint32_t> source;
    std::vector<TriangleCorners> corners;
    MeshFaults faults;

    void add(uint32_t triangle, const TriangleCorners& at) {
        source.push_back(triangle);
        corners.push_back(at);
    }
};

/// A surface whose edges are paired, in pieces.
struct Shell {
    std::vector<uint8_t> turned;  // of each triangle
    std::vector<MeshPiece> pieces;
    bool one_sided = false;
};

class PieceSearch {
  public:
    PieceSearch(const MeshSource& mesh, StopSignal stop) : mesh_(mesh), stop_(stop), welded_(weld(mesh.vertices)) {}

    MeshPieces run() {
        bool sheet_found = false;
        MeshPieces sheet;
        for (const bool with_slivers : {false, true}) {
            stop_.check();
            const Selection all = select(with_slivers);
            if (with_slivers && all.source.size() == sliverless_) break;  // none would seal anything
            if (!with_slivers) sliverless_ = all.source.size();
            MeshPieces found;
            if (try_to_close(all, AtCrowdedEdges::none, found)) return found;
            stop_.check();
            const std::vector<uint8_t> apart = closed_apart(all);
            const bool any_apart = std::find(apart.begin(), apart.end(), 1) != apart.end();
            if (any_apart && try_to_close(without_doubles(all, apart), AtCrowdedEdges::pairs, found)) return found;
            const Selection once = without_doubles(all, std::vector<uint8_t>(all.source.size(), 0));
            if (try_to_close(once, AtCrowdedEdges::pairs, found)) return found;
            if (!sheet_found) sheet = sheet_of(once, found.faults), sheet_found = true;
            const bool doubles = once.source.size() < all.source.size();
            if (doubles && try_to_close(apart_from_others(all, apart), AtCrowdedEdges::pairs, found)) return found;
        }
        return sheet;
    }

  private:
    /// All triangles that have three corners and an area, or may do without one.
    Selection select(bool with_slivers) const {
        Selection all;
        const auto total = static_cast<uint32_t>(mesh_.triangles.size());
        all.source.reserve(total);
        all.corners.reserve(total);
        for (uint32_t i = 0; i < total; ++i) {
            const TriangleCorners& t = mesh_.triangles[i];
            const uint32_t a = welded_[t[0]];
            const uint32_t b = welded_[t[1]];
            const uint32_t c = welded_[t[2]];
            if (a == no_vertex || b == no_vertex || c == no_vertex)
                ++all.faults.not_finite;
            else if (a == b || b == c || c == a)
                ++all.faults.repeated_vertex;
            else if (!with_slivers && has_no_area(t))
                ++all.faults.zero_area;
            else
                all.add(i, {a, b, c});
        }
        return all;
    }

    bool has_no_area(const TriangleCorners& t) const {
        const dvec3& a = mesh_.vertices[t[0]];
        const dvec3 normal = cross(mesh_.vertices[t[1]] - a, mesh_.vertices[t[2]] - a);
        return normal.x == 0 && normal.y == 0 && normal.z == 0;
    }

    /// Marks the triangles that are closed without the others by the mesh's own numbers of vertices.
    std::vector<uint8_t> closed_apart(const Selection& all) const {
        std::vector<TriangleCorners> own;
        own.reserve(all.source.size());
        for (const uint32_t t : all.source) own.push_back(mesh_.triangles[t]);
        return closed_without_others(own, mesh_.vertices.size());
    }

    /// The triangles that are closed apart keep the mesh's own vertices, which then differ from all others'.
    Selection apart_from_others(const Selection& all, const std::vector<uint8_t>& apart) const {
        Selection selection;
        selection.faults = all.faults;
        for (size_t i = 0; i < all.source.size(); ++i) {
            TriangleCorners corners = all.corners[i];
            if (apart[i])
                for (size_t c = 0; c < 3; ++c)
                    corners[c] = mesh_.triangles[all.source[i]][c] + static_cast<uint32_t>(mesh_.vertices.size());
            selection.add(all.source[i], corners);
        }
        return selection;
    }

    /// Leaves out the triangles that are there more than once, but for those that are closed apart.
    Selection without_doubles(const Selection& all, const std::vector<uint8_t>& apart) const {
        std::vector<TriangleCorners> first, rest;
        for (size_t i = 0; i < all.source.size(); ++i) (apart[i] ? first : rest).push_back(all.corners[i]);
        first.insert(first.end(), rest.begin(), rest.end());
        const std::vector<uint8_t> doubled = doubled_triangles(first, mesh_.vertices.size());
        Selection once = apart_from_others(all, apart);
        const size_t apart_count = first.size() - rest.size();
        size_t number = apart_count;
        std::vector<uint8_t> leave(all.source.size(), 0);
        for (size_t i = 0; i < all.source.size(); ++i) leave[i] = !apart[i] && doubled[number++] ? 1 : 0;
        leave_out(once, leave);
        rest.clear();
        for (const TriangleCorners& corners : once.corners)
            if (corners[0] < mesh_.vertices.size()) rest.push_back(corners);
        const std::vector<uint8_t> crossed = crossed_halves(mesh_.vertices, rest);
        leave.clear();
        number = 0;
        for (const TriangleCorners& corners : once.corners)
            leave.push_back(corners[0] < mesh_.vertices.size() ? crossed[number++] : uint8_t(0));
        leave_out(once, leave);
        return once;
    }

    static void leave_out(Selection& selection, const std::vector<uint8_t>& leave) {
        size_t kept = 0;
        for (size_t i = 0; i < leave.size(); ++i) {
            if (leave[i]) continue;
            selection.source[kept] = selection.source[i];
            selection.corners[kept++] = selection.corners[i];
        }
        selection.faults.doubled += static_cast<uint32_t>(leave.size() - kept);
        selection.source.resize(kept);
        selection.corners.resize(kept);
    }

    /// Whether a selection surrounds a volume. Else `found` has the reasons.
    bool try_to_close(const Selection& selection, AtCrowdedEdges crowded, MeshPieces& found) const {
        found = {};
        found.faults = selection.faults;
        stop_.check();
        EdgePairs pairs = pair_edges(mesh_.vertices, selection.corners, crowded);
        found.faults.open_edges = pairs.open;
        found.faults.crowded_edges = pairs.crowded;
        if (!pairs.complete() || selection.source.empty()) return false;
        stop_.check();
        Shell surface = surface_of(selection, pairs.mate);
        found.faults.one_sided = surface.one_sided;
        if (surface.one_sided) return false;
        stop_.check();
        measure(selection, surface, found.faults);
        drop_copies(selection, surface, found.faults);
        for (const uint32_t t : pairs.tied)
            if (surface.turned[t] != surface.turned[pairs.tied[0]]) {
                found.faults.crowded_edges = 1;
                return false;
            }
        if (surface.pieces.empty()) return false;
        found.closed = true;
        stop_.check();
        arrange_bodies(selection, surface, found);
        if (crowded == AtCrowdedEdges::none && selection.source.size() == mesh_.triangles.size())
            found.edges.next = std::move(pairs.mate);
        return true;
    }

    MeshPieces sheet_of(const Selection& once, const MeshFaults& faults) const {
        MeshPieces sheet;
        sheet.source = once.source;
        sheet.faults = faults;
        sheet.faults.turned = sheet.faults.flat_pieces = 0;
        sheet.faults.doubled = once.faults.doubled;
        return sheet;
    }

    /// Follows the pairs from triangle to triangle, and turns all of a piece alike.
    static Shell surface_of(const Selection& selection, const std::vector<uint32_t>& mate) {
        const auto start = [&](uint32_t half_edge) { return selection.corners[half_edge / 3][half_edge % 3]; };
        const auto count = static_cast<uint32_t>(selection.source.size());
        constexpr uint32_t unknown = 0xffffffffu;
        std::vector<uint32_t> piece(count, unknown), found;
        Shell surface;
        surface.turned.assign(count, 0);
        for (uint32_t first = 0; first < count; ++first) {
            if (piece[first] != unknown) continue;
            const auto number = static_cast<uint32_t>(surface.pieces.size());
            piece[first] = number;
            found = {first};
            for (size_t i = 0; i < found.size(); ++i) {
                const uint32_t t = found[i];
                for (uint32_t h = 3 * t; h < 3 * t + 3; ++h) {
                    const uint32_t other = mate[h] / 3;
                    const bool alike = start(h) != start(mate[h]);  // they run through it in opposite directions
                    const auto wanted = static_cast<uint8_t>(alike ? surface.turned[t] : 1 - surface.turned[t]);
                    if (piece[other] == unknown) {
                        piece[other] = number;
                        surface.turned[other] = wanted;
                        found.push_back(other);
                    }
                    surface.one_sided |= surface.turned[other] != wanted;
                }
            }
            surface.pieces.emplace_back().triangles.reserve(found.size());
        }
        for (uint32_t t = 0; t < count; ++t) surface.pieces[piece[t]].triangles.push_back(t);
        return surface;
    }

    TriangleCorners corners(const Selection& selection, const Shell& surface, uint32_t t) const {
        TriangleCorners at = mesh_.triangles[selection.source[t]];
        if (surface.turned[t]) std::swap(at[1], at[2]);
        return at;
    }

    /// Turns pieces outward, and leaves out those without a volume.
    void measure(const Selection& selection, Shell& surface, MeshFaults& faults) const {
        for (MeshPiece& piece : surface.pieces) {
            const dvec3 origin = mesh_.vertices[mesh_.triangles[selection.source[piece.triangles[0]]][0]];
            double terms = 0;
            uint32_t turned = 0;
            for (const uint32_t t : piece.triangles) {
                const TriangleCorners at = corners(selection, surface, t);
                const dvec3 a = mesh_.vertices[at[0]];
                const dvec3 b = mesh_.vertices[at[1]];
                const dvec3 c = mesh_.vertices[at[2]];
                const double term = dot(a - origin, cross(b - origin, c - origin));
                piece.volume += term;
                terms += magnitude(term);
                piece.area += length(cross(b - a, c - a));
                for (const dvec3& p : {a, b, c}) piece.box.add(p);
                turned += surface.turned[t];
            }
            if (!(magnitude(piece.volume) > least_volume * terms)) {
                piece.volume = 0;
                continue;
            }
            faults.turned += std::min(turned, static_cast<uint32_t>(piece.triangles.size()) - turned);
            if (piece.volume < 0)
                for (const uint32_t t : piece.triangles) surface.turned[t] ^= 1;
            piece.volume = magnitude(piece.volume);
        }
        faults.flat_pieces = static_cast<uint32_t>(
            std::erase_if(surface.pieces, [](const MeshPiece& piece) { return piece.volume == 0; }));
    }

    /// Leaves out pieces with the same corners, area and volume as an earlier one.
    void drop_copies(const Selection& selection, Shell& surface, MeshFaults& faults) const {
        constexpr double rounding = 0x1p-18;
        std::vector<uint32_t> order;
        std::vector<std::vector<uint32_t>> vertices(surface.pieces.size());
        for (uint32_t i = 0; i < surface.pieces.size(); ++i) order.push_back(i);
        const auto box_before = [&](uint32_t a, uint32_t b) {
            const Box &p = surface.pieces[a].box, &q = surface.pieces[b].box;
            for (const auto& [x, y] : {std::pair{p.low, q.low}, std::pair{p.high, q.high}})
                for (int axis = 0; axis < 3; ++axis)
                    if (x[axis] != y[axis]) return x[axis] < y[axis];
            return false;
        };
        const auto corners_of = [&](uint32_t i) -> const std::vector<uint32_t>& {
            std::vector<uint32_t>& all = vertices[i];
            if (!all.empty()) return all;
            for (const uint32_t t : surface.pieces[i].triangles)
                for (const uint32_t corner : mesh_.triangles[selection.source[t]]) all.push_back(welded_[corner]);
            std::sort(all.begin(), all.end());
            all.erase(std::unique(all.begin(), all.end()), all.end());
            return all;
        };
        const auto equal = [&](uint32_t a, uint32_t b) {
            const MeshPiece &p = surface.pieces[a], &q = surface.pieces[b];
            const double reach = length(p.box.high - p.box.low);
            return magnitude(p.area - q.area) <= rounding * p.area &&
                   magnitude(p.volume - q.volume) <= rounding * p.area * reach && corners_of(a) == corners_of(b);
        };
        std::stable_sort(order.begin(), order.end(), box_before);
        std::vector<uint8_t> copy(surface.pieces.size(), 0);
        for (size_t i = 0; i < order.size(); ++i)
            for (size_t j = i + 1; j < order.size() && !box_before(order[i], order[j]); ++j)
                if (!copy[order[i]] && !copy[order[j]] && equal(order[i], order[j])) copy[order[j]] = 1;
        for (size_t i = 0; i < copy.size(); ++i)
            if (copy[i]) faults.doubled += static_cast<uint32_t>(surface.pieces[i].triangles.size());
        size_t kept = 0;
        for (size_t i = 0; i < copy.size(); ++i)
            if (!copy[i]) std::swap(surface.pieces[kept++], surface.pieces[i]);
        surface.pieces.resize(kept);
    }

    /// Nests the pieces, and gives each to its solid.
    void arrange_bodies(const Selection& selection, Shell& surface, MeshPieces& found) const {
        std::vector<TriangleCorners> outward(selection.source.size());
        for (uint32_t t = 0; t < outward.size(); ++t) outward[t] = corners(selection, surface, t);
        found.faults.passing = nest_pieces(mesh_.vertices, outward, surface.pieces, stop_);
        outward = {};
        for (const MeshPiece& piece : surface.pieces) {
            if (piece.depth != 0) continue;
            const auto turned = std::count_if(piece.triangles.begin(), piece.triangles.end(),
                                              [&](uint32_t t) { return surface.turned[t] != 0; });
            found.volume += 2 * turned > static_cast<ptrdiff_t>(piece.triangles.size()) ? -piece.volume : piece.volume;
        }
        const MeshSolids solids = part_solids(surface.pieces);
        constexpr uint32_t none = 0xffffffffu;
        std::vector<uint32_t> solid(selection.source.size(), none);
        for (size_t i = 0; i < surface.pieces.size(); ++i)
            for (const uint32_t t : surface.pieces[i].triangles) {
                solid[t] = solids.of_piece[i];
                surface.turned[t] ^= surface.pieces[i].depth % 2;
            }
        for (size_t t = 0; t < solid.size(); ++t) {
            if (solid[t] == none) continue;
            found.source.push_back(selection.source[t]);
            found.turned.push_back(surface.turned[t]);
            found.solid.push_back(solid[t]);
        }
        found.thickness = solids.thickness;
    }

    const MeshSource& mesh_;
    const StopSignal stop_;
    const std::vector<uint32_t> welded_;
    size_t sliverless_ = 0;
};

/// Adds "3 triangles of zero area" to a list, if the number is not 0.
void add_counted(std::string& text, uint32_t number, const std::string& one, const std::string& many) {
    if (number == 0) return;
    if (!text.empty()) text += " and ";
    text += std::to_string(number) + (number == 1 ? one : many);
}

}  // namespace

std::string MeshFaults::left_out() const {
    std::string text;
    const auto add = [&text](uint32_t number, const std::string& what) {
        add_counted(text, number, " triangle " + what, " triangles " + what);
    };
    add(repeated_vertex, "with a repeated vertex");
    add(not_finite, "with a vertex that is not finite");
    add(zero_area, "of zero area");
    add_counted(text, flat_pieces, " closed piece without a volume", " closed pieces without a volume");
    return text.empty() ? text : "left out " + text;
}

std::string MeshFaults::why_not_closed() const {
    std::string text;
    add_counted(text, open_edges, " open edge", " open edges");
    add_counted(text, crowded_edges, " edge of more than two faces", " edges of more than two faces");
    if (!text.empty()) return text;
    return one_sided ? "its two sides are one, as a Klein bottle's" : "no volume";
}

MeshPieces find_pieces(const MeshSource& mesh, StopSignal stop) {
    return PieceSearch(mesh, stop).run();
}

}  // namespace cistula
