// Compiles a description into the flat arrays that the shading code reads.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "base/box.h"
#include "base/error.h"
#include "cistula/model/scene_view.h"
#include "cistula/numerics/portable.h"
#include "cistula/numerics/vec.h"
#include "scene/compile/scene_names.h"
#include "scene/description/coordinate_rounding.h"
#include "scene/description/description.h"

namespace cistula {

/// All points within distance `reach` of the convex hull of `points`, in the frame of reference.
struct Hull {
    std::vector<Vec3<double>> points;
    double reach = 0;  // infinite: everything
};

/// The plane normal.x = offset.
struct PlaneEquation {
    glm::dvec3 normal;
    double offset;

    double distance(const glm::dvec3& point) const { return dot(normal, point) - offset; }
};

/// Whether a scene needs one effect. `because` names the material, object or light that requires it, or says that none
/// does.
struct EffectReason {
    uint32_t effect = 0;  // one bit of Effect
    bool needed = false;
    std::string because;
};

/// A scene in its frame of reference, in one precision. Owns the arrays that view() points to; immutable once compiled.
template <class Real>
struct CompiledScene {
    std::vector<Solid> solids;
    std::vector<Slab<Real>> slabs;
    std::vector<SlabGroup<Real>> slab_groups;
    std::vector<SharedPlane<Real>> shared_planes;  // with the next four: empty where no faces coincide
    std::vector<uint32_t> slab_planes, triangle_planes, near_planes, plane_solids;
    std::vector<Ball<Real>> balls;
    std::vector<BallPlane<Real>> ball_planes;
    std::vector<Disk<Real>> disks;
    std::vector<uint32_t> convex;
    std::vector<Cluster<Real>> clusters;
    std::vector<Vec2<Real>> uvs;
    std::vector<Vec3<Real>> normals;  // of smooth meshes
    std::vector<Material<Real>> materials;
    std::vector<Light<Real>> lights;
    std::vector<Incident> incidents;
    std::vector<VisibleLight<Real>> visible_lights;
    std::vector<Texture> textures;
    std::vector<Vec3<float>> texels;
    std::vector<TreeNode> tree;  // filled by build_primitive_tree only
    std::vector<uint32_t> tree_items;
    std::vector<LightNode> visible_light_tree;
    std::vector<uint32_t> light_groups;  // of each of lights
    std::vector<Hull> hulls;             // around everything visible
    std::vector<ContactReach> reaches;   // of each solid
    std::vector<PlaneEquation> disk_planes;
    std::vector<SkyStop> sky_stops;
    Sky sky;
    Vec3<Real> background, bound;
    Real extent = 1;
    bool unseen_faces = false;

    Vec3<double> center{0};  // of the frame: coordinates are (world - center) * 2^scale
    int scale = 0;
    int radiance_exponent = 0;                 // radiances are those of the scene * 2^-radiance_exponent
    uint32_t effects = 0;                      // exactly those that the scene requires (effects.h)
    std::vector<EffectReason> effect_reasons;  // one per effect: needed or not, and because of what
    FrameHashes hashes;                        // equal in both precisions
    std::vector<std::string> solid_names;      // a name per solid, for messages and the id layer
    std::shared_ptr<const LayerNames> layer_names = std::make_shared<const LayerNames>();
    std::vector<std::string> warnings;  // degenerate triangles left out, open meshes taken as sheets, ...

    SceneView<Real> view() const;
    size_t memory() const;  // bytes of all arrays
};

/// Loads a description's assets and compiles it. Throws Error with the place, and (interrupted).
template <class Real>
std::unique_ptr<CompiledScene<Real>> compile_scene(const SceneDescription& description, StopSignal stop = {});

/// The tree over primitives that bvh.h traverses (Embree's builder). quality: 0 quick, 1 the builder's best.
struct PrimitiveTree {
    std::vector<TreeNode> nodes;
    std::vector<uint32_t> items;
};
template <class Real>
PrimitiveTree primitive_tree(const SceneView<Real>& scene, int quality = 1);

/// The tree that devices traverse: over convex solids and single triangles, which are stored in leaf order.
template <class Real>
struct FacetTree : PrimitiveTree {
    std::vector<Facet<Real>> facets;

    /// Replaces the scene's tree by this one.
    void put_into(SceneView<Real>& scene) const {
        scene.facets = {facets.data(), static_cast<uint32_t>(facets.size())};
        scene.tree = {nodes.data(), static_cast<uint32_t>(nodes.size())};
        scene.tree_items = {items.data(), static_cast<uint32_t>(items.size())};
    }
};
template <class Real>
FacetTree<Real> facet_tree(const SceneView<Real>& scene, int quality = 1);

/// Sets the scene's tree to its primitive_tree.
template <class Real>
void build_primitive_tree(CompiledScene<Real>& scene, int quality = 1);

/// A primitive's bounding box in the frame, rounded outward and grown by 2^-18 M (docs/rules.md, 1).
struct PaddedBox {
    float low[3], high[3];
};
template <class Real>
PaddedBox primitive_box(const SceneView<Real>& scene, uint32_t primitive);
inline Box box_of(const PaddedBox& box) {
    return {{box.low[0], box.low[1], box.low[2]}, {box.high[0], box.high[1], box.high[2]}};
}

/// A vector's elements, which must outlive the span.
template <class T>
Span<T> span_of(const std::vector<T>& all) {
    return {all.data(), static_cast<uint32_t>(all.size())};
}

/// The bytes of the elements.
template <class T>
size_t bytes_of(const std::vector<T>& all) {
    return all.size() * sizeof(T);
}

}  // namespace cistula
