// The meshes and textures of a scene: read once, checked once, and shared from then on. Nothing behind this stage opens
// a file.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "base/error.h"
#include "image/picture/picture.h"
#include "scene/description/description.h"
#include "scene/readers/meshes/polygon_mesh.h"

namespace cistula {

struct SceneAssets {
    std::vector<std::shared_ptr<const MeshData>> meshes;        // of each object; null: it is no MeshObject
    std::vector<std::shared_ptr<const ColorPicture>> pictures;  // of each texture; null: nothing uses it
    std::vector<std::string> warnings;                          // of textures
    std::vector<std::string> files;  // that the description and its meshes name; maps of meshes may be missing
};

/// Resolves the meshes and textures of a scene, whether they are files, which are read once each however many objects
/// name them, or arrays that the description holds. Textures other than .data are read by a child process, the program
/// cistula-read-picture, which must be found (image/reader/reader_process.h), one after another, so that no more
/// than their limit is in memory. Throws Error with the place, and (interrupted).
SceneAssets load_assets(const SceneDescription& scene, StopSignal stop = {});

/// "scene.json: /objects/2".
std::string place_in(const SceneDescription& description, const std::string& place);

/// An error (scene) with its place.
Error scene_error(const SceneDescription& description, const std::string& place, const std::string& problem,
                  const std::string& remedy = {});

}  // namespace cistula
