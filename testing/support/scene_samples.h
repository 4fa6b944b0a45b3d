// Small scene descriptions that several tests start from.
#pragma once

#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "apps/common/command_line.h"
#include "scene/description/description.h"
#include "verify/scenes/generated_scene.h"

namespace cistula::samples {

inline MaterialDescription material(const std::string& name, double reflection = 0, double transmission = 0) {
    MaterialDescription m;
    m.name = name;
    m.reflection = reflection;
    m.transmission = transmission;
    return m;
}

/// A description with one material, no objects and no lights.
inline SceneDescription empty_scene() {
    SceneDescription scene;
    scene.source = "test.json";
    scene.materials.push_back(material("plain"));
    return scene;
}

template <class Shape>
void add_object(SceneDescription& scene, Shape shape, int material_number = 0) {
    ObjectDescription object;
    object.place = "/objects/" + std::to_string(scene.objects.size());
    object.name = "object " + std::to_string(scene.objects.size());
    object.material = material_number;
    object.shape = std::move(shape);
    scene.objects.push_back(std::move(object));
}

inline SolidObject solid(PlatonicSolid kind, const glm::dvec3& center = glm::dvec3{0}, double radius = 1) {
    SolidObject s;
    s.solid = kind;
    s.center = center;
    s.radius = radius;
    return s;
}

inline LightDescription& add_light(SceneDescription& scene, const glm::dvec3& position,
                                   const glm::dvec3& color = glm::dvec3{1}) {
    LightDescription light;
    light.position = position;
    light.color = color;
    light.place = "/lights/" + std::to_string(scene.lights.size());
    scene.lights.push_back(light);
    return scene.lights.back();
}

/// A square of two triangles perpendicular to the z axis, counter-clockwise seen from above, with uvs.
inline TrianglesObject square(double half = 1, double z = 0) {
    TrianglesObject object;
    object.vertices = {{-half, -half, z}, {half, -half, z}, {half, half, z}, {-half, half, z}};
    object.triangles = {{0, 1, 2}, {0, 2, 3}};
    object.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    return object;
}

/// Expects that `run` throws Error with this code and a message that contains `part`.
template <class Run>
void expect_error(const Run& run, ExitCode code, const std::string& part) {
    try {
        run();
        ADD_FAILURE() << "no error that says: " << part;
    } catch (const Error& error) {
        EXPECT_EQ(exit_code(error.kind()), code);
        EXPECT_NE(with_options(error.what()).find(part), std::string::npos) << error.what();
    }
}

}  // namespace cistula::samples
