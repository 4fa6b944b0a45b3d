#include "scene/compile/contacts/overlaps.h"

#include <algorithm>
#include <set>
#include <utility>

#include "base/box.h"
#include "base/default_rounding.h"
#include "cistula/traversal/bvh.h"
#include "scene/compile/compiled_scene.h"

namespace cistula {
namespace {

using glm::dvec3;

constexpr int lines_across = 8;              // in either direction
constexpr size_t most_near_pairs = 100'000;  // whose common boxes are looked through
constexpr double least_length = 64;  // u M: of a line's part in both bodies; those that touch may differ by less

template <class Real>
class OverlapSearch {
  public:
    explicit OverlapSearch(const CompiledScene<Real>& scene)
        : view_(scene.view()),
          tree_(primitive_tree(view_)),
          least_(least_length * double(RealTraits<Real>::unit) * double(scene.extent)) {
        view_.tree = span_of(tree_.nodes);
        view_.tree_items = span_of(tree_.items);
        for (uint32_t i = 0; i < view_.solids.size; ++i) {
            if (view_.solids[i].kind == SolidKind::sheet) continue;
            Box box;
            for (const Vec3<double>& p : scene.hulls[i].points) box.add(p);
            if (!box.empty()) bodies_.push_back({i, box});
        }
    }

    std::vector<Overlap> overlaps() {
        for_each_common_box([&](uint32_t a, uint32_t b, const Box& box) {
            if (!is_opaque(view_, a) && !is_opaque(view_, b))
                look_through(box, [&] { return found_.contains({a, b}); });
        });
        std::vector<Overlap> overlaps;
        for (const auto& [first, second] : found_) overlaps.push_back({first, second});
        return overlaps;
    }

  private:
    struct Body {
        uint32_t solid;
        Box box;
    };

    /// Calls visit(solid, other, box) for the boxes that those of two bodies have in common.
    template <class Visit>
    void for_each_common_box(const Visit& visit) const {
        size_t pairs = 0;
        for (size_t i = 0; i < bodies_.size(); ++i)
            for (size_t j = i + 1; j < bodies_.size(); ++j) {
                const Box &a = bodies_[i].box, &b = bodies_[j].box;
                Box common;
                bool meets = true;
                for (int axis = 0; axis < 3; ++axis) {
                    common.low[axis] = max_or_second(a.low[axis], b.low[axis]);
                    common.high[axis] = min_or_second(a.high[axis], b.high[axis]);
                    meets &= common.high[axis] - common.low[axis] > least_;
                }
                if (meets && ++pairs <= most_near_pairs) visit(bodies_[i].solid, bodies_[j].solid, common);
            }
    }

    /// Sends lines along the axes through a box until found() is true.
    template <class Found>
    void look_through(const Box& box, const Found& found) {
        for (int i = 0; i < 3 * lines_across * lines_across && !found(); ++i) {
            const int axis = i % 3;
            const int u = (axis + 1) % 3;
            const int v = (axis + 2) % 3;
            dvec3 start, direction(0);
            start[axis] = -1.25 * double(view_.extent);
            direction[axis] = 1;
            start[u] = inside(box, u, i / 3 % lines_across);
            start[v] = inside(box, v, i / 3 / lines_across);
            follow(start, direction);
        }
    }
    static double inside(const Box& box, int axis, int step) {
        return box.low[axis] + (step + 0.47) / lines_across * (box.high[axis] - box.low[axis]);
    }

    /// Adds all pairs that a straight line finds, and what it can list no more.
    void follow(const dvec3& start, const dvec3& direction) {
        Ray<Real> ray;
        ray.origin = Vec3<Real>(start);
        ray.direction = Vec3<Real>(direction);
        ray.accept_both_sides();
        for (;;) {
            const Hit<Real> hit = BvhIntersector<Real>{view_}.closest(ray);
            if (!hit.found()) return;
            if (double(hit.t) - double(ray.after.t) > least_) note(ray.media);
            const int change = media_change(key_kind(hit.key));
            if (change != 0 && !ray.media.add(key_solid(hit.key), change)) return;
            ray.after = {hit.t, hit.key};
        }
    }

    /// Adds the pairs of transparent bodies in a list.
    void note(const InteriorList& media) {
        media.for_each([&](uint32_t a, int count_a) {
            media.for_each([&](uint32_t b, int count_b) {
                if (a < b && count_a > 0 && count_b > 0 && !is_opaque(view_, a) && !is_opaque(view_, b))
                    found_.emplace(a, b);
            });
        });
    }

    SceneView<Real> view_;
    const PrimitiveTree tree_;
    const double least_;
    std::vector<Body> bodies_;
    std::set<std::pair<uint32_t, uint32_t>> found_;
};

}  // namespace

template <class Real>
std::vector<Overlap> find_overlaps(const CompiledScene<Real>& scene) {
    return in_default_rounding([&] { return OverlapSearch<Real>(scene).overlaps(); });
}

template std::vector<Overlap> find_overlaps(const CompiledScene<float>&);
template std::vector<Overlap> find_overlaps(const CompiledScene<double>&);

}  // namespace cistula
