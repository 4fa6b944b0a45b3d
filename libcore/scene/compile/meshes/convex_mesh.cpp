#include "scene/compile/solids/placed_bodies.h"

#include <algorithm>
#include <numeric>

#include "cistula/geometry/ray.h"
#include "cistula/lights/edge_lights.h"
#include "scene/compile/meshes/normalized_mesh.h"
#include "scene/description/mesh_source.h"

namespace cistula {
namespace {

using glm::dvec3;

// Faces are flat to within 2^-22 M, which is 4 u M of float, and 2^-9 of the body's thickness; rounding moves a plane
// by less than as much again. Where planes meet as bluntly as `least_lean` says, the solid then reaches at most 64 u M
// of float beyond the mesh, by which its box is grown.
constexpr double flat_in_extent = 0x1p-22;
constexpr double flat_in_thickness = 0x1p-9;
constexpr double joined = 2;           // times that, of a triangle's corners from the plane of a larger one: one face
constexpr double least_width = 0x1p8;  // times that: a body is as thick
constexpr double least_lean = 1.0 / 8;
constexpr int most_steps = 64;            // of the search for that direction
constexpr double least_corner = 0x1p-10;  // determinant of three normals that fixes a corner
constexpr double opposite = 0x1p-20;      // 1 + cosine: pairs of faces that may be parallel

/// A flat face: triangles in one plane.
struct HullFacet {
    dvec3 area{0};  // twice the area vector
    dvec3 normal;   // outward
    double offset;
    uint32_t first;                 // the lowest number of its triangles
    std::vector<uint32_t> corners;  // of all its triangles
    uint32_t plane = no_plane;      // the contact plane of one of them
};

class ConvexSearch {
  public:
    ConvexSearch(const MeshSource& mesh, const NormalizedMesh& placed, const Contacts& contacts, uint32_t solid,
                 double flat)
        : contacts_(contacts), flat_(flat) {
        solid_.solid = solid;
        const std::vector<uint32_t> welded = weld(mesh.vertices);
        std::vector<uint32_t> number(mesh.vertices.size(), no_vertex);
        for (TriangleCorners corners : mesh.triangles) {
            for (uint32_t& corner : corners) {
                uint32_t& known = number[welded[corner]];
                if (known == no_vertex) {
                    known = static_cast<uint32_t>(points_.size());
                    points_.push_back(placed.vertex(corner));
                }
                corner = known;
            }
            triangles_.push_back(corners);
        }
    }

    std::optional<ConvexSolid> run() {
        // Euler's formula, so that the surface is one sphere and covers the convex hull once.
        if (2 * points_.size() != triangles_.size() + 4) return std::nullopt;
        if (!find_facets() || !fit_facets()) return std::nullopt;
        pair_facets();
        if (solid_.planes.size() > most_slabs_of_edge_lights || !is_convex() || !find_corners()) return std::nullopt;
        for (const dvec3& p : points_) solid_.box.add(p);
        solid_.flatness = flat_;
        return std::move(solid_);
    }

  private:
    struct HalfSpace {
        dvec3 normal;
        double offset;
    };
    struct Range {
        double low = INFINITY, high = -INFINITY;

        double middle() const { return 0.5 * (low + high); }
        bool within(double width) const { return high - low <= width; }
    };

    dvec3 area_of(uint32_t triangle) const {
        const auto [a, b, c] = triangles_[triangle];
        return cross(points_[b] - points_[a], points_[c] - points_[a]);
    }

    Range range(const dvec3& normal, const std::vector<uint32_t>& corners) const {
        Range range;
        for (const uint32_t corner : corners) {
            const double off = dot(normal, points_[corner]);
            range.low = min_or_second(off, range.low);
            range.high = max_or_second(off, range.high);
        }
        return range;
    }

    bool lies_in(const HullFacet& facet, uint32_t triangle) const {
        for (const uint32_t corner : triangles_[triangle])
            if (magnitude(dot(facet.normal, points_[corner]) - facet.offset) > joined * flat_) return false;
        return dot(area_of(triangle), facet.normal) >= 0;
    }

    /// Sorts the triangles into faces, the largest first, so that slivers do not decide on planes.
    bool find_facets() {
        std::vector<uint32_t> order(triangles_.size());
        std::iota(order.begin(), order.end(), 0u);
        const auto square = [&](uint32_t t) { return dot(area_of(t), area_of(t)); };
        std::stable_sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) { return square(a) > square(b); });
        for (const uint32_t t : order) {
            auto facet =
                std::find_if(facets_.begin(), facets_.end(), [&](const HullFacet& f) { return lies_in(f, t); });
            if (facet == facets_.end()) {
                if (facets_.size() == 2 * most_slabs_of_edge_lights || !(square(t) > 0)) return false;
                const dvec3 normal = normalized(area_of(t));
                facets_.push_back({dvec3(0), normal, dot(normal, points_[triangles_[t][0]]), t, {}, no_plane});
                facet = facets_.end() - 1;
            }
            facet->area += area_of(t);
            facet->plane = std::min(facet->plane, contacts_.plane_of(solid_.solid, t));
            facet->first = std::min(facet->first, t);
            facet->corners.insert(facet->corners.end(), triangles_[t].begin(), triangles_[t].end());
        }
        std::sort(facets_.begin(), facets_.end(),
                  [](const HullFacet& a, const HullFacet& b) { return a.first < b.first; });
        return true;
    }

    bool fit_facets() {
        for (HullFacet& facet : facets_) {
            facet.normal = normalized(facet.area);
            const Range off = range(facet.normal, facet.corners);
            if (!off.within(2 * flat_)) return false;
            facet.offset = off.middle();
        }
        return true;
    }

    /// Makes slabs of parallel faces, and single planes of the others, in the order of their first triangles.
    void pair_facets() {
        std::vector<bool> taken(facets_.size(), false);
        for (size_t i = 0; i < facets_.size(); ++i) {
            if (taken[i]) continue;
            const HullFacet& facet = facets_[i];
            PlanePair pair{facet.normal, -INFINITY, facet.offset};
            uint32_t low = no_plane;
            uint32_t high = facet.plane;
            for (size_t j = i + 1; j < facets_.size() && pair.low == -INFINITY; ++j) {
                if (taken[j] || !make_slab(facet, facets_[j], pair)) continue;
                taken[j] = true;
                low = facets_[j].plane;
                if (!largest_is_positive(facet.normal)) std::swap(low, high);
            }
            solid_.planes.push_back(pair);
            solid_.face_planes.insert(solid_.face_planes.end(), {low, high});
        }
    }

    /// Makes a slab of two faces that are parallel, with a normal whose largest component is positive.
    bool make_slab(const HullFacet& facet, const HullFacet& other, PlanePair& pair) const {
        if (1 + dot(facet.normal, other.normal) > opposite) return false;
        const bool ahead = largest_is_positive(facet.normal);
        const HullFacet &above = ahead ? facet : other, &below = ahead ? other : facet;
        const dvec3 normal = normalized(above.area - below.area);
        const Range high = range(normal, above.corners);
        const Range low = range(normal, below.corners);
        if (!high.within(2 * flat_) || !low.within(2 * flat_)) return false;
        pair = {normal, low.middle(), high.middle()};
        return true;
    }

    static bool largest_is_positive(const dvec3& v) {
        int largest = 0;
        for (const int axis : {1, 2})
            if (magnitude(v[axis]) > magnitude(v[largest])) largest = axis;
        return v[largest] > 0;
    }

    /// Whether all vertices are inside all planes, and some well inside.
    bool is_convex() {
        for (const PlanePair& pair : solid_.planes) {
            half_spaces_.push_back({pair.normal, pair.high});
            if (pair.low != -INFINITY) half_spaces_.push_back({-pair.normal, -pair.low});
        }
        for (const HalfSpace& half : half_spaces_) {
            Range outside;
            for (const dvec3& p : points_) {
                const double off = dot(half.normal, p) - half.offset;
                outside.low = min_or_second(off, outside.low);
                outside.high = max_or_second(off, outside.high);
            }
            if (outside.high > flat_ || outside.low > -least_width * flat_) return false;
        }
        return true;
    }

    /// Collects the vertices that are corners of the planes. False if planes meet so sharply, or a corner is so
    /// shallow, that rounding would move it far.
    bool find_corners() {
        for (const dvec3& p : points_) {
            std::vector<dvec3> normals;
            for (const HalfSpace& half : half_spaces_)
                if (dot(half.normal, p) - half.offset >= -flat_) normals.push_back(half.normal);
            if (normals.empty() || !are_blunt(normals)) return false;
            if (normals.size() < 3) continue;  // on an edge or in a face
            if (!(largest_determinant(normals) >= least_corner)) return false;
            solid_.vertices.push_back(p);
        }
        return true;
    }

    /// Whether all normals have `least_lean` along some direction: that of the point of their convex hull nearest to
    /// the origin (Gilbert 1966).
    static bool are_blunt(const std::vector<dvec3>& normals) {
        dvec3 nearest = normals[0];
        for (int step = 0; step < most_steps; ++step) {
            const dvec3 least = *std::min_element(normals.begin(), normals.end(), [&](const dvec3& a, const dvec3& b) {
                return dot(a, nearest) < dot(b, nearest);
            });
            if (dot(least, nearest) >= least_lean * length(nearest)) return true;
            const dvec3 way = least - nearest;
            const double square = dot(way, way);
            if (!(square > 0)) return false;
            nearest += way * std::clamp(-dot(nearest, way) / square, 0.0, 1.0);
        }
        return false;
    }

    static double largest_determinant(const std::vector<dvec3>& normals) {
        double largest = 0;
        for (size_t i = 0; i < normals.size(); ++i)
            for (size_t j = 0; j < i; ++j)
                for (size_t k = 0; k < j; ++k)
                    largest = max_or_second(magnitude(dot(normals[i], cross(normals[j], normals[k]))), largest);
        return largest;
    }

    const Contacts& contacts_;
    const double flat_;
    std::vector<dvec3> points_;  // welded
    std::vector<TriangleCorners> triangles_;
    std::vector<HullFacet> facets_;
    std::vector<HalfSpace> half_spaces_;
    ConvexSolid solid_;
};

}  // namespace

std::optional<ConvexSolid> convex_mesh(const SceneSource& source, uint32_t number,
                                       const SceneNormalization& normalization, const Contacts& contacts) {
    const SourceSolid& solid = source.solids[number];
    if (!solid.is_mesh() || !solid.closed || solid.keep_triangles || !solid.normals.empty()) return std::nullopt;
    if (source.materials[solid.material].texture >= 0 || solid.mesh.triangles.size() > most_convex_triangles)
        return std::nullopt;
    const double thickness = 3 * solid.thickness * normalization.factor;
    const NormalizedMesh mesh(solid.mesh, normalization, contacts.solids[number].points, false);
    const double flat =
        max_or_second(min_or_second(flat_in_extent, flat_in_thickness * thickness / normalization.extent),
                      4 * RealTraits<double>::unit);
    return ConvexSearch(solid.mesh, mesh, contacts, number, flat * normalization.extent).run();
}

}  // namespace cistula
