// The generated scenes that backends are compared on: between them they hold all that a description can, and every
// intersector of the host renders them to the same integers. CISTULA_GENERATED_STEP=1 renders them all, not every
// eighth.
#include <gtest/gtest.h>

#include <cstdlib>
#include <map>
#include <set>
#include <string>

#include "backend_embree/embree/embree_renderer.h"
#include "cistula/traversal/brute.h"
#include "render/frame/frame_view.h"
#include "render/record/film_difference.h"
#include "scene/compile/scene_hash.h"
#include "scene/compile/scene_normalization.h"
#include "scene/description/camera_path.h"
#include "scene/description/platonic.h"
#include "scene/description/rotation.h"
#include "testing/support/shipped_scenes.h"
#include "verify/reference_renderers.h"
#include "verify/scenes/generated_scene.h"

using namespace cistula;
using glm::dvec3;

namespace {

// ---- what a description holds, found in the description and not where it was made

struct Face {
    dvec3 normal;  // unit, outward
    std::vector<dvec3> corners;
    dvec3 middle() const {
        dvec3 sum(0);
        for (const dvec3& p : corners) sum += p;
        return sum / double(corners.size());
    }
    double height(const dvec3& p) const { return dot(normal, p - corners[0]); }
    bool holds(const dvec3& p, double tolerance) const {
        if (magnitude(height(p)) > tolerance) return false;
        for (size_t i = 0; i < corners.size(); ++i) {
            const dvec3 edge = corners[(i + 1) % corners.size()] - corners[i];
            if (dot(cross(edge, p - corners[i]), normal) < 0) return false;
        }
        return true;
    }
};

/// A Platonic solid, or a mesh of its few triangles.
struct Body {
    bool convex = false;  // known to be
    double tolerance = 0;
    dvec3 center{0};
    std::vector<Face> faces;
    std::vector<dvec3> vertices;

    bool contains(const dvec3& p) const {
        for (const Face& face : faces)
            if (face.height(p) > -tolerance) return false;
        return convex;
    }
};

Body body_of(const SolidObject& solid) {
    Body body{true, 1e-9 * (solid.radius + length(solid.center)), solid.center, {}, world_vertices(solid)};
    for (const auto& f : platonic_shape(solid.solid).faces) {
        Face face{Rotation(solid.rotation)(f.normal), {}};
        for (const uint32_t v : f.vertices) face.corners.push_back(body.vertices[v]);
        body.faces.push_back(face);
    }
    return body;
}

Body body_of(const TrianglesObject& mesh) {
    Body body;
    body.vertices = mesh.vertices;
    for (const auto& t : mesh.triangles) {
        const dvec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
        body.tolerance = max_or_second(body.tolerance, 1e-9 * (length(b - a) + length(a)));
        body.faces.push_back({normalized(cross(b - a, c - a)), {a, b, c}});
    }
    return body;
}

/// Faces of two bodies in one plane, one of them with its middle on the other: 1 where they look the same way, else -1.
int shared_face(const Body& a, const Body& b) {
    const double tolerance = a.tolerance + b.tolerance;
    for (const Face& f : a.faces)
        for (const Face& g : b.faces) {
            const double cosine = dot(f.normal, g.normal);
            if (magnitude(cosine) < 1 - 1e-9) continue;
            if (f.holds(g.middle(), tolerance) || g.holds(f.middle(), tolerance)) return cosine > 0 ? 1 : -1;
        }
    return 0;
}

class Coverage {
  public:
    void add(const SceneDescription& scene) {
        here_.clear();
        for (const ObjectDescription& object : scene.objects) look_at(scene, object);
        look_at_lights(scene);
        look_at_camera(scene);
        const std::shared_ptr<const CompiledScene<double>> compiled = compile_scene<double>(scene);
        look_at_compiled(scene, *compiled);
        look_at_places(scene, *compiled);
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
        const bool sheet = std::holds_alternative<TrianglesObject>(object.shape) &&
                           std::get<TrianglesObject>(object.shape).triangles.size() < 4;
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
        note(scene.background == dvec3(0), "black background");
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
                if (scene.solids[solid].kind == SolidKind::convex)
                    note(true, several ? "light on a corner of planes" : "light on a plane");
                else
                    note(true, several ? "light on an edge of triangles" : "light on a triangle");
            }
        note(true, "mask " + std::to_string(least_mask(scene.effects)));

        const FrameView frame = frame_view(scene, camera_at(description.camera, 0), generated_settings(description));
        InteriorList media;
        const SceneView<double> view = scene.view();
        EXPECT_TRUE(camera_solids(view, BruteIntersector<double>{view}, frame.camera.position, media));
        note(!media.empty(), "camera in a solid");
        note(media.size > 1, "camera in several solids");
    }

    void look_at_places(const SceneDescription& scene, const CompiledScene<double>& compiled) {
        std::vector<Body> bodies;
        for (size_t i = 0; i < scene.objects.size(); ++i) {
            const auto& shape = scene.objects[i].shape;
            if (const auto* solid = std::get_if<SolidObject>(&shape)) bodies.push_back(body_of(*solid));
            if (compiled.solids[i].kind == SolidKind::sheet) continue;
            const auto* mesh = std::get_if<TrianglesObject>(&shape);
            if (!mesh || mesh->triangles.size() > 40) continue;
            bodies.push_back(body_of(*mesh));
            bodies.back().convex = compiled.solids[i].kind == SolidKind::convex;
            note(bodies.back().convex, "mesh given by planes");
        }
        for (const Body& body : bodies)
            for (const LightDescription& light : scene.lights)
                note(light.color != dvec3(0) && body.contains(light.position), "light in a solid");
        for (const Body& a : bodies)
            for (const Body& b : bodies) {
                if (&a == &b) continue;
                size_t inside = 0;
                for (const dvec3& p : a.vertices) inside += b.contains(p);
                note(inside == a.vertices.size(), "nested");
                note(inside > 0 && inside < a.vertices.size(), "overlapping");
                const int shared = shared_face(a, b);
                const std::string what = a.convex && b.convex   ? " of planes"
                                         : a.convex || b.convex ? " of both kinds"
                                                                : " of meshes";
                note(shared < 0, "shared face" + what);
                note(shared > 0, "faces in one place" + what);
            }
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
    EXPECT_EQ(coverage.required(), all_effects & ~(effect_spheres | effect_planes));
    // Those that few of so rich scenes have run in tests/backends/effects.cpp, on ten scenes and more of which less is
    // left.
    for (const int mask : {3, 4}) coverage.expect("mask " + std::to_string(mask), 10);
    static_assert(effect_mask_count == 7);
    for (int depth = 1; depth <= 10; ++depth) coverage.expect("depth " + std::to_string(depth), 5);
    const std::set<std::string> of_files = {"mesh file", "picture, bilinear", "picture, nearest"};
    // clang-format off
    const std::map<int, std::vector<std::string>> features_by_count = {
        {100, {"diffuse", "specular", "ambient", "background", "no cutoff", "sheet", "supersample 1"}},
        {40, {"tetrahedron", "cube", "octahedron", "dodecahedron", "icosahedron", "rotated", "not rotated", "mesh",
              "planes and meshes", "a plain loop is enough", "a tree is needed", "point light", "seen light", "clear",
              "opaque", "semi-mirror", "index above 1", "fresnel", "absorption", "checker"}},
        {20, {"integer exponent", "fractional exponent", "full mirror", "mirror", "kr + kt = 1",
              "kr + kt a little above 1", "tint with zeros", "tinted, not mirroring", "index 1", "index below 1",
              "index just above 1", "picture, bilinear", "picture, nearest", "mesh file", "texture on a sheet",
              "texture on a mesh", "sheet that is not flat", "lights on edges", "glow", "falloff",
              "intensity 0", "nested", "overlapping", "shared face of planes", "shared face of meshes",
              "camera in a solid", "view along an axis", "tilted camera", "cutoff", "supersample 2", "supersample 3",
              "convex solids apart", "a tree over seen lights", "far from the origin"}},
        {8, {"colored highlights", "many primitives", "integer exponent by logarithm", "fresnel without transmission",
             "no light of its own", "unlit", "intensity 0, but seen", "seen lights on edges",
             "falloff of lights on edges", "light on a plane", "light on a corner of planes", "light on a triangle",
             "light on an edge of triangles", "light in a solid", "shared face of both kinds", "no ambient light",
             "mesh given by planes", "black background", "camera on a path", "target on a path", "far camera",
             "pinned frame", "pinned bound", "large units", "convex solids only", "clamped texture",
             "box", "truncated-cube"}},
        {4, {"faces in one place of planes", "faces in one place of both kinds", "lights on edges that do not light",
             "camera in several solids", "a tree over convex solids apart", "small units", "mirrored texture"}}};
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

/// Hash of the numbers in a scene that come from random draws and formulas.
std::string digest(const SceneDescription& scene) {
    SceneHash hash;
    for (const ObjectDescription& object : scene.objects) {
        if (const auto* solid = std::get_if<SolidObject>(&object.shape)) {
            for (const dvec3& v : {solid->center, solid->rotation, dvec3(solid->radius, solid->edge_lights.count, 0)})
                hash.add(v);
        } else if (const auto* mesh = std::get_if<TrianglesObject>(&object.shape)) {
            for (const dvec3& v : mesh->vertices) hash.add(v);
            hash.add_bytes(mesh->triangles.data(), mesh->triangles.size() * sizeof(mesh->triangles[0]));
        }
    }
    for (const MaterialDescription& m : scene.materials)
        for (const dvec3& v : {m.color, m.tint, m.absorption, dvec3(m.reflection, m.transmission, m.index),
                               dvec3(m.diffuse, m.specular, m.exponent)})
            hash.add(v);
    for (const LightDescription& light : scene.lights)
        for (const dvec3& v : {light.position, light.color, dvec3(light.radius)}) hash.add(v);
    const Camera camera = camera_at(scene.camera, 0).camera;
    for (const dvec3& v : {camera.position, camera.forward, camera.up, dvec3(scene.depth, scene.cutoff, 0)})
        hash.add(v);
    return hash.hex();
}

/// Other compilers, other machines: these very scenes. Whoever changes how they are made puts the new number here.
TEST(GeneratedScenes, AreTheSameEverywhere) {
    SceneHash all;
    for (uint64_t seed = 0; seed < generated_scene_count; ++seed) {
        const std::string hash = digest(generated_scene(seed));
        all.add_bytes(hash.data(), hash.size());
    }
    EXPECT_EQ(all.hex(), "b18c67147786dded6bc08d4f8eb573e1");
}

// ---- what they look like

uint64_t step() {
    const char* text = std::getenv("CISTULA_GENERATED_STEP");
    const long value = text ? std::atol(text) : 0;
    return value > 0 ? uint64_t(value) : 8;
}

Film film_of(Renderer& renderer, const SceneDescription& scene) {
    Film film;
    RenderProgress progress;
    renderer.render(camera_at(scene.camera, 0), generated_settings(scene), film, progress);
    return film;
}

template <class Real>
class GeneratedImages : public ::testing::Test {};
using Reals = ::testing::Types<float, double>;
TYPED_TEST_SUITE(GeneratedImages, Reals);

TYPED_TEST(GeneratedImages, AreEqualBitForBitByEveryIntersector) {
    using Real = TypeParam;
    uint64_t rays = 0, scenes = 0, seen = 0;
    for (uint64_t seed = 0; seed < generated_scene_count; seed += step()) {
        const SceneDescription scene = generated_scene(seed, test::scene_folder);
        const std::shared_ptr<const CompiledScene<Real>> plain = compile_scene<Real>(scene);
        std::shared_ptr<CompiledScene<Real>> treed = compile_scene<Real>(scene);
        build_primitive_tree(*treed, 1);
        EmbreeOptions always;
        always.always_tree = true;
        const Film expected = film_of(*make_host_renderer<Real>(plain, HostIntersector::brute), scene);
        const std::string hash = record_hash(expected);
        EXPECT_EQ(expected.flags, 0u) << "seed " << seed;
        const auto check = [&](std::unique_ptr<Renderer> renderer, const char* name) {
            const Film film = film_of(*renderer, scene);
            EXPECT_EQ(film.flags, 0u) << "seed " << seed << ", " << name;
            EXPECT_EQ(record_hash(film), hash) << "seed " << seed << ", " << name;
            EXPECT_EQ(film.rays.total(), expected.rays.total()) << "seed " << seed << ", " << name;
        };
        check(make_embree_renderer<Real>(plain), "embree");
        check(make_embree_renderer<Real>(plain, always), "embree with a tree always");
        check(make_host_renderer<Real>(treed, HostIntersector::bvh), "bvh");
        ++scenes;
        rays += expected.rays.total();
        size_t hit = 0;
        for (const PixelRecord& pixel : expected.pixels) hit += pixel.hits > 0;
        seen += 20 * hit > expected.pixels.size();
    }
    EXPECT_GE(20 * seen, 19 * scenes) << "scenes that show something";
    EXPECT_GE(rays, 10000 * scenes);
}

}  // namespace
