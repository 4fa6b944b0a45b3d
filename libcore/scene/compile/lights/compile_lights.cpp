#include "scene/compile/lights/compile_lights.h"

#include <algorithm>

#include "cistula/numerics/vec.h"
#include "scene/description/light_group.h"

namespace cistula {
namespace {

using glm::dvec3;

void add_edge_lights(std::vector<NormalizedLight>& lights, const SourceSolid& from, const ConvexSolid& solid,
                     int convex, const SceneNormalization& normalization, LightGroups& groups) {
    const SolidObject& object = *from.polyhedron;
    const EdgeLights& on_edges = object.edge_lights;
    if (on_edges.count == 0) return;
    const std::string group = groups.of_edges(on_edges, name_of(from));
    for (const auto& edge : polyhedron_of(object).edges) {
        const dvec3 &a = solid.vertices[edge.vertices[0]], &b = solid.vertices[edge.vertices[1]];
        for (int i = 0; i < on_edges.count; ++i) {
            const double s = (i + 1.0) / (on_edges.count + 1.0);
            lights.push_back({a + s * (b - a), dvec3(0), on_edges.color, on_edges.glow.value_or(on_edges.color),
                              on_edges.radius * normalization.factor, on_edges.shown(), on_edges.glow.has_value(),
                              on_edges.falloff, from.place, group, convex, edge.faces});
        }
    }
}

bool within(const ConvexSolid& solid, const dvec3& p, double tolerance) {
    return std::all_of(solid.planes.begin(), solid.planes.end(), [&](const PlanePair& planes) {
        const double n = dot(planes.normal, p);
        return n >= planes.low - tolerance && n <= planes.high + tolerance;
    });
}

/// The sides of a convex solid's slabs on which a light lies. `own`: it is one of the solid's edge lights.
void add_faces(const NormalizedLight& light, const ConvexSolid& solid, bool own, const ContactReach& reach,
               double least, std::vector<LightFace>& faces) {
    const bool inside = within(solid, light.position, max_or_second(largest_tolerance(reach, light), least));
    for (uint32_t face = 0; face < 2 * solid.planes.size(); ++face) {
        const PlanePair& pair = solid.planes[face / 2];
        const PlaneEquation plane{pair.normal, face % 2 == 1 ? pair.high : pair.low};
        if (plane.offset == -INFINITY) continue;
        const double range =
            max_or_second(point_tolerance(reach, plane, light.position, light.half_unit, solid.box), least);
        const bool by_place = inside && magnitude(plane.distance(light.position)) <= range;
        const bool by_edge = own && (light.edge_faces[0] == face || light.edge_faces[1] == face);
        if (by_place || by_edge) faces.push_back({{solid.solid, face}, plane});
    }
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
        const dvec3 half_unit = coordinate_rounding({&light.position, 1}).half_unit * normalization.factor;
        lights.push_back({normalization.point(light.position), half_unit, light.color, light.glow.value_or(light.color),
                          light.radius * normalization.factor, light.shown(), light.glow.has_value(), light.falloff,
                          light.place, groups.of_light(i)});
    }
    for (size_t i = 0; i < convex.size(); ++i) {
        const SourceSolid& solid = source.solids[convex[i].solid];
        if (!solid.polyhedron) continue;
        add_edge_lights(lights, solid, convex[i], static_cast<int>(i), normalization, groups);
    }
    // I / r^2 in scene units is I 4^scale / r^2 with r in the frame.
    for (NormalizedLight& light : lights)
        if (light.falloff) light.color *= normalization.factor * normalization.factor;
    return lights;
}

double point_tolerance(const ContactReach& reach, const PlaneEquation& plane, const dvec3& point,
                       const dvec3& half_unit, const Box& box) {
    double terms = magnitude(plane.offset);
    for (int axis = 0; axis < 3; ++axis) {
        const double size = max_or_second(magnitude(box.low[axis]), magnitude(box.high[axis]));
        terms += magnitude(plane.normal[axis]) * max_or_second(magnitude(point[axis]), size);
    }
    const double written =
        reach.given ? reach.own
                    : rounding_along(plane.normal, reach.rounding.half_unit) + rounding_along(plane.normal, half_unit);
    return max_or_second(min_or_second(written, reach.most), 16 * RealTraits<double>::unit * terms);
}

double largest_tolerance(const ContactReach& reach, const NormalizedLight& light) {
    const double written = reach.given ? reach.own : length(reach.rounding.half_unit) + length(light.half_unit);
    return min_or_second(written, reach.most) + 0x1p-40;  // which is more than rounding in double
}

void find_convex_incidents(const std::vector<NormalizedLight>& lights, const PlacedBodies& bodies, double least,
                           LightFaces& faces) {
    for (size_t i = 0; i < lights.size(); ++i) {
        if (!lights[i].lights()) continue;
        const dvec3& p = lights[i].position;
        for (size_t k = 0; k < bodies.convex.size(); ++k) {
            const ConvexSolid& solid = bodies.convex[k];
            const ContactReach& reach = bodies.contacts.solids[solid.solid].reach;
            const Box box = padded(solid.box, 4 * max_or_second(largest_tolerance(reach, lights[i]), least));
            const bool own = lights[i].convex == static_cast<int>(k);
            const bool apart = p.x < box.low.x || p.x > box.high.x || p.y < box.low.y || p.y > box.high.y ||
                               p.z < box.low.z || p.z > box.high.z;
            if (own || !apart) add_faces(lights[i], solid, own, reach, least, faces[i]);
        }
    }
}

void find_disk_incidents(const std::vector<NormalizedLight>& lights, const PlacedBodies& bodies,
                         const std::vector<Solid>& solids, double least, LightFaces& faces) {
    for (size_t i = 0; i < lights.size(); ++i)
        for (const PlacedDisk& disk : bodies.disks) {
            if (!lights[i].lights()) break;
            const double range = point_tolerance(bodies.contacts.solids[disk.solid].reach, disk.equation,
                                                 lights[i].position, lights[i].half_unit, bodies.sizes[disk.solid].box);
            if (disk.distance(lights[i].position) <= max_or_second(range, least))
                faces[i].push_back({{disk.solid, solids[disk.solid].first_triangle}, disk.equation});
        }
}

void find_triangle_incidents(const std::vector<NormalizedLight>& lights, const NormalizedMesh& mesh,
                             const Groups& groups, const Tree& tree, uint32_t solid, uint32_t first_triangle,
                             const ContactReach& reach, double least, LightFaces& faces) {
    for (size_t i = 0; i < lights.size(); ++i) {
        if (!lights[i].lights()) continue;
        const dvec3& p = lights[i].position;
        const double most = max_or_second(largest_tolerance(reach, lights[i]), least);
        Box around;
        around.add(p);
        for_each_in_box(tree, padded(around, 8 * most), [&](uint32_t group) {
            for (uint32_t k = groups.first[group]; k < groups.first[group + 1]; ++k) {
                const auto corner = mesh.triangle(groups.order[k]);
                if (!near_triangle(corner, p, most)) continue;
                const dvec3 normal = normalized(cross(corner[1] - corner[0], corner[2] - corner[0]));
                const PlaneEquation plane{normal, dot(normal, corner[0])};
                Box box;
                for (const dvec3& c : corner) box.add(c);
                const double range = point_tolerance(reach, plane, p, lights[i].half_unit, box);
                if (magnitude(plane.distance(p)) <= max_or_second(range, least))
                    faces[i].push_back({{solid, first_triangle + groups.order[k]}, plane});
            }
        });
    }
}

std::vector<bool> settle_lights(std::vector<NormalizedLight>& lights, const LightFaces& faces, double rounding) {
    std::vector<bool> moved(lights.size(), false);
    for (size_t i = 0; i < lights.size(); ++i) {
        std::vector<PlaneEquation> planes;
        for (const LightFace& face : faces[i]) {
            planes.push_back(face.plane);
            if (planes.size() > 3 || !nearest_on(planes, lights[i].position)) planes.pop_back();
            moved[i] = moved[i] || magnitude(face.plane.distance(lights[i].position)) > rounding;
        }
        if (moved[i]) lights[i].position = *nearest_on(planes, lights[i].position);
    }
    return moved;
}

std::string light_on_face(const SceneSource& source, const std::vector<NormalizedLight>& lights,
                          const LightFaces& faces) {
    for (size_t i = 0; i < lights.size(); ++i) {
        if (!lights[i].lights() || faces[i].empty()) continue;
        if (lights[i].convex >= 0) return "the lights on the edges of " + lights[i].place + " lie on its faces";
        return "the light " + lights[i].place + " lies on a face of " + source.solids[faces[i][0].incident.solid].place;
    }
    return "";
}

}  // namespace cistula
