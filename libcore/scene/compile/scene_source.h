// The input of a compilation: a description with its meshes placed and its materials numbered.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "base/box.h"
#include "base/error.h"
#include "scene/assets/assets.h"
#include "scene/compile/meshes/mesh_edges.h"
#include "scene/compile/moving_parts.h"
#include "scene/description/description.h"
#include "scene/description/mesh_source.h"

namespace cistula {

/// The source of one compiled Solid.
struct SourceSolid {
    std::string name, place;
    uint32_t material = 0;                    // index into SceneSource::materials
    const SolidObject* polyhedron = nullptr;  // null: the solid is `sphere` or, without one, `mesh`
    const SphereObject* sphere = nullptr;
    const DiskObject* disk = nullptr;  // then `mesh` is a square in its plane (compile_disks.h)
    /// The triangles that are rendered, in file order; those of a closed mesh counter-clockwise seen from outside.
    MeshSource mesh;
    MeshEdges edges;              // of the mesh, if they were found when it was found to be closed; else none
    bool closed = true;           // the solid has an inside; if it is a mesh, its triangles surround a volume
    double thickness = 0;         // of a closed mesh, in scene units: the least volume / area of its bodies
    uint32_t body = 0;            // of several solids that one mesh makes, from 0; they share its name
    bool keep_triangles = false;  // the mesh is not given by planes, even where it could be
    size_t object = 0;            // whose it is, by number in the description
    Smoothing smooth;             // of the mesh, as described
    /// Unit normals at the corners of each of its triangles, outward, 0 where a triangle is flat; none: all are.
    std::vector<std::array<glm::dvec3, 3>> normals;
    bool in_parts = false;  // a mesh with normals whose triangles are not all joined by edges

    /// Whether it is given by triangles, of which planes may be made.
    bool is_mesh() const { return !polyhedron && !sphere; }
    /// A mesh of the same object with these triangles; their edges are found again where they are needed.
    SourceSolid with_mesh(MeshSource triangles) const;
};

/// The solid's name, or one after its place in the file, "object3", if the file gives none.
std::string name_of(const SourceSolid& solid);

struct PlacedBodies;

struct MeshCache;  // compile_scene.cpp
std::shared_ptr<MeshCache> new_mesh_cache();

/// What all frames of a scene that changes have in common.
struct MovingScene {
    SceneDescription description;
    SceneAssets assets;
    MovingParts parts;                                     // what changes, in all frames
    std::vector<std::vector<SourceSolid>> solids;          // of each mesh that does not change, for all frames
    std::shared_ptr<MeshCache> meshes = new_mesh_cache();  // what compiling found of them
};

struct SceneSource {
    const SceneDescription* description = nullptr;
    std::vector<MaterialDescription> materials;                 // those of the description, then those from mesh files
    std::vector<SourceSolid> solids;                            // in file order
    std::vector<std::shared_ptr<const ColorPicture>> pictures;  // as SceneAssets has them
    std::vector<std::string> warnings;                          // of meshes and textures
    std::vector<std::string> files;                             // as SceneAssets has them
    StopSignal stop;                                            // ends what is done with it by Error (interrupted)
    std::shared_ptr<const PlacedBodies> bodies;                 // the solids in the scene's frame (placed_bodies.h)
    std::shared_ptr<const MovingScene> moving;                  // null: nothing changes from frame to frame
    std::shared_ptr<const SceneDescription> own;                // keeps the description of a frame
};

/// What make() returns. Its error names the frame that a description is at, if keys change it.
template <class Make>
auto named_by_frame(const SceneDescription& description, const Make& make) {
    const bool moves = description.motion != nullptr;
    const std::string place = "frame " + std::to_string(description.shown);
    try {
        return make();
    } catch (const Error& error) {
        if (!moves || error.kind() == ErrorKind::interrupted) throw;
        throw error.at(place);
    }
}

/// Checks every number that affects the compiled scene, and places the meshes. The assets are the description's, which
/// must outlive the result. Throws Error with the place.
SceneSource gather_scene(const SceneDescription& description, SceneAssets assets, StopSignal stop = {});
inline SceneSource gather_scene(const SceneDescription& description, StopSignal stop = {}) {
    return gather_scene(description, load_assets(description, stop), stop);
}

/// The scene at a frame, of assets that are read and checked once. Throws as gather_scene() does.
SceneSource gather_frame(const std::shared_ptr<const MovingScene>& moving, int frame, StopSignal stop = {});

template <class Real>
struct CompiledScene;

/// Compiles a description whose assets are at hand. Throws Error with the place, and (interrupted).
template <class Real>
std::unique_ptr<CompiledScene<Real>> compile_scene(SceneSource source);
}  // namespace cistula
