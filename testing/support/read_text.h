// Scenes and meshes that tests give as text.
#pragma once

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "scene/readers/meshes/mesh_file.h"
#include "scene/readers/read_scene.h"
#include "testing/support/expect_error.h"

namespace cistula::test {

/// What a JSON scene named a.json describes.
inline SceneDescription json_scene(const std::string& text) {
    return read_scene_text(text, "a.json", "");
}

/// A scene with these keys beside the one that it must have.
inline SceneDescription scene_with(const std::string& keys) {
    return json_scene("{\"objects\": [], " + keys + "}");
}

/// The parts of a mesh that no warning is due for.
inline std::vector<MeshPart> read_whole_mesh(const MeshObject& object) {
    const MeshData data = read_mesh(object.file);
    EXPECT_EQ(data.warnings, std::vector<std::string>());
    return placed_parts(data, object);
}

}  // namespace cistula::test

#define EXPECT_WRONG(statement, message) EXPECT_ERROR(statement, cistula::ExitCode::usage, message)
