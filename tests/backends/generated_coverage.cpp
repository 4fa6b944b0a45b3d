// Between them the generated scenes hold all that a description can.
#include <gtest/gtest.h>

#include <map>
#include <set>
#include <string>

#include "cistula/traversal/brute.h"
#include "render/frame/frame_view.h"
#include "scene/compile/constant_scene.h"
#include "scene/description/camera_path.h"
#include "testing/support/shipped_scenes.h"
#include "tests/backends/places.h"
#include "verify/scenes/generated_scene.h"

using namespace cistula;
using glm::dvec3;

namespace {

/// What descriptions hold, found in them and not where they were made.
class Coverage {
  public:
    void add(const SceneDescription& scene) {
        here_.clear();
        for (const ObjectDescription& object : scene.objects) look_at(scene, object);
        look_at_lights(scene);
        look_at_camera(scene);
        look_at_keys(scene);
        const std::shared_ptr<const CompiledScene<double>> compiled = compile_scene<double>(scene);
        look_at_compiled(scene, *compiled);
        here_.merge(test::Places(scene, *compiled).found);
        for (const std::string& feature : here_) ++scenes_[feature];
        required_ |= compiled->effects;
        hashes_.insert(compiled->hashes.of(0));
    }

    void expect(const std::string& feature, int least) const {
        const auto found = scenes_.find(feature);
        const int count = found == scenes_.end() ? 0 : found->second;
        EXPECT_GE(count, least) << feature;
    }
    uint32_t required() const { return required_; }
    size_t different() const { return hashes_.size(); }

  private:
    void note(bool is, const std::string& feature) {
        if (is) here_.insert(feature);
    }

    void look_at(const SceneDescription& scene, const ObjectDescription& object) {
        const MaterialDescription& m = scene.materials.at(size_t(object.material));
        const double kr = m.reflection, kt = m.transmission;
        const bool whole = m.exponent == floor_of(m.exponent);
        note(m.diffuse > 0, "diffuse");
        note(m.specular > 0, "specular");
        note(m.specular > 0 && m.specular_color != dvec3(1), "colored highlights");
        note(m.ambient > 0, "ambient");
        note(m.specular > 0 && whole && m.exponent <= 1024, "integer exponent");
        note(m.specular > 0 && whole && m.exponent > 1024, "integer exponent by logarithm");
        note(m.specular > 0 && !whole, "fractional exponent");
        note(kr == 0 && kt == 0, "opaque");
        note(kr > 0 && kr < 1 && kt == 0, "mirror");
        note(kr == 1, "full mirror");
        note(kr == 0 && kt == 1 && m.tint == dvec3(1), "clear");
        note(kr == 0 && kt == 1 && m.tint != dvec3(1), "tinted, not mirroring");
        note(kr > 0 && kt > 0 && kr + kt < 1, "semi-mirror");
        note(kr > 0 && kt > 0 && kr + kt == 1, "kr + kt = 1");
        note(kr + kt > 1, "kr + kt a little above 1");
        note(kt > 0 && (m.tint.x == 0 || m.tint.y == 0 || m.tint.z == 0), "tint with zeros");
        note(m.fresnel && kt > 0, "fresnel");
        note(m.fresnel && kr > 0 && kt == 0, "fresnel without transmission");
        const auto* disk = std::get_if<DiskObject>(&object.shape);
        const auto* triangles = std::get_if<TrianglesObject>(&object.shape);
        const bool sheet = disk || (triangles && triangles->triangles.size() < 4);
        if (!sheet && kt > 0) {
            note(m.index == 1, "index 1");
            note(m.index > 1, "index above 1");
            note(m.index > 1 && m.index < 1.001, "index just above 1");
            note(m.index < 1, "index below 1");
            note(largest_component(m.absorption) > 0, "absorption");
        }
        if (m.texture >= 0) {
            const TextureDescription& t = scene.textures.at(size_t(m.texture));
            note(t.file.empty(), "checker");
            note(!t.file.empty() && t.bilinear, "picture, bilinear");
            note(!t.file.empty() && !t.bilinear, "picture, nearest");
            for (const TextureWrap wrap : t.wrap) {
                note(wrap == TextureWrap::clamp, "clamped texture");
                note(wrap == TextureWrap::mirror, "mirrored texture");
            }
        }
        if (const auto* solid = std::get_if<SolidObject>(&object.shape)) {
            note(true, polyhedron_of(*solid).name);
            note(solid->rotation == dvec3(0), "not rotated");
            note(solid->rotation != dvec3(0), "rotated");
            const EdgeLights& lights = solid->edge_lights;
            note(lights.count > 0, "lights on edges");
            note(lights.count > 0 && lights.radius > 0, "seen lights on edges");
            note(lights.count > 0 && lights.falloff, "falloff of lights on edges");
            note(lights.count > 0 && lights.color == dvec3(0), "lights on edges that do not light");
        } else if (std::holds_alternative<SphereObject>(object.shape)) {
            note(true, "ball");
            note(m.texture >= 0, "texture on a ball");
            note(m.index > 1 && kt > 0, "ball of glass");
        } else if (disk) {
            note(true, disk->is_endless() ? "plane without end" : "disk");
            note(m.texture >= 0, disk->is_endless() ? "texture on a plane" : "texture on a disk");
            note(kt > 0, "disk or plane that is seen through");
            note(kr > 0, "disk or plane that mirrors");
        } else if (std::holds_alternative<MeshObject>(object.shape)) {
            note(true, "mesh file");
        }
    }

    void look_at_lights(const SceneDescription& scene) {
        note(scene.lights.empty(), "no light of its own");
        for (const LightDescription& light : scene.lights) {
            const bool dark = light.color == dvec3(0);
            note(!dark && light.radius == 0, "point light");
            note(light.radius > 0, "seen light");
            note(light.glow.has_value(), "glow");
            note(!dark && light.falloff, "falloff");
            note(dark, "intensity 0");
            note(dark && light.radius > 0, "intensity 0, but seen");
        }
        note(scene.ambient == dvec3(0), "no ambient light");
        note(scene.background == dvec3(0) && !scene.sky, "black background");
        note(scene.sky && scene.sky->texture < 0, "gradient around");
        note(scene.sky && scene.sky->texture >= 0, "picture around");
        note(scene.background != dvec3(0), "background");
    }

    void look_at_camera(const SceneDescription& scene) {
        const CameraDescription& camera = scene.camera;
        const CameraFrame frame = camera_at(camera, 0);
        const dvec3& forward = frame.camera.forward;
        const bool along = magnitude(forward.x) == 1 || magnitude(forward.y) == 1 || magnitude(forward.z) == 1;
        note(along, "view along an axis");
        note(camera.position_path.has_value(), "camera on a path");
        note(camera.target_path.has_value(), "target on a path");
        note(camera.field_of_view < 5, "far camera");
        note(camera.up != dvec3(0, 0, 1), "tilted camera");
        note(true, "depth " + std::to_string(scene.depth));
        note(true, "supersample " + std::to_string(scene.film.supersample));
        note(scene.cutoff == 0, "no cutoff");
        note(scene.cutoff > 0, "cutoff");
        note(scene.frame && scene.frame->bound, "pinned bound");
        note(scene.frame && !scene.frame->bound, "pinned frame");
    }

    void look_at_keys(const SceneDescription& scene) {
        if (!scene.motion) return;
        note(scene.shown == 2, "keys around a frame");
        for (const size_t i : scene.motion->objects) {
            const auto& shape = scene.objects[i].shape;
            const auto* disk = std::get_if<DiskObject>(&shape);
            note(std::holds_alternative<SolidObject>(shape), "keys of a solid");
            note(std::holds_alternative<SphereObject>(shape), "keys of a ball");
            note(disk && !disk->is_endless(), "keys of a disk");
            note(disk && disk->is_endless(), "keys of a plane");
        }
    }

    void look_at_compiled(const SceneDescription& description, const CompiledScene<double>& scene) {
        size_t convex = 0, meshes = 0, sheets = 0, touched = 0;
        for (const Solid& solid : scene.solids) {
            convex += solid.kind == SolidKind::convex;
            meshes += solid.kind == SolidKind::mesh;
            sheets += solid.kind == SolidKind::sheet;
            touched += solid.kind != SolidKind::sheet && solid.may_touch != 0;
            const bool textured = scene.materials[solid.material].texture >= 0;
            note(solid.kind == SolidKind::sheet && !solid.flat, "sheet that is not flat");
            note(solid.kind == SolidKind::sheet && textured, "texture on a sheet");
            note(solid.kind == SolidKind::mesh && textured, "texture on a mesh");
        }
        const size_t primitives = scene.convex.size() + scene.clusters.size();
        note(sheets > 0, "sheet");
        note(meshes > 0, "mesh");
        note(convex > 0 && meshes > 0, "planes and meshes");
        note(meshes + sheets == 0, "convex solids only");
        note(convex > 0 && meshes == 0 && touched == 0, "convex solids apart");
        note(primitives <= 16, "a plain loop is enough");
        note(primitives > 16, "a tree is needed");
        note(primitives > 16 && meshes == 0 && touched == 0, "a tree over convex solids apart");
        note(primitives > 200, "many primitives");
        note(scene.visible_lights.size() > 8, "a tree over seen lights");
        note(magnitude(scene.center.x) > 100 || magnitude(scene.center.y) > 100, "far from the origin");
        note(scene.scale > 3, "small units");
        note(scene.scale < -6, "large units");
        note(scene.lights.empty(), "unlit");
        for (const Light<double>& light : scene.lights)
            for (uint32_t i = 0; i < light.incident_count; ++i) {
                const uint32_t solid = scene.incidents[light.first_incident + i].solid;
                const bool own = &light - scene.lights.data() < ptrdiff_t(description.lights.size());
                if (!own) continue;
                const bool several = light.incident_count > 1;
                if (is_disk(scene.solids[solid]))
                    note(true, "light on a disk or plane");
                else if (scene.solids[solid].kind == SolidKind::convex)
                    note(true, several ? "light on a corner of planes" : "light on a plane");
                else
                    note(true, several ? "light on an edge of triangles" : "light on a triangle");
            }
        note(true, "mask " + std::to_string(least_mask(scene.effects)));

        const FrameSettings settings = generated_settings(description);
        const FrameView frame = frame_view(scene, camera_at(description.camera, 0), settings);
        InteriorList media;
        const SceneView<double> view = scene.view();
        EXPECT_TRUE(camera_solids(view, BruteIntersector<double>{view}, frame.camera.position, media));
        note(!media.empty(), "camera in a solid");
        note(media.size > 1, "camera in several solids");
        media.for_each([&](uint32_t solid, int) { note(is_ball(scene.solids[solid]), "camera in a ball"); });
        note(!scene.normals.empty(), "smooth mesh");
        note(view.unseen_faces, "faces passed unseen");
        note(ball_scene(view, view) && mask_to_run(scene.effects, settings, frame) == ball_mask, "loop over balls");
        note(fits_constant_scene(view), "plain loop of devices");
    }

    std::map<std::string, int> scenes_;  // that have the feature
    std::set<std::string> here_, hashes_;
    uint32_t required_ = 0;
};

void check_coverage(const std::string& folder) {
    Coverage coverage;
    for (uint64_t seed = 0; seed < generated_scene_count; ++seed) {
        SCOPED_TRACE(seed);
        coverage.add(generated_scene(seed, folder));
    }
    EXPECT_EQ(coverage.different(), generated_scene_count);
    EXPECT_EQ(coverage.required(), all_effects);
    for (int mask = 0; mask < effect_mask_count; ++mask) coverage.expect("mask " + std::to_string(mask), 8);
    for (int depth = 1; depth <= 10; ++depth) coverage.expect("depth " + std::to_string(depth), 5);
    const std::set<std::string> of_files = {"mesh file", "picture, bilinear", "picture, nearest"};
    // clang-format off
    const std::map<int, std::vector<std::string>> features_by_count = {
        {100, {"diffuse", "specular", "ambient", "background", "no cutoff", "sheet", "supersample 1"}},
        {40, {"tetrahedron", "cube", "octahedron", "dodecahedron", "icosahedron", "rotated", "not rotated", "mesh",
              "planes and meshes", "a plain loop is enough", "a tree is needed", "point light", "seen light", "clear",
              "opaque", "semi-mirror", "index above 1", "fresnel", "absorption", "checker", "ball", "ball of glass",
              "texture on a ball"}},
        {20, {"integer exponent", "fractional exponent", "full mirror", "mirror", "kr + kt = 1",
              "kr + kt a little above 1", "tint with zeros", "tinted, not mirroring", "index 1", "index below 1",
              "index just above 1", "picture, bilinear", "picture, nearest", "mesh file", "texture on a sheet",
              "texture on a mesh", "sheet that is not flat", "lights on edges", "glow", "falloff",
              "intensity 0", "nested", "overlapping", "shared face of planes", "shared face of meshes",
              "camera in a solid", "view along an axis", "tilted camera", "cutoff", "supersample 2", "supersample 3",
              "convex solids apart", "a tree over seen lights", "far from the origin", "smooth mesh", "disk",
              "plane without end", "disk or plane that mirrors", "disk or plane that is seen through",
              "gradient around", "keys around a frame", "keys of a ball", "keys of a solid", "balls that touch",
              "ball cut by a face"}},
        {8, {"colored highlights", "many primitives", "integer exponent by logarithm", "fresnel without transmission",
             "no light of its own", "unlit", "intensity 0, but seen", "seen lights on edges",
             "falloff of lights on edges", "light on a plane", "light on a corner of planes", "light on a triangle",
             "light on an edge of triangles", "light in a solid", "shared face of both kinds", "no ambient light",
             "mesh given by planes", "black background", "camera on a path", "target on a path", "far camera",
             "pinned frame", "pinned bound", "large units", "convex solids only", "clamped texture",
             "box", "truncated-cube", "picture around", "texture on a disk", "texture on a plane", "light in a ball",
             "light on a disk or plane", "camera in a ball", "keys of a disk", "keys of a plane", "balls that overlap",
             "flat body in a ball", "loop over balls", "faces passed unseen",
             "ball cut by a disk", "ball cut by a plane", "ball on a sheet"}},
        {4, {"faces in one place of planes", "faces in one place of both kinds", "lights on edges that do not light",
             "camera in several solids", "a tree over convex solids apart", "small units", "mirrored texture",
             "plain loop of devices", "ball in a ball", "balls in one place", "all corners on a ball", "ball in a flat body",
             "ball on a face", "ball under a face", "ball halved by a face", "ball on a disk", "ball under a disk",
             "ball on a plane", "ball cut by a sheet", "disk on a face", "disk on a disk", "planes that cross"}},
        {2, {"ball under a plane", "plane on a face", "rim on a ball", "ball that touches the ball around it",
             "ball that touches all faces around it"}}};
    // clang-format on
    for (const auto& [least, features] : features_by_count)
        for (const std::string& feature : features)
            if (!folder.empty() || !of_files.contains(feature)) coverage.expect(feature, least);
}

TEST(GeneratedScenes, HoldAllThatADescriptionCan) {
    check_coverage(test::scene_folder);
}

TEST(GeneratedScenes, HoldTheSameWithoutFiles) {
    check_coverage("");
}

}  // namespace
