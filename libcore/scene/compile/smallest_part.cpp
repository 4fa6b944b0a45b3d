#include "scene/compile/smallest_part.h"

#include <vector>

#include "scene/compile/compile_lights.h"
#include "scene/compile/compile_solids.h"
#include "scene/compile/convex_mesh.h"
#include "scene/compile/mesh_size.h"
#include "scene/compile/scene_normalization.h"
#include "scene/description/platonic.h"

namespace cistula {
namespace {

using glm::dvec3;

constexpr double contact = 0x1p-20;  // 16 u in float, times M: what is nearer touches

bool apart(const Box& a, const Box& b, double range) {
    for (int axis = 0; axis < 3; ++axis)
        if (a.low[axis] > b.high[axis] + range || b.low[axis] > a.high[axis] + range) return true;
    return false;
}

class SmallestPartSearch {
  public:
    explicit SmallestPartSearch(const SceneSource& source)
        : source_(source),
          normalization_(find_normalization(source)),
          extent_(normalization_.extent),
          range_(least_share(Precision::single_) * extent_) {}

    SmallestPart run() {
        add_solids();
        add_lights();
        return smallest_;
    }

  private:
    template <class What>
    void add(double size, const What& what) {
        if (!(size / extent_ < smallest_.share)) return;
        smallest_ = {size / extent_, what()};
    }
    static std::string name(const SourceSolid& solid) {
        return solid.name.empty() ? solid.place : solid.place + ": " + solid.name;
    }

    void add_solids() {
        for (uint32_t i = 0; i < source_.solids.size(); ++i) {
            const SourceSolid& solid = source_.solids[i];
            if (!solid.platonic) {
                add_mesh(i);
                continue;
            }
            const double radius = solid.platonic->radius * normalization_.factor;
            add(platonic_shape(solid.platonic->solid).inradius * radius,
                [&] { return name(solid) + ": its inradius"; });
            convex_.push_back(convex_solid(*solid.platonic, i, normalization_));
        }
    }

    void add_mesh(uint32_t number) {
        const SourceSolid& solid = source_.solids[number];
        const MaterialDescription& material = source_.materials[solid.material];
        const MeshSize size = mesh_size(solid.mesh, normalization_, least_share(Precision::double_) * extent_);
        meshes_.push_back({&solid, size.box});
        if (size.triangles == 0) return;
        add(size.thickness, [&] { return name(solid) + (size.closed ? ": its thickness" : ": its half width"); });
        if (!(material.reflection > 0 || material.transmission > 0)) return;
        if (!(size.least_height / extent_ < smallest_.share) || has_planes(number)) return;
        add(size.least_height, [&] { return name(solid) + ": the least height of its triangles"; });
    }

    /// Whether a mesh is given by planes in single precision, so that rays leave no triangles.
    bool has_planes(uint32_t number) const {
        const double unit = RealTraits<float>::unit * extent_;
        return convex_mesh(source_, number, normalization_, unit).has_value();
    }

    /// Adds a distance unless it is a contact.
    template <class What>
    void add_distance(double distance, const What& what) {
        if (distance > contact * extent_) add(distance, what);
    }

    void add_lights() {
        for (const NormalizedLight& light : normalize_lights(source_, normalization_, convex_)) {
            if (light.radius > 0) add(light.radius, [&] { return light.place + ": a light's radius"; });
            if (!light.lights()) continue;
            const Box at{light.position, light.position};
            for (const ConvexSolid& solid : convex_) {
                if (apart(at, solid.box, range_)) continue;
                double beyond = -INFINITY;
                for (const PlanePair& plane : solid.planes) {
                    beyond = max_or_second(dot(plane.normal, light.position) - plane.high, beyond);
                    beyond = max_or_second(plane.low - dot(plane.normal, light.position), beyond);
                }
                add_distance(magnitude(beyond), [&] { return near(light, source_.solids[solid.solid]); });
            }
            for (const auto& [mesh, box] : meshes_) {
                if (apart(at, box, range_)) continue;
                const SourceSolid& solid = *mesh;
                add_distance(
                    distance_to_triangles(solid.mesh, normalization_, light.position, contact * extent_, range_),
                    [&] { return near(light, solid); });
            }
        }
    }
    static std::string near(const NormalizedLight& light, const SourceSolid& solid) {
        return light.place + ": a light's distance from a face of " + solid.place;
    }

    const SceneSource& source_;
    const SceneNormalization normalization_;
    const double extent_, range_;
    std::vector<ConvexSolid> convex_;
    std::vector<std::pair<const SourceSolid*, Box>> meshes_;
    SmallestPart smallest_;
};

}  // namespace

SmallestPart smallest_part(const SceneSource& source) {
    return SmallestPartSearch(source).run();
}

SmallestPart smallest_part(const SceneDescription& description) {
    return smallest_part(gather_scene(description));
}

}  // namespace cistula
