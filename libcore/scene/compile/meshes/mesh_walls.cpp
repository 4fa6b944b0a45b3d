#include <algorithm>
#include <atomic>
#include <bit>
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

namespace cistula {
namespace {

using glm::dvec3;
using Corners = std::array<dvec3, 3>;

constexpr size_t leaf_size = 8;        // triangles
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

Box box_around(const Corners& triangle) {
    Box box;
    for (const dvec3& p : triangle) box.add(p);
    return box;
}

class WallSearch {
  public:
    WallSearch(const SourceSolid& solid, const SceneNormalization& normalization, double least, double most)
        : solid_(solid), normalization_(normalization), least_(least), thinnest_(most), edges_(&solid.edges) {}

    double run() {
        const double most = thinnest_;
        sort();
        const auto leaves = uint32_t(bounds_.size() / 2);
        tbb::parallel_for(uint32_t(0), leaves, [&](uint32_t leaf) { bounds_[leaves + leaf] = bound(leaf); });
        for (uint32_t node = leaves; --node > 0;) {
            bounds_[node] = bounds_[2 * node];
            bounds_[node].places.add(bounds_[2 * node + 1].places);
            bounds_[node].normals.add(bounds_[2 * node + 1].normals);
        }
        // In an order without any, so that the thinnest place is seldom found by small steps.
        tbb::parallel_for(uint32_t(0), leaves, [&](uint32_t i) {
            const uint32_t leaf = (i * 2654435761u) % leaves;
            compare(leaf, leaf + leaves, 1);
        });
        return thinnest_ < most ? thinnest_.load() : INFINITY;
    }

  private:
    struct Bound {
        Box places, normals;
    };

    /// Puts triangles with an area in the order of a curve that fills space, those of a leaf of the tree together.
    void sort() {
        Box around;
        for (const TriangleCorners& t : solid_.mesh.triangles) around.add(solid_.mesh.vertices[t[0]]);
        const dvec3 size = around.high - around.low;
        std::vector<uint64_t> keys(solid_.mesh.triangles.size());
        tbb::parallel_for(size_t(0), keys.size(), [&](size_t i) {
            const dvec3 from_low = solid_.mesh.vertices[solid_.mesh.triangles[i][0]] - around.low;
            uint64_t key = 0;
            for (int axis = 0; axis < 3; ++axis) {
                const double share = from_low[axis] / size[axis];
                const auto cell = share > 0 && share <= 1 ? uint32_t(1023 * share) : 0u;
                for (uint32_t bit = 0; bit < 10; ++bit) key |= uint64_t(cell >> bit & 1) << (3 * bit + uint32_t(axis));
            }
            keys[i] = key << 32 | i;
        });
        tbb::parallel_sort(keys);
        order_.assign(keys.begin(), keys.end());
        normals_.resize(keys.size());
        bounds_.resize(2 * std::max<size_t>(1, std::bit_ceil(keys.size()) / leaf_size));
    }
    size_t first(size_t leaf) const { return leaf * order_.size() / (bounds_.size() / 2); }

    Bound bound(uint32_t leaf) {
        Bound bound;
        for (size_t i = first(leaf); i < first(leaf + 1); ++i) {
            const Corners c = corners(order_[i]);
            const dvec3 n = cross(c[1] - c[0], c[2] - c[0]);
            normals_[i] = is_finite(n) && dot(n, n) > 0 ? n / length(n) : dvec3(0);
            if (normals_[i] == dvec3(0)) continue;
            bound.places.add(box_around(c));
            bound.normals.add(normals_[i]);
        }
        return bound;
    }

    Corners corners(uint32_t triangle) const {
        Corners c;
        for (size_t i = 0; i < 3; ++i)
            c[i] = normalization_.point(solid_.mesh.vertices[solid_.mesh.triangles[triangle][i]]);
        return c;
    }

    /// Whether triangles with these bounds make no wall.
    bool apart(const Bound& a, const Bound& b) const {
        if (!touch(a.places, b.places, thinnest_ / 2)) return true;
        double least = 0;  // no cosine is less
        for (int axis = 0; axis < 3; ++axis) {
            const double low = a.normals.low[axis], high = a.normals.high[axis];
            least += min_or_second(min_or_second(low * b.normals.low[axis], low * b.normals.high[axis]),
                                   min_or_second(high * b.normals.low[axis], high * b.normals.high[axis]));
        }
        return solid_.closed && least > -least_facing;
    }

    /// Compares a leaf's triangles with the earlier ones under a node.
    void compare(uint32_t leaf, uint32_t own, uint32_t node) {
        if (apart(bounds_[own], bounds_[node])) return;
        if (2 * node < bounds_.size()) {
            compare(leaf, own, 2 * node);
            compare(leaf, own, 2 * node + 1);
        } else if (node <= own) {
            for (size_t i = first(leaf); i < first(leaf + 1); ++i)
                for (size_t k = first(node - (own - leaf)), end = first(node - (own - leaf) + 1); k < end && k < i; ++k)
                    compare(i, k);
        }
    }

    void compare(size_t a, size_t b) {
        const double facing = dot(normals_[a], normals_[b]);
        if (!((solid_.closed ? -facing : magnitude(facing)) > least_facing)) return;
        const Corners of_a = corners(order_[a]), of_b = corners(order_[b]);
        if (!touch(box_around(of_a), box_around(of_b), thinnest_ / 2)) return;
        if (std::find_first_of(of_a.begin(), of_a.end(), of_b.begin(), of_b.end()) != of_a.end()) return;
        const Approach approach(of_a, of_b);
        if (approach.distance <= least_ || !(approach.distance < thinnest_)) return;
        if (are_joined(order_[a], order_[b], approach)) return;
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
        faces_.assign(order_.size(), none);
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
    std::vector<uint32_t> order_;   // of triangles
    std::vector<dvec3> normals_;    // in that order; 0: without an area
    std::vector<Bound> bounds_;     // of the nodes of a full binary tree: 2 n and 2 n + 1 are under n, the root is 1
    std::once_flag linked_;
    tbb::spin_mutex mutex_;
};

}  // namespace

double thinnest_wall(const SourceSolid& solid, const SceneNormalization& normalization, double least, double most) {
    return WallSearch(solid, normalization, least, most).run();
}

}  // namespace cistula
