#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>
#include <unordered_set>

#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>
#include <tbb/spin_mutex.h>

#include "scene/compile/contacts/flat_faces.h"
#include "scene/compile/lights/light_distance.h"
#include "scene/compile/meshes/normalized_mesh.h"
#include "scene/compile/scene_source.h"
#include "scene/trees/tree_build.h"

namespace cistula {
namespace {

using glm::dvec3;
using Corners = std::array<dvec3, 3>;

constexpr double least_facing = 0.25;  // cosine of the normals of two sides of a wall
constexpr double nearby = 32;          // times the distance of two triangles: what joins them there makes them an edge
constexpr double flat = 0x1p-22;       // of M: corners of a flat face

/// Where two triangles are nearest; of crossing ones where their edges are.
struct Approach {
    double distance = INFINITY;
    dvec3 at{0};

    Approach(const Corners& a, const Corners& b) {
        for (size_t i = 0; i < 3; ++i) {
            add(distance_to_triangle(b, a[i]), a[i]);
            add(distance_to_triangle(a, b[i]), b[i]);
            for (size_t j = 0; j < 3; ++j) add_edges(a[i], a[(i + 1) % 3] - a[i], b[j], b[(j + 1) % 3] - b[j]);
        }
    }

  private:
    void add(double other, const dvec3& place) {
        if (other < distance) distance = other, at = place;
    }
    /// Adds what lies within both edges; their ends are corners.
    void add_edges(const dvec3& p, const dvec3& along, const dvec3& q, const dvec3& other) {
        const dvec3 n = cross(along, other);
        const double square = dot(n, n);
        const double s = dot(cross(q - p, other), n);
        const double t = dot(cross(q - p, along), n);
        if (square > 0 && s >= 0 && s <= square && t >= 0 && t <= square)
            add(magnitude(dot(q - p, n)) / square_root(square), p + (s / square) * along);
    }
};

class WallSearch {
  public:
    WallSearch(const SourceSolid& solid, const SceneNormalization& normalization, double least, double most)
        : solid_(solid),
          normalization_(normalization),
          least_(least),
          thinnest_(most),
          edges_(&solid.edges),
          normals_(solid.mesh.triangles.size(), dvec3(0)) {}

    double run() {
        const double most = thinnest_;
        const auto count = uint32_t(normals_.size());
        std::vector<RTCBuildPrimitive> primitives(count);
        tbb::parallel_for(uint32_t(0), count, [&](uint32_t i) {
            const Corners c = corners(i);
            const dvec3 n = cross(c[1] - c[0], c[2] - c[0]);
            if (is_finite(n) && dot(n, n) > 0) normals_[i] = n / length(n);
            primitives[i] = padded_primitive(box_of(c), 0, i);
        });
        std::erase_if(primitives, [&](const RTCBuildPrimitive& p) { return normals_[p.primID] == dvec3(0); });
        const Tree tree = build_tree(primitives, 0);
        // In an order without any, so that the thinnest place is seldom found by small steps.
        tbb::parallel_for(uint32_t(0), count, [&](uint32_t i) {
            const auto own = uint32_t(uint64_t(i) * 2654435761u % count);
            if (normals_[own] == dvec3(0)) return;
            for_each_in_box(tree, padded(box_of(corners(own)), thinnest_), [&](uint32_t other) {
                if (other < own) compare(own, other);
            });
        });
        return thinnest_ < most ? thinnest_.load() : INFINITY;
    }

  private:
    Corners corners(uint32_t triangle) const {
        Corners c;
        for (size_t i = 0; i < 3; ++i)
            c[i] = normalization_.point(solid_.mesh.vertices[solid_.mesh.triangles[triangle][i]]);
        return c;
    }

    void compare(uint32_t a, uint32_t b) {
        const double facing = dot(normals_[a], normals_[b]);
        if (!((solid_.closed ? -facing : magnitude(facing)) > least_facing)) return;
        const Corners of_a = corners(a), of_b = corners(b);
        if (std::find_first_of(of_a.begin(), of_a.end(), of_b.begin(), of_b.end()) != of_a.end()) return;
        const Approach approach(of_a, of_b);
        if (approach.distance <= least_ || !(approach.distance < thinnest_)) return;
        if (are_joined(a, b, approach)) return;
        const tbb::spin_mutex::scoped_lock lock(mutex_);
        thinnest_ = min_or_second(approach.distance, thinnest_.load());
    }

    /// Whether two triangles belong to one flat face or to two with a common edge, or are joined by triangles around
    /// the place where they are nearest.
    bool are_joined(uint32_t from, uint32_t to, const Approach& approach) {
        std::call_once(linked_, [this] { link(); });
        if (faces_[from] == faces_[to] || std::binary_search(joints_.begin(), joints_.end(), joint(from, to)))
            return true;
        std::vector<uint32_t> found{from};
        std::unordered_set<uint32_t> known{from};
        for (size_t i = 0; i < found.size() && !known.contains(to); ++i)
            for_each_neighbor(found[i], [&](uint32_t next) {
                if (known.insert(next).second &&
                    distance_to_triangle(corners(next), approach.at) <= nearby * approach.distance)
                    found.push_back(next);
            });
        return known.contains(to);
    }

    template <class Visit>
    void for_each_neighbor(uint32_t triangle, const Visit& visit) const {
        for (uint32_t h = 3 * triangle; h < 3 * triangle + 3; ++h)
            for (uint32_t next = edges_->next[h]; next != h; next = edges_->next[next]) visit(next / 3);
    }
    uint64_t joint(uint32_t a, uint32_t b) const {
        return uint64_t(std::min(faces_[a], faces_[b])) << 32 | std::max(faces_[a], faces_[b]);
    }

    /// Finds flat faces and where they meet.
    void link() {
        if (edges_->next.empty()) edges_ = &(own_edges_ = link_edges(solid_.mesh));
        constexpr uint32_t none = 0xffffffffu;
        faces_.assign(normals_.size(), none);
        for (uint32_t first = 0; first < faces_.size(); ++first) {
            if (faces_[first] != none) continue;
            faces_[first] = first;
            std::vector<uint32_t> found{first};
            for (size_t i = 0; i < found.size(); ++i)
                for_each_neighbor(found[i], [&](uint32_t next) {
                    if (faces_[next] != none || !lies_in_plane(next, first)) return;
                    faces_[next] = first;
                    found.push_back(next);
                });
        }
        for (uint32_t i = 0; i < faces_.size(); ++i)
            for_each_neighbor(i, [&](uint32_t next) { joints_.push_back(joint(i, next)); });
        tbb::parallel_sort(joints_);
    }

    bool lies_in_plane(uint32_t triangle, uint32_t face) const {
        const Corners c = corners(face);
        const dvec3 n = cross(c[1] - c[0], c[2] - c[0]);
        for (const dvec3& p : corners(triangle))
            if (!(magnitude(dot(p - c[0], n)) < flat * normalization_.extent * length(n))) return false;
        return true;
    }

    const SourceSolid& solid_;
    const SceneNormalization& normalization_;
    const double least_;
    std::atomic<double> thinnest_;
    const MeshEdges* edges_;
    MeshEdges own_edges_;
    std::vector<uint32_t> faces_;   // of each triangle the first one of its flat face
    std::vector<uint64_t> joints_;  // two faces with a common edge, ascending
    std::vector<dvec3> normals_;    // of triangles; 0: without an area
    std::once_flag linked_;
    tbb::spin_mutex mutex_;
};

}  // namespace

double thinnest_wall(const SourceSolid& solid, const SceneNormalization& normalization, double least, double most) {
    return WallSearch(solid, normalization, least, most).run();
}

}  // namespace cistula
