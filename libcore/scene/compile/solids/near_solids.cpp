#include "scene/compile/solids/near_solids.h"

#include <algorithm>

#include <tbb/parallel_for.h>

#include "cistula/geometry/ball.h"
#include "scene/trees/tree_build.h"

namespace cistula {
namespace {

using glm::dvec3;

/// Maximum number of pairs of primitives of which is looked whether one is inside the other.
constexpr size_t most_pairs = 10'000'000;
/// Tolerance for solids in contact, far above that of surface events (surface_event.h).
constexpr double touching = 0x1p-17;

/// Whether two boxes are no farther apart than `reach` along any axis.
bool near(const Box& a, const Box& b, double reach) {
    for (int axis = 0; axis < 3; ++axis)
        if (!(a.low[axis] <= b.high[axis] + reach && b.low[axis] <= a.high[axis] + reach)) return false;
    return true;
}

/// What else is inside a convex solid.
template <class Real>
class Inside {
  public:
    /// `boxes`: of each primitive; `own`: the solid, by its place among convex ones.
    Inside(const SceneView<Real>& view, const std::vector<Box>& boxes, uint32_t own)
        : view_(view), boxes_(boxes), own_(own), ball_(ball_of(view.convex[own])) {}

    bool has(uint32_t primitive) const {
        if (primitive == own_ || !near(boxes_[own_], boxes_[primitive], 0)) return false;
        const bool convex = primitive < view_.convex.size;
        return !only_touches(convex ? view_.convex[primitive] : view_.clusters[primitive - view_.convex.size].solid) &&
               (!ball_ || distance_to_box(boxes_[primitive], dvec3(ball_->center)) <= double(ball_->radius));
    }
    bool has(const PlacedDisk& disk) const {
        const Box& box = boxes_[own_];
        const double reach = ball_ ? double(ball_->radius) : 0.5 * length(box.high - box.low);
        return !only_touches(disk.solid) && disk.distance(0.5 * (box.low + box.high)) <= reach + touching;
    }

  private:
    /// Whether the solid is a ball that at most touches another: a ball, or a flat sheet by its plane (docs/rules.md,
    /// 14, line 9).
    bool only_touches(uint32_t solid) const {
        if (!ball_) return false;
        if (const Ball<Real>* other = ball_of(solid))
            return length(dvec3(other->center) - dvec3(ball_->center)) >=
                   double(ball_->radius) + double(other->radius) - double(incidence<Real>) * double(view_.extent);
        const uint32_t* touched = view_.near_planes.data + ball_->first_plane;
        return is_sheet_near_ball(view_.solids[solid]) &&
               std::count(touched, touched + ball_->touched_count, view_.solids[solid].first_group - 1) != 0;
    }
    const Ball<Real>* ball_of(uint32_t solid) const {
        return is_ball(view_.solids[solid]) ? &view_.balls[view_.solids[solid].first_slab] : nullptr;
    }

    const SceneView<Real>& view_;
    const std::vector<Box>& boxes_;
    const uint32_t own_;
    const Ball<Real>* const ball_;
};

}  // namespace

template <class Real>
void find_touching_solids(CompiledScene<Real>& scene, const std::vector<Box>& boxes) {
    const auto may_share = [&](uint32_t i) { return scene.solids[i].kind != SolidKind::sheet && !boxes[i].empty(); };
    const auto count = static_cast<uint32_t>(scene.solids.size());
    std::vector<RTCBuildPrimitive> primitives;
    for (uint32_t i = 0; i < count; ++i)
        if (may_share(i)) primitives.push_back(padded_primitive(boxes[i], touching, i));
    const Tree tree = build_tree(primitives, 0);
    tbb::parallel_for(uint32_t(0), count, [&](uint32_t i) {
        if (may_share(i))
            scene.solids[i].may_touch = any_in_box(tree, padded(boxes[i], touching), [&](uint32_t other) {
                return other != i && near(boxes[i], boxes[other], touching);
            });
    });
}

template <class Real>
void find_isolated_solids(CompiledScene<Real>& scene, const std::vector<PlacedDisk>& disks) {
    const SceneView<Real> view = scene.view();
    const uint32_t primitives = view.convex.size + view.clusters.size;
    if (view.convex.empty() || size_t(view.convex.size) * primitives > most_pairs) return;
    std::vector<Box> boxes;
    for (uint32_t p = 0; p < primitives; ++p) boxes.push_back(box_of(primitive_box(view, p)));
    for (uint32_t a = 0; a < view.convex.size; ++a) {
        const Inside<Real> inside(view, boxes, a);
        bool isolated = true;
        for (const PlacedDisk& disk : disks) isolated = isolated && !inside.has(disk);
        for (uint32_t b = 0; b < primitives && isolated; ++b) isolated = !inside.has(b);
        scene.solids[view.convex[a]].isolated = isolated ? 1 : 0;
    }
}

template <class Real>
void find_unseen_faces(CompiledScene<Real>& scene) {
    scene.unseen_faces = std::any_of(scene.solids.begin(), scene.solids.end(), [&](const Solid& solid) {
        const Material<Real>& m = scene.materials[solid.material];
        const bool alone = solid.kind == SolidKind::convex ? solid.isolated : !solid.may_touch;
        return solid.kind != SolidKind::sheet && m.transparency == Transparency::whole && m.transmission > Real(0) &&
               m.transmission < Real(1) && (!alone || m.index == 1);
    });
}

template <class Real>
void find_crossed_bulges(CompiledScene<Real>& scene, const SceneSource& source, const SolidPlaces& places) {
    const auto count = static_cast<uint32_t>(scene.solids.size());
    tbb::parallel_for(uint32_t(0), count, [&](uint32_t i) {
        Solid& solid = scene.solids[i];
        if (!is_smooth(solid)) return;
        bool is_crossed = source.solids[i].in_parts;
        for (uint32_t other = 0; other < count && !is_crossed; ++other)
            is_crossed = other != i && near(places.boxes[i], places.boxes[other], places.bulges[i] + touching);
        solid.slab_count = is_crossed ? 1 : 0;
    });
}

template void find_touching_solids(CompiledScene<float>&, const std::vector<Box>&);
template void find_touching_solids(CompiledScene<double>&, const std::vector<Box>&);
template void find_isolated_solids(CompiledScene<float>&, const std::vector<PlacedDisk>&);
template void find_isolated_solids(CompiledScene<double>&, const std::vector<PlacedDisk>&);
template void find_unseen_faces(CompiledScene<float>&);
template void find_unseen_faces(CompiledScene<double>&);
template void find_crossed_bulges(CompiledScene<float>&, const SceneSource&, const SolidPlaces&);
template void find_crossed_bulges(CompiledScene<double>&, const SceneSource&, const SolidPlaces&);

}  // namespace cistula
