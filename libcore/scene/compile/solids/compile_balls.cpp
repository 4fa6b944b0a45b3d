#include "scene/compile/solids/compile_balls.h"

#include <algorithm>
#include <numeric>

#include <fmt/format.h>

#include "cistula/geometry/ball.h"
#include "scene/compile/lights/light_distance.h"
#include "scene/compile/scene_source.h"
#include "scene/compile/solids/compile_solids.h"
#include "scene/description/rotation.h"
#include "scene/trees/tree_build.h"

namespace cistula {
namespace {

using glm::dvec3;

/// Balls in the order of their places along a direction, across which grids have few.
class BallOrder {
  public:
    explicit BallOrder(const std::vector<PlacedBall>& balls) : order_(balls.size()), place_(balls.size()) {
        for (const PlacedBall& ball : balls) along_.push_back(dot(ball.center, dvec3(0.48, 0.6, 0.64)));
        std::iota(order_.begin(), order_.end(), 0u);
        std::stable_sort(order_.begin(), order_.end(), [&](uint32_t a, uint32_t b) { return along_[a] < along_[b]; });
        for (uint32_t i = 0; i < order_.size(); ++i) place_[order_[i]] = i;
    }
    /// Calls visit(other) for the earlier balls whose centers may lie within `range` of a ball's.
    template <class Visit>
    void for_each_near(uint32_t ball, double range, const Visit& visit) const {
        const auto look_at = [&](uint32_t at) {
            if (!(magnitude(along_[order_[at]] - along_[ball]) <= 2 * range)) return false;
            if (order_[at] < ball) visit(order_[at]);
            return true;
        };
        for (uint32_t at = place_[ball]; at-- > 0 && look_at(at);) {
        }
        for (uint32_t at = place_[ball] + 1; at < order_.size() && look_at(at); ++at) {
        }
    }

  private:
    std::vector<double> along_;
    std::vector<uint32_t> order_, place_;
};

/// The first ball of each ball's family: the earliest that is no other's kin and within `tolerance` of it.
std::vector<uint32_t> find_families(const std::vector<PlacedBall>& balls, double tolerance) {
    const BallOrder order(balls);
    std::vector<uint32_t> first(balls.size());
    for (uint32_t i = 0; i < balls.size(); ++i) {
        first[i] = i;
        order.for_each_near(i, tolerance, [&](uint32_t other) {
            if (other < first[i] && first[other] == other &&
                length(balls[other].center - balls[i].center) + magnitude(balls[other].radius - balls[i].radius) <=
                    tolerance)
                first[i] = other;
        });
    }
    return first;
}

/// Whether a ball's surface may come within `reach` of what is in a box.
bool is_near(const PlacedBall& ball, const Box& box, double reach) {
    double farthest = 0;
    for (const dvec3& corner : box.corners()) farthest = max_or_second(length(corner - ball.center), farthest);
    return distance_to_box(box, ball.center) <= ball.radius + reach && farthest >= ball.radius - reach;
}

/// Whether a ball is at most 16 u M beyond a plane.
template <class Real>
bool only_touches(const Ball<Real>& ball, const BallPlane<Real>& plane, Real extent) {
    const double off = dot(dvec3(plane.normal), dvec3(ball.center)) - double(plane.offset);
    return magnitude(off) >= double(ball.radius) - double(incidence<Real>) * double(extent);
}

/// Looks for the closed meshes and the flat sheets near balls.
template <class Real>
class NearBalls {
  public:
    NearBalls(CompiledScene<Real>& scene, const std::vector<Box>& boxes,
              const std::vector<std::optional<PlaneEquation>>& planes)
        : scene_(scene), boxes_(boxes), planes_(planes), solids_(uint32_t(scene.solids.size())) {
        const SceneView<Real> view = scene.view();
        std::vector<RTCBuildPrimitive> primitives;  // sheets by their numbers, then clusters of meshes
        cluster_boxes_.resize(scene.clusters.size());
        for (uint32_t i = 0; i < solids_; ++i)
            if (planes[i]) primitives.push_back(padded_primitive(boxes[i], reach(), i));
        for (uint32_t i = 0; i < scene.clusters.size(); ++i) {
            if (scene.solids[scene.clusters[i].solid].kind != SolidKind::mesh) continue;
            cluster_boxes_[i] = box_of(primitive_box(view, view.convex.size + i));
            primitives.push_back(padded_primitive(cluster_boxes_[i], 0, solids_ + i));
        }
        tree_ = build_tree(primitives, 0);
    }

    void find(const PlacedBall& placed, Ball<Real>& ball) {
        std::vector<uint32_t> near;
        for_each_in_box(tree_, placed.box(), [&](uint32_t i) {
            if (!is_near(placed, i < solids_ ? boxes_[i] : cluster_boxes_[i - solids_], reach())) return;
            if (i >= solids_)
                ball.near_meshes = 1;
            else if (const uint32_t plane = plane_of(i, *planes_[i]); plane != no_plane)
                near.push_back(plane);
        });
        std::sort(near.begin(), near.end());
        near.erase(std::unique(near.begin(), near.end()), near.end());
        const auto cut = std::stable_partition(near.begin(), near.end(), [&](uint32_t plane) {
            return only_touches(ball, scene_.ball_planes[plane], scene_.extent);
        });
        ball.first_plane = uint32_t(scene_.near_planes.size());
        ball.plane_count = uint32_t(near.size());
        ball.touched_count = uint32_t(cut - near.begin());
        scene_.near_planes.insert(scene_.near_planes.end(), near.begin(), near.end());
    }

  private:
    double reach() const { return 2 * double(incidence<Real>) * double(scene_.extent); }

    /// The number of a sheet's plane among the scene's ball_planes, or no_plane if there are too many.
    uint32_t plane_of(uint32_t sheet, const PlaneEquation& own) {
        Solid& solid = scene_.solids[sheet];
        if (solid.first_group != 0) return solid.first_group - 1;
        BallPlane<Real> plane{Vec3<Real>(own.normal), Real(own.offset), no_plane};
        if (!scene_.triangle_planes.empty()) plane.shared = scene_.triangle_planes[solid.first_triangle];
        if (plane.shared != no_plane) {
            plane.normal = scene_.shared_planes[plane.shared].normal;
            plane.offset = scene_.shared_planes[plane.shared].offset;
        }
        auto& planes = scene_.ball_planes;
        const auto known = std::find_if(planes.begin(), planes.end(),
                                        [&](const BallPlane<Real>& other) { return is_same(plane, other); });
        const auto number = uint32_t(known - planes.begin());
        if (number >= BallSides::most_planes) return no_plane;
        if (known == planes.end()) planes.push_back(plane);
        solid.first_group = number + 1;
        return number;
    }

    /// Whether two planes are one but for rounding, in either direction.
    bool is_same(const BallPlane<Real>& a, const BallPlane<Real>& b) const {
        if (a.shared != b.shared) return false;
        const Real sign = dot(a.normal, b.normal) > Real(0) ? Real(1) : Real(-1);
        const Real unit = 2 * RealTraits<Real>::unit;
        const Vec3<Real> turn = a.normal - sign * b.normal;
        return dot(turn, turn) <= unit * unit && magnitude(a.offset - sign * b.offset) <= unit * scene_.extent;
    }

    CompiledScene<Real>& scene_;
    const std::vector<Box>& boxes_;
    const std::vector<std::optional<PlaneEquation>>& planes_;
    const uint32_t solids_;
    std::vector<Box> cluster_boxes_;
    Tree tree_;
};

}  // namespace

PlacedBall::PlacedBall(const SphereObject& object, uint32_t number, const SceneNormalization& normalization)
    : solid(number),
      center(normalization.point(object.center)),
      radius(object.radius * normalization.factor),
      given(&object) {
    const Rotation rotation(object.rotation);
    for (int axis = 0; axis < 3; ++axis) {
        dvec3 unit(0);
        unit[axis] = 1;
        axes[size_t(axis)] = rotation(unit);
    }
}

double PlacedBall::distance(const dvec3& point) const {
    return magnitude(length(point - center) - radius);
}

double PlacedBall::apart(const PlacedBall& other) const {
    double largest = 0;
    for (const SphereObject* ball : {given, other.given}) {
        largest = max_or_second(ball->radius, largest);
        for (int axis = 0; axis < 3; ++axis) largest = max_or_second(magnitude(ball->center[axis]), largest);
    }
    const double distance =
        length(given->center - other.given->center) + magnitude(given->radius - other.given->radius);
    return distance > 2 * double(incidence<double>) * largest ? distance : 0;
}

std::optional<BallCoat> thinnest_coat(const SceneSource& source, const std::vector<PlacedBall>& balls,
                                      const SceneNormalization& normalization) {
    std::optional<BallCoat> thinnest;
    double range = double(incidence<float>) * normalization.extent;
    const BallOrder order(balls);
    for (uint32_t i = 0; i < balls.size(); ++i)
        order.for_each_near(i, range, [&](uint32_t other) {
            const double distance = balls[i].apart(balls[other]) * normalization.factor;
            if (distance <= 0 || distance > range || (thinnest && distance == range)) return;
            thinnest = {{balls[other].solid, balls[i].solid}, range = distance};
        });
    // Twice what double takes for one, as its coordinates are rounded.
    if (thinnest && range <= 2 * double(incidence<double>) * normalization.extent)
        throw scene_error(*source.description, source.solids[thinnest->solids[1]].place,
                          fmt::format("{:.1e} from {}: beside the scene's size double precision cannot hold that",
                                      range / normalization.factor, source.solids[thinnest->solids[0]].place),
                          "make them equal, or bring what is far away nearer");
    return thinnest;
}

template <class Real>
void add_balls(CompiledScene<Real>& scene, const std::vector<PlacedBall>& balls) {
    const std::vector<uint32_t> families = find_families(balls, double(incidence<Real>) * double(scene.extent));
    std::vector<uint32_t> members(balls.size());
    for (const uint32_t family : families) ++members[family];
    for (size_t i = 0; i < balls.size(); ++i) {
        const PlacedBall& first = balls[families[i]];
        Ball<Real> ball{};
        ball.center = Vec3<Real>(first.center);
        ball.radius = Real(first.radius);
        ball.family = families[i];
        ball.has_kin = members[families[i]] > 1;
        std::copy(balls[i].axes.begin(), balls[i].axes.end(), ball.axes);
        Solid& solid = scene.solids[balls[i].solid];
        solid = {};
        solid.kind = SolidKind::convex;
        solid.first_slab = uint32_t(scene.balls.size());
        solid.center = Vec3<float>(ball.center);
        const dvec3 off = dvec3(ball.center) - dvec3(solid.center);
        const double around = double(ball.radius) + length(off);
        solid.padded_square = rounded_up<float>(around * around) + sphere_padding;
        scene.balls.push_back(ball);
        scene.convex.push_back(balls[i].solid);
        scene.hulls[balls[i].solid] = {{first.center}, first.radius};
    }
    std::sort(scene.convex.begin(), scene.convex.end());
}

template <class Real>
void find_near_balls(CompiledScene<Real>& scene, const std::vector<PlacedBall>& balls, const std::vector<Box>& boxes,
                     const std::vector<std::optional<PlaneEquation>>& planes) {
    if (balls.empty()) return;
    NearBalls<Real> near(scene, boxes, planes);
    for (const PlacedBall& ball : balls) near.find(ball, scene.balls[scene.solids[ball.solid].first_slab]);
}

template void add_balls(CompiledScene<float>&, const std::vector<PlacedBall>&);
template void add_balls(CompiledScene<double>&, const std::vector<PlacedBall>&);
template void find_near_balls(CompiledScene<float>&, const std::vector<PlacedBall>&, const std::vector<Box>&,
                              const std::vector<std::optional<PlaneEquation>>&);
template void find_near_balls(CompiledScene<double>&, const std::vector<PlacedBall>&, const std::vector<Box>&,
                              const std::vector<std::optional<PlaneEquation>>&);

}  // namespace cistula
