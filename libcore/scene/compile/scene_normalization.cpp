#include "scene/compile/scene_normalization.h"

#include <cmath>

#include "cistula/numerics/vec.h"
#include "scene/compile/scene_source.h"
#include "scene/description/platonic.h"
#include "scene/description/rotation.h"

namespace cistula {
namespace {

// M must stay under 2 after rounding up to float.
constexpr double largest_extent = 2 - 0x1p-20;

void add_sphere(Box& box, const glm::dvec3& center, double radius) {
    box.add(center - glm::dvec3{radius});
    box.add(center + glm::dvec3{radius});
}

void add_solid(Box& box, const SolidObject& solid) {
    const std::vector<glm::dvec3> vertices = world_vertices(solid);
    for (const glm::dvec3& p : vertices) box.add(p);
    const EdgeLights& lights = solid.edge_lights;
    if (lights.count == 0 || !lights.shown()) return;
    for (const auto& edge : polyhedron_of(solid).edges) {
        for (int i = 0; i < lights.count; ++i) {
            const double s = (i + 1.0) / (lights.count + 1.0);
            const glm::dvec3 &a = vertices[edge.vertices[0]], &b = vertices[edge.vertices[1]];
            add_sphere(box, a + s * (b - a), lights.radius);
        }
    }
}

void add_disk(Box& box, const DiskObject& disk) {
    const glm::dvec3 normal = normalized(disk.normal);
    glm::dvec3 reach;
    for (int axis = 0; axis < 3; ++axis)
        reach[axis] = disk.radius * square_root(max_or_second(1 - normal[axis] * normal[axis], 0.0));
    box.add(disk.center - reach);
    box.add(disk.center + reach);
}

/// A box around what a scene of planes without end has: their points nearest to the origin, and lights.
Box box_of_planes(const SceneSource& source) {
    Box box;
    for (const SourceSolid& solid : source.solids)
        if (solid.disk) box.add(solid.disk->center);
    if (!box.empty())
        for (const LightDescription& light : source.description->lights) box.add(light.position);
    return box;
}

/// How far a described solid, a ball or a disk reaches from its center; of meshes and planes without end infinite.
double reach_of(const SourceSolid& solid) {
    if (solid.polyhedron) return solid.polyhedron->radius * polyhedron_of(*solid.polyhedron).reach;
    if (solid.sphere) return solid.sphere->radius;
    return solid.disk ? solid.disk->radius : INFINITY;
}

double largest_coordinate(const Box& box, const glm::dvec3& center) {
    double largest = 0;
    for (int axis = 0; axis < 3; ++axis) {
        largest = max_or_second(largest, magnitude(box.high[axis] - center[axis]));
        largest = max_or_second(largest, magnitude(box.low[axis] - center[axis]));
    }
    return largest;
}

}  // namespace

std::vector<glm::dvec3> world_vertices(const SolidObject& solid) {
    const Rotation rotation(solid.rotation);
    std::vector<glm::dvec3> vertices;
    for (const glm::dvec3& p : polyhedron_of(solid).vertices)
        vertices.push_back(solid.center + rotation(solid.radius * p));
    return vertices;
}

Box world_box(const SourceSolid& solid) {
    Box box;
    if (solid.polyhedron) {
        add_solid(box, *solid.polyhedron);
    } else if (solid.sphere) {
        add_sphere(box, solid.sphere->center, solid.sphere->radius);
    } else if (solid.disk) {
        if (!solid.disk->is_endless()) add_disk(box, *solid.disk);
    } else {
        for (const glm::dvec3& p : solid.mesh.vertices)
            if (is_finite(p)) box.add(p);
    }
    return box;
}

Box world_box(const SceneSource& source) {
    Box box;
    for (const SourceSolid& solid : source.solids) box.add(world_box(solid));
    for (const LightDescription& light : source.description->lights)
        if (light.shown()) add_sphere(box, light.position, light.radius);
    return box;
}

SceneNormalization find_normalization(const SceneSource& source) {
    const SceneDescription& description = *source.description;
    Box box = world_box(source);
    if (source.moving) box.add(source.moving->parts.box);
    if (box.empty() && !source.moving) box = box_of_planes(source);
    SceneNormalization normalization;
    if (description.frame) {
        normalization.center = description.frame->center;
        normalization.scale = description.frame->scale;
        if (!is_finite(normalization.center) || normalization.scale < -1000 || normalization.scale > 1000)
            throw scene_error(description, "/frame", "the center must be finite and the scale in [-1000, 1000]");
    } else if (!box.empty()) {
        normalization.center = 0.5 * box.low + 0.5 * box.high;
    }
    const double largest = box.empty() ? 0 : largest_coordinate(box, normalization.center);
    if (!is_finite(largest) || (largest > 0 && (largest < 0x1p-900 || largest > 0x1p900)))
        throw scene_error(description, "", "the scene's size is outside what doubles can hold (2^-900 to 2^900)");
    for (const SourceSolid& solid : source.solids)
        if (reach_of(solid) < 0x1p-50 * largest)
            throw scene_error(description, solid.place,
                              "so small beside the scene that double precision makes a point of it",
                              "give it a larger radius, or bring what is far away nearer");
    if (!description.frame && largest > 0) {
        int exponent;
        std::frexp(largest, &exponent);
        normalization.scale = 1 - exponent;
        if (std::ldexp(largest, normalization.scale) > largest_extent) --normalization.scale;
    }
    normalization.factor = std::ldexp(1.0, normalization.scale);
    const double extent = largest * normalization.factor;
    if (description.frame && extent > largest_extent)
        throw scene_error(description, "/frame",
                          std::string("the largest coordinate ") + (source.moving ? "of all frames " : "") + "is " +
                              std::to_string(extent) + " in the pinned frame",
                          "it must stay under 2: choose a lesser scale or another center");
    // If the scene does not give the frame, M may be just under 1 (see largest_extent); what is derived from it is then
    // slightly larger than necessary.
    normalization.extent = description.frame ? (extent > 0 ? extent : 1) : max_or_second(extent, 1.0);
    return normalization;
}

}  // namespace cistula
