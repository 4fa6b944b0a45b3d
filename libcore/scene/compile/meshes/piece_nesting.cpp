#include "scene/compile/meshes/piece_nesting.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>
#include <numeric>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>

#include "cistula/numerics/vec.h"
#include "scene/trees/tree_build.h"

namespace cistula {
namespace {

using glm::dvec3;
__extension__ typedef __int128 Wide;

// Vertices are at even coordinates of a grid, points that are asked about at odd ones, so that none lies beside a
// vertex. Coordinates have 38 bits and determinants of three differences 120.
constexpr double grid_steps = 0x1p37;
constexpr double box_slack = 0x1p-20;  // of the mesh: by how much a contained piece's box may reach beyond

using GridPoint = std::array<int64_t, 3>;

dvec3 as_vector(const GridPoint& p) {
    return {static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])};
}

/// Whether an edge, seen along x, passes a point on its right: a property of the edge alone, so that its triangles
/// agree.
bool passes_right(const GridPoint& a, const GridPoint& b, const GridPoint& p) {
    if ((a[2] > p[2]) == (b[2] > p[2])) return false;
    const GridPoint &low = a[2] < b[2] ? a : b, &high = a[2] < b[2] ? b : a;
    return Wide(high[1] - low[1]) * (p[2] - low[2]) > Wide(p[1] - low[1]) * (high[2] - low[2]);
}

/// Whether a ray from a point along +x crosses a triangle.
bool crosses(const GridPoint& a, const GridPoint& b, const GridPoint& c, const GridPoint& p) {
    if (!(passes_right(a, b, p) ^ passes_right(b, c, p) ^ passes_right(c, a, p))) return false;
    const Wide by = b[1] - a[1];
    const Wide bz = b[2] - a[2];
    const Wide cy = c[1] - a[1];
    const Wide cz = c[2] - a[2];
    const Wide py = p[1] - a[1];
    const Wide pz = p[2] - a[2];
    const Wide det = by * cz - bz * cy;
    if (det == 0) return false;  // seen edge on
    const Wide ahead = (b[0] - a[0]) * (py * cz - pz * cy) + (c[0] - a[0]) * (by * pz - bz * py) - (p[0] - a[0]) * det;
    return det > 0 ? ahead > 0 : ahead < 0;
}

/// A piece's triangles on the grid, in a tree for rays along +x: node k has children 2 k and 2 k + 1, the leaves are
/// the last 2^levels nodes, and share the triangles evenly.
class RayTree {
  public:
    RayTree(const std::vector<GridPoint>& points, std::span<const TriangleCorners> triangles,
            std::vector<uint32_t> piece)
        : points_(points), triangles_(triangles), order_(std::move(piece)) {
        while (order_.size() >> levels_ > most_in_leaf) ++levels_;
        nodes_.resize(size_t(2) << levels_);
        build(1, 0, order_.size(), levels_);
    }

    /// Whether a point is inside the piece: the ray crosses an odd number of triangles.
    bool holds(const GridPoint& p) const {
        bool odd = false;
        size_t stack[64], top = 0;
        stack[top++] = 1;
        while (top > 0) {
            const size_t k = stack[--top];
            if (nodes_[k].is_missed_from(p)) continue;
            if (k >> levels_ == 0) {
                stack[top++] = 2 * k;
                stack[top++] = 2 * k + 1;
                continue;
            }
            const size_t leaf = k - (size_t(1) << levels_);
            for (size_t i = begin_of(leaf); i < begin_of(leaf + 1); ++i) {
                const TriangleCorners& t = triangles_[order_[i]];
                odd ^= crosses(points_[t[0]], points_[t[1]], points_[t[2]], p);
            }
        }
        return odd;
    }

  private:
    static constexpr size_t most_in_leaf = 8;
    static constexpr size_t least_parallel = 10'000;

    struct Node {
        // along y and z
        int64_t low[2] = {INT64_MAX, INT64_MAX};
        int64_t high[2] = {INT64_MIN, INT64_MIN};
        int64_t farthest = INT64_MIN;  // along x

        bool is_missed_from(const GridPoint& p) const {
            return p[1] < low[0] || p[1] > high[0] || p[2] < low[1] || p[2] > high[1] || p[0] > farthest;
        }
        void add(const GridPoint& p) {
            for (size_t axis = 0; axis < 2; ++axis) {
                low[axis] = std::min(low[axis], p[axis + 1]);
                high[axis] = std::max(high[axis], p[axis + 1]);
            }
            farthest = std::max(farthest, p[0]);
        }
    };

    size_t begin_of(size_t leaf) const { return order_.size() * leaf >> levels_; }

    void build(size_t k, size_t begin, size_t end, uint32_t level) {
        for (size_t i = begin; i < end; ++i)
            for (const uint32_t corner : triangles_[order_[i]]) nodes_[k].add(points_[corner]);
        if (level == 0) return;
        const Node& node = nodes_[k];
        const size_t axis = node.high[0] - node.low[0] > node.high[1] - node.low[1] ? 1 : 2;
        const auto key = [&](uint32_t t) {
            const TriangleCorners& c = triangles_[t];
            return points_[c[0]][axis] + points_[c[1]][axis] + points_[c[2]][axis];
        };
        const size_t first_right = ((2 * k + 1) << (level - 1)) - (size_t(1) << levels_);
        const size_t middle = begin_of(first_right);
        const auto at = [&](size_t i) { return order_.begin() + static_cast<ptrdiff_t>(i); };
        if (middle > begin && middle < end)
            std::nth_element(at(begin), at(middle), at(end), [&](uint32_t a, uint32_t b) { return key(a) < key(b); });
        const auto left = [&] { build(2 * k, begin, middle, level - 1); };
        const auto right = [&] { build(2 * k + 1, middle, end, level - 1); };
        if (end - begin < least_parallel)
            left(), right();
        else
            tbb::parallel_invoke(left, right);
    }

    const std::vector<GridPoint>& points_;
    std::span<const TriangleCorners> triangles_;
    std::vector<uint32_t> order_;
    std::vector<Node> nodes_;
    uint32_t levels_ = 0;
};

class Nesting {
  public:
    Nesting(std::span<const dvec3> vertices, std::span<const TriangleCorners> triangles, std::vector<MeshPiece>& pieces,
            StopSignal stop)
        : vertices_(vertices), triangles_(triangles), pieces_(pieces), stop_(stop) {
        for (const MeshPiece& piece : pieces)
            for (const dvec3& end : {piece.box.low, piece.box.high}) box_.add(end);
        size_ = largest_component(box_.high - box_.low);
    }

    uint32_t run() {
        find_candidates();
        build_trees();
        if (trees_.empty()) return 0;
        std::vector<uint8_t> passing(pieces_.size(), 0);
        const auto for_each_piece = [&](const auto& body) {
            tbb::parallel_for(tbb::blocked_range<uint32_t>(0, static_cast<uint32_t>(pieces_.size())),
                              [&](const auto& range) {
                                  stop_.check();
                                  for (uint32_t i = range.begin(); i != range.end(); ++i)
                                      if (!candidates_[i].empty()) body(i);
                              });
        };
        for_each_piece([&](uint32_t i) { passing[i] = find_container(i); });
        for_each_piece([&](uint32_t i) { passing[i] |= find_depth(i); });
        return static_cast<uint32_t>(std::count(passing.begin(), passing.end(), 1));
    }

  private:
    /// Points inside a piece, beside its triangles, found as they are asked for.
    struct InsidePoints {
        std::vector<uint32_t> beside;  // triangles that are not yet used
        std::vector<GridPoint> found;
    };

    /// Finds for each piece those of more volume whose box holds its own, the least first.
    void find_candidates() {
        candidates_.resize(pieces_.size());
        // In units of the mesh, which floats can hold.
        const auto scaled = [&](const Box& box) {
            return Box{(box.low - box_.low) / size_, (box.high - box_.low) / size_};
        };
        std::vector<RTCBuildPrimitive> primitives;
        for (uint32_t i = 0; i < pieces_.size(); ++i)
            primitives.push_back(padded_primitive(scaled(pieces_[i].box), 2 * box_slack, i));
        const Tree tree = build_tree(primitives, 0);
        tbb::parallel_for(
            tbb::blocked_range<uint32_t>(0, static_cast<uint32_t>(pieces_.size()), 64), [&](const auto& range) {
                for (uint32_t i = range.begin(); i != range.end(); ++i) {
                    const dvec3 corner = scaled(pieces_[i].box).low;
                    for_each_in_box(tree, {corner, corner}, [&](uint32_t other) {
                        if (pieces_[other].volume > pieces_[i].volume && box_holds(other, i))
                            candidates_[i].push_back(other);
                    });
                    std::sort(candidates_[i].begin(), candidates_[i].end(), [&](uint32_t a, uint32_t b) {
                        return pieces_[a].volume != pieces_[b].volume ? pieces_[a].volume < pieces_[b].volume : a < b;
                    });
                }
            });
    }

    bool box_holds(uint32_t outer, uint32_t inner) const {
        const Box &out = pieces_[outer].box, &in = pieces_[inner].box;
        for (int axis = 0; axis < 3; ++axis)
            if (in.low[axis] < out.low[axis] - box_slack * size_ || in.high[axis] > out.high[axis] + box_slack * size_)
                return false;
        return true;
    }

    /// Builds trees for all pieces that have a candidate or are one.
    void build_trees() {
        std::vector<uint8_t> wanted(pieces_.size(), 0);
        bool any = false;
        for (uint32_t i = 0; i < pieces_.size(); ++i)
            for (const uint32_t candidate : candidates_[i]) wanted[i] = wanted[candidate] = any = true;
        if (!any) return;
        points_.resize(vertices_.size());
        const double steps = grid_steps / size_;
        trees_.resize(pieces_.size());
        tbb::parallel_for(tbb::blocked_range<size_t>(0, points_.size(), 4096), [&](const auto& range) {
            for (size_t v = range.begin(); v != range.end(); ++v)
                for (int axis = 0; axis < 3; ++axis) {
                    const double at = (vertices_[v][axis] - box_.low[axis]) * steps;
                    points_[v][static_cast<size_t>(axis)] =
                        at >= 0 && at <= grid_steps ? 2 * std::llround(at) : 0;  // else no piece's vertex
                }
        });
        tbb::parallel_for(uint32_t(0), static_cast<uint32_t>(pieces_.size()), [&](uint32_t i) {
            stop_.check();
            if (wanted[i]) trees_[i] = std::make_unique<RayTree>(points_, triangles_, pieces_[i].triangles);
        });
    }

    /// A point inside a piece close to one of its triangles, by the piece's own tree.
    bool point_inside(uint32_t piece, uint32_t triangle, GridPoint& point) const {
        constexpr int most_halvings = 12;
        constexpr double nearest = 16;  // eight steps of the grid
        const TriangleCorners& t = triangles_[triangle];
        const dvec3 a = as_vector(points_[t[0]]);
        const dvec3 b = as_vector(points_[t[1]]);
        const dvec3 c = as_vector(points_[t[2]]);
        const dvec3 normal = cross(b - a, c - a);
        const double area = length(normal);
        if (!(area > 0)) return false;
        double height = area / (length(b - a) + length(c - b) + length(a - c)) / 8;
        for (int i = 0; i < most_halvings && height >= nearest; ++i, height /= 2) {
            const dvec3 at = (a + b + c) / 3.0 - normal * (height / area);
            for (int axis = 0; axis < 3; ++axis) point[static_cast<size_t>(axis)] = static_cast<int64_t>(at[axis]) | 1;
            if (trees_[piece]->holds(point)) return true;
        }
        return false;
    }

    /// A piece's largest triangle, and others up to 64 that take its place if no point beside it is inside.
    InsidePoints first_point(uint32_t piece) const {
        constexpr size_t most_tried = 64;
        const std::vector<uint32_t>& all = pieces_[piece].triangles;
        const auto square = [&](uint32_t t) {
            const auto& [a, b, c] = triangles_[t];
            const dvec3 normal = cross(vertices_[b] - vertices_[a], vertices_[c] - vertices_[a]);
            return dot(normal, normal);
        };
        uint32_t largest = all[0];
        double most = -1;
        for (const uint32_t t : all)
            if (const double of = square(t); of > most) most = of, largest = t;
        InsidePoints points;
        GridPoint point;
        for (size_t k = 0; k <= std::min(all.size(), most_tried) && points.found.empty(); ++k)
            if (point_inside(piece, k == 0 ? largest : all[k - 1], point)) points.found.push_back(point);
        if (points.found.empty()) return points;
        std::array<double, 6> extreme;
        extreme.fill(-INFINITY);
        points.beside.assign(6, all[0]);
        for (const uint32_t t : all)
            for (const uint32_t corner : triangles_[t])
                for (size_t k = 0; k < 6; ++k) {
                    const double at = vertices_[corner][static_cast<int>(k / 2)] * (k % 2 ? -1 : 1);
                    if (at > extreme[k]) extreme[k] = at, points.beside[k] = t;
                }
        for (size_t k = 0; k < 16; ++k) points.beside.push_back(all[k * all.size() / 16]);
        std::sort(points.beside.begin(), points.beside.end());
        points.beside.erase(std::unique(points.beside.begin(), points.beside.end()), points.beside.end());
        return points;
    }

    enum class Place { outside, inside, passing };

    /// Where a piece lies, by its points; adds those that have not been needed before.
    Place place_in(uint32_t other, uint32_t piece, InsidePoints& points) const {
        if (!trees_[other]->holds(points.found[0])) return Place::outside;
        GridPoint point;
        for (const uint32_t t : points.beside)
            if (point_inside(piece, t, point)) points.found.push_back(point);
        points.beside.clear();
        const bool all = std::all_of(points.found.begin(), points.found.end(),
                                     [&](const GridPoint& p) { return trees_[other]->holds(p); });
        return all ? Place::inside : Place::passing;
    }

    /// Finds the least piece that contains a piece. Returns whether it passes through any before.
    bool find_container(uint32_t piece) {
        InsidePoints points = first_point(piece);
        bool passing = false;
        if (points.found.empty()) candidates_[piece].clear();
        for (const uint32_t other : candidates_[piece]) {
            const Place place = place_in(other, piece, points);
            passing |= place == Place::passing;
            if (place != Place::inside) continue;
            pieces_[piece].container = other;
            break;
        }
        return passing;
    }

    /// Counts the pieces that contain a piece: its container, those that contain that, and others that are asked.
    bool find_depth(uint32_t piece) {
        uint32_t known = pieces_[piece].container;
        if (known == MeshPiece::no_piece) return false;
        const std::vector<uint32_t>& all = candidates_[piece];
        uint32_t depth = 0;
        bool passing = false;
        InsidePoints points;
        for (auto other = std::find(all.begin(), all.end(), known); other != all.end(); ++other) {
            while (known != MeshPiece::no_piece && pieces_[known].volume < pieces_[*other].volume)
                ++depth, known = pieces_[known].container;  // whose box does not hold the piece's by rounding
            if (*other == known) {
                ++depth;
                known = pieces_[known].container;
                continue;
            }
            if (points.found.empty()) points = first_point(piece);
            const Place place = place_in(*other, piece, points);
            depth += place == Place::inside;
            passing |= place == Place::passing;
        }
        for (; known != MeshPiece::no_piece; known = pieces_[known].container) ++depth;
        pieces_[piece].depth = depth;
        return passing;
    }

    std::span<const dvec3> vertices_;
    std::span<const TriangleCorners> triangles_;
    std::vector<MeshPiece>& pieces_;
    const StopSignal stop_;
    Box box_;
    double size_ = 0;
    std::vector<std::vector<uint32_t>> candidates_;
    std::vector<GridPoint> points_;
    std::vector<std::unique_ptr<RayTree>> trees_;
};

}  // namespace

uint32_t nest_pieces(std::span<const dvec3> vertices, std::span<const TriangleCorners> triangles,
                     std::vector<MeshPiece>& pieces, StopSignal stop) {
    return pieces.size() < 2 ? 0 : Nesting(vertices, triangles, pieces, stop).run();
}

}  // namespace cistula
