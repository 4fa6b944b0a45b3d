#include "scene/compile/compile_lights.h"

#include <algorithm>

#include "cistula/numerics/vec.h"
#include "scene/description/light_group.h"

namespace cistula {
namespace {

using glm::dvec3;

template <class Real>
dvec3 rounded(const dvec3& v) {
    return dvec3(Vec3<Real>(v));
}

void add_edge_lights(std::vector<NormalizedLight>& lights, const SourceSolid& from, const ConvexSolid& solid,
                     int convex, const SceneNormalization& normalization, LightGroups& groups) {
    const SolidObject& object = *from.platonic;
    const EdgeLights& on_edges = object.edge_lights;
    if (on_edges.count == 0) return;
    const std::string group = groups.of_edges(on_edges, name_of(from));
    for (const auto& edge : platonic_shape(object.solid).edges) {
        const dvec3 &a = solid.vertices[edge.vertices[0]], &b = solid.vertices[edge.vertices[1]];
        for (int i = 0; i < on_edges.count; ++i) {
            const double s = (i + 1.0) / (on_edges.count + 1.0);
            lights.push_back({a + s * (b - a), on_edges.color, on_edges.glow.value_or(on_edges.color),
                              on_edges.radius * normalization.factor, on_edges.falloff, from.place, group, convex,
                              edge.faces});
        }
    }
}

template <class Real>
bool within(const ConvexSolid& solid, const dvec3& p, double tolerance) {
    return std::all_of(solid.planes.begin(), solid.planes.end(), [&](const PlanePair& planes) {
        const double n = dot(rounded<Real>(planes.normal), p);
        return n >= static_cast<Real>(planes.low) - tolerance && n <= static_cast<Real>(planes.high) + tolerance;
    });
}

}  // namespace

bool near_triangle(const std::array<dvec3, 3>& corner, const dvec3& p, double tolerance) {
    const dvec3 normal = cross(corner[1] - corner[0], corner[2] - corner[0]);
    const double size = length(normal);
    if (!(size > 0) || magnitude(dot(normal, p - corner[0])) > tolerance * size) return false;
    for (int e = 0; e < 3; ++e) {
        const dvec3 edge = corner[(e + 1) % 3] - corner[e];
        if (dot(cross(edge, p - corner[e]), normal) < -tolerance * length(edge) * size) return false;
    }
    return true;
}

std::vector<NormalizedLight> normalize_lights(const SceneSource& source, const SceneNormalization& normalization,
                                              const std::vector<ConvexSolid>& convex) {
    std::vector<NormalizedLight> lights;
    LightGroups groups(*source.description);
    const std::vector<LightDescription>& described = source.description->lights;
    for (size_t i = 0; i < described.size(); ++i) {
        const LightDescription& light = described[i];
        lights.push_back({normalization.point(light.position), light.color, light.glow.value_or(light.color),
                          light.radius * normalization.factor, light.falloff, light.place, groups.of_light(i)});
    }
    for (size_t i = 0; i < convex.size(); ++i) {
        const SourceSolid& solid = source.solids[convex[i].solid];
        if (!solid.platonic) continue;
        add_edge_lights(lights, solid, convex[i], static_cast<int>(i), normalization, groups);
    }
    // I / r^2 in scene units is I 4^scale / r^2 with r in the frame.
    for (NormalizedLight& light : lights)
        if (light.falloff) light.color *= normalization.factor * normalization.factor;
    return lights;
}

template <class Real>
void find_convex_incidents(const std::vector<NormalizedLight>& lights, const std::vector<ConvexSolid>& convex,
                           double extent, IncidentLists& incidents) {
    const double tolerance = static_cast<double>(incidence<Real>) * extent;
    const double reach = 4 * tolerance;  // farther than this outside a solid's box, no light can be incident
    for (size_t i = 0; i < lights.size(); ++i) {
        if (!lights[i].lights()) continue;
        const dvec3 p = rounded<Real>(lights[i].position);
        for (size_t k = 0; k < convex.size(); ++k) {
            const ConvexSolid& solid = convex[k];
            const bool own = lights[i].convex == static_cast<int>(k);
            if (!own &&
                (p.x < solid.box.low.x - reach || p.x > solid.box.high.x + reach || p.y < solid.box.low.y - reach ||
                 p.y > solid.box.high.y + reach || p.z < solid.box.low.z - reach || p.z > solid.box.high.z + reach))
                continue;
            const bool inside = within<Real>(solid, p, tolerance);
            for (uint32_t slab = 0; slab < solid.planes.size(); ++slab) {
                const PlanePair& planes = solid.planes[slab];
                const double n = dot(rounded<Real>(planes.normal), p);
                for (uint32_t side = 0; side < 2; ++side) {
                    const uint32_t face = 2 * slab + side;
                    const double h = static_cast<Real>(side ? planes.high : planes.low);
                    const bool by_place = inside && magnitude(n - h) <= tolerance;
                    const bool by_edge = own && (planes.face(lights[i].edge_faces[0]) == face ||
                                                 planes.face(lights[i].edge_faces[1]) == face);
                    if (by_place || by_edge) incidents[i].push_back({solid.solid, face});
                }
            }
        }
    }
}

template <class Real>
void find_triangle_incidents(const std::vector<NormalizedLight>& lights, const NormalizedMesh& mesh,
                             const Groups& groups, const Tree& tree, uint32_t solid, uint32_t first_triangle,
                             double extent, IncidentLists& incidents) {
    const double tolerance = static_cast<double>(incidence<Real>) * extent;
    for (size_t i = 0; i < lights.size(); ++i) {
        if (!lights[i].lights()) continue;
        const dvec3 p = rounded<Real>(lights[i].position);
        const size_t first = incidents[i].size();
        Box around;
        around.add(p - dvec3{8 * tolerance});
        around.add(p + dvec3{8 * tolerance});
        for_each_in_box(tree, around, [&](uint32_t group) {
            for (uint32_t k = groups.first[group]; k < groups.first[group + 1]; ++k)
                if (near_triangle(mesh.triangle(groups.order[k]), p, tolerance))
                    incidents[i].push_back({solid, first_triangle + groups.order[k]});
        });
        std::sort(incidents[i].begin() + static_cast<ptrdiff_t>(first), incidents[i].end(),
                  [](const Incident& a, const Incident& b) { return a.face < b.face; });
    }
}

std::string light_on_face(const SceneSource& source, const std::vector<NormalizedLight>& lights,
                          const IncidentLists& incidents) {
    for (size_t i = 0; i < lights.size(); ++i) {
        if (!lights[i].lights() || incidents[i].empty()) continue;
        if (lights[i].convex >= 0) return "the lights on the edges of " + lights[i].place + " lie on its faces";
        return "the light " + lights[i].place + " lies on a face of " + source.solids[incidents[i][0].solid].place;
    }
    return "";
}

#define CISTULA_INSTANTIATE(Real)                                                                                   \
    template void find_convex_incidents<Real>(const std::vector<NormalizedLight>&, const std::vector<ConvexSolid>&, \
                                              double, IncidentLists&);                                              \
    template void find_triangle_incidents<Real>(const std::vector<NormalizedLight>&, const NormalizedMesh&,         \
                                                const Groups&, const Tree&, uint32_t, uint32_t, double,             \
                                                IncidentLists&);
CISTULA_INSTANTIATE(float)
CISTULA_INSTANTIATE(double)
#undef CISTULA_INSTANTIATE

}  // namespace cistula
