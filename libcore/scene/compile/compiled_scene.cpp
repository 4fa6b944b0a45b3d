#include "scene/compile/compiled_scene.h"

#include <algorithm>

#include "base/default_rounding.h"
#include "scene/compile/solids/compile_solids.h"
#include "scene/trees/tree_build.h"

namespace cistula {
namespace {

using glm::dvec3;

// Planes as near to an edge hold it: far above rounding.
constexpr double edge_slack = 0x1p-30;

/// The box of a convex solid whose planes are pushed out by 64 u M, u that of float.
template <class Real>
Box convex_box(const SceneView<Real>& scene, const Solid& solid) {
    const double extent = static_cast<double>(scene.extent);
    const double push = 64 * 0x1p-24 * extent;
    std::vector<BodyPlane> planes;
    for (const SolidPlane& plane : solid_planes(scene, solid)) planes.push_back({plane.normal, plane.offset + push});
    Box box;
    for (const PlaneEdge& edge : edges_of(planes, edge_slack * extent))
        for (const dvec3& end : edge.ends) box.add(end);
    return box;
}

/// The box of a convex solid or a ball.
template <class Real>
Box solid_box(const SceneView<Real>& scene, const Solid& solid) {
    if (!is_ball(solid)) return convex_box(scene, solid);
    const dvec3 center(scene.balls[solid.first_slab].center);
    const dvec3 radius(double(scene.balls[solid.first_slab].radius));
    return {center - radius, center + radius};
}

template <class Real>
Box cluster_box(const Cluster<Real>& cluster) {
    Box box;
    for (uint32_t lane = 0; lane < cluster.count; ++lane)
        for (int c = 0; c < 3; ++c)
            box.add({cluster.corner[c][0][lane], cluster.corner[c][1][lane], cluster.corner[c][2][lane]});
    return box;
}

template <class Real>
RTCBuildPrimitive boxed_primitive(const SceneView<Real>& scene, uint32_t primitive) {
    const bool convex = primitive < scene.convex.size;
    const Box box = convex ? solid_box(scene, scene.solids[scene.convex[primitive]])
                           : cluster_box(scene.clusters[primitive - scene.convex.size]);
    return padded_primitive(box, 0x1p-18 * static_cast<double>(scene.extent), primitive);
}

}  // namespace

template <class Real>
SceneView<Real> CompiledScene<Real>::view() const {
    SceneView<Real> v;
    v.solids = span_of(solids);
    v.slabs = span_of(slabs);
    v.slab_groups = span_of(slab_groups);
    v.shared_planes = span_of(shared_planes);
    v.slab_planes = span_of(slab_planes);
    v.triangle_planes = span_of(triangle_planes);
    v.near_planes = span_of(near_planes);
    v.plane_solids = span_of(plane_solids);
    v.balls = span_of(balls);
    v.ball_planes = span_of(ball_planes);
    v.disks = span_of(disks);
    v.convex = span_of(convex);
    v.clusters = span_of(clusters);
    v.uvs = span_of(uvs);
    v.normals = span_of(normals);
    v.materials = span_of(materials);
    v.lights = span_of(lights);
    v.incidents = span_of(incidents);
    v.visible_lights = span_of(visible_lights);
    v.textures = span_of(textures);
    v.texels = span_of(texels);
    v.tree = span_of(tree);
    v.tree_items = span_of(tree_items);
    v.visible_light_tree = span_of(visible_light_tree);
    v.light_groups = span_of(light_groups);
    v.sky_stops = span_of(sky_stops);
    v.sky = sky;
    v.background = background;
    v.bound = bound;
    v.largest_bound = largest_component(bound);
    v.extent = extent;
    v.unseen_faces = unseen_faces;
    return v;
}

template <class Real>
size_t CompiledScene<Real>::memory() const {
    size_t outlined = bytes_of(hulls);
    for (const Hull& hull : hulls) outlined += bytes_of(hull.points);
    return outlined + bytes_of(solids) + bytes_of(slabs) + bytes_of(slab_groups) + bytes_of(convex) +
           bytes_of(shared_planes) + bytes_of(slab_planes) + bytes_of(triangle_planes) + bytes_of(near_planes) +
           bytes_of(plane_solids) + bytes_of(balls) + bytes_of(ball_planes) + bytes_of(disks) + bytes_of(clusters) +
           bytes_of(uvs) + bytes_of(normals) + bytes_of(materials) + bytes_of(lights) + bytes_of(incidents) +
           bytes_of(visible_lights) + bytes_of(textures) + bytes_of(texels) + bytes_of(tree) + bytes_of(tree_items) +
           bytes_of(visible_light_tree) + bytes_of(light_groups) + bytes_of(sky_stops);
}

template <class Real>
PaddedBox primitive_box(const SceneView<Real>& scene, uint32_t primitive) {
    const RTCBuildPrimitive p = boxed_primitive(scene, primitive);
    return {{p.lower_x, p.lower_y, p.lower_z}, {p.upper_x, p.upper_y, p.upper_z}};
}

template <class Real>
PrimitiveTree primitive_tree(const SceneView<Real>& scene, int quality) {
    return in_default_rounding([&]() -> PrimitiveTree {
        std::vector<RTCBuildPrimitive> primitives;
        primitives.reserve(scene.convex.size + scene.clusters.size);
        for (uint32_t i = 0; i < scene.convex.size + scene.clusters.size; ++i)
            primitives.push_back(boxed_primitive(scene, i));
        Tree tree = build_tree(primitives, quality);
        return {std::move(tree.nodes), std::move(tree.items)};
    });
}

template <class Real>
FacetTree<Real> facet_tree(const SceneView<Real>& scene, int quality) {
    return in_default_rounding([&] {
        const double pad = 0x1p-18 * static_cast<double>(scene.extent);
        std::vector<RTCBuildPrimitive> primitives;
        std::vector<Facet<Real>> facets;
        for (uint32_t i = 0; i < scene.convex.size; ++i) primitives.push_back(boxed_primitive(scene, i));
        for (uint32_t i = 0; i < scene.clusters.size; ++i) {
            const Cluster<Real>& cluster = scene.clusters[i];
            for (uint32_t lane = 0; lane < cluster.count; ++lane) {
                Facet<Real> facet{};
                Box box;
                for (int c = 0; c < 3; ++c) {
                    for (int axis = 0; axis < 3; ++axis) facet.corner[c][axis] = cluster.corner[c][axis][lane];
                    box.add({facet.corner[c][0], facet.corner[c][1], facet.corner[c][2]});
                }
                facet.solid = cluster.solid;
                facet.triangle = cluster.triangle[lane];
                facet.slot = i * uint32_t(cluster_lanes) + lane;
                primitives.push_back(padded_primitive(box, pad, scene.convex.size + uint32_t(facets.size())));
                facets.push_back(facet);
            }
        }
        Tree built = build_tree(primitives, quality);
        FacetTree<Real> tree;
        tree.nodes = std::move(built.nodes);
        tree.items = std::move(built.items);
        tree.facets.reserve(facets.size());
        for (uint32_t& item : tree.items) {
            if (item < scene.convex.size) continue;
            tree.facets.push_back(facets[item - scene.convex.size]);
            item = scene.convex.size + uint32_t(tree.facets.size()) - 1;
        }
        return tree;
    });
}

template <class Real>
void build_primitive_tree(CompiledScene<Real>& scene, int quality) {
    PrimitiveTree tree = primitive_tree(scene.view(), quality);
    scene.tree = std::move(tree.nodes);
    scene.tree_items = std::move(tree.items);
}

template struct CompiledScene<float>;
template struct CompiledScene<double>;
template PaddedBox primitive_box(const SceneView<float>&, uint32_t);
template PaddedBox primitive_box(const SceneView<double>&, uint32_t);
template FacetTree<float> facet_tree(const SceneView<float>&, int);
template FacetTree<double> facet_tree(const SceneView<double>&, int);
template PrimitiveTree primitive_tree(const SceneView<float>&, int);
template PrimitiveTree primitive_tree(const SceneView<double>&, int);
template void build_primitive_tree(CompiledScene<float>&, int);
template void build_primitive_tree(CompiledScene<double>&, int);

}  // namespace cistula
