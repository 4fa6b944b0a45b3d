#include "scene/compile/scene_arena.h"

#include <cstdint>
#include <cstring>

namespace cistula {
namespace {

/// Calls visit(span) for every array of a scene.
template <class Real, class Visit>
void for_each_span(SceneView<Real>& view, const Visit& visit) {
    visit(view.solids);
    visit(view.slabs);
    visit(view.slab_groups);
    visit(view.shared_planes);
    visit(view.slab_planes);
    visit(view.triangle_planes);
    visit(view.near_planes);
    visit(view.plane_solids);
    visit(view.balls);
    visit(view.ball_planes);
    visit(view.disks);
    visit(view.convex);
    visit(view.clusters);
    visit(view.facets);
    visit(view.uvs);
    visit(view.normals);
    visit(view.materials);
    visit(view.lights);
    visit(view.incidents);
    visit(view.visible_lights);
    visit(view.textures);
    visit(view.texels);
    visit(view.tree);
    visit(view.tree_items);
    visit(view.visible_light_tree);
    visit(view.light_groups);
    visit(view.sky_stops);
}

}  // namespace

template <class Real>
SceneArena<Real>::SceneArena(const SceneView<Real>& view) : offsets_(view) {
    for_each_span(offsets_, [&]<class T>(Span<T>& span) {
        const size_t offset = (bytes_.size() + alignment - 1) / alignment * alignment;
        const size_t size = span.size * sizeof(T);
        bytes_.resize(offset + size);
        if (size != 0) std::memcpy(bytes_.data() + offset, span.data, size);
        span.data = reinterpret_cast<const T*>(offset);
    });
}

template <class Real>
SceneView<Real> SceneArena<Real>::at(const void* base) const {
    SceneView<Real> view = offsets_;
    for_each_span(view, [&]<class T>(Span<T>& span) {
        span.data =
            reinterpret_cast<const T*>(reinterpret_cast<uintptr_t>(base) + reinterpret_cast<uintptr_t>(span.data));
    });
    return view;
}

template class SceneArena<float>;
template class SceneArena<double>;

}  // namespace cistula
