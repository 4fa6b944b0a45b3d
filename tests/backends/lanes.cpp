// However many rays the host traces at once, every integer of the film is the same, and so is the count of rays.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "backend_embree/embree/embree_renderer.h"
#include "cistula/geometry/ray.h"
#include "testing/support/endless_scene.h"
#include "testing/support/golden.h"
#include "testing/support/lanes.h"
#include "testing/support/pictures/film_layers.h"
#include "testing/support/read_text.h"
#include "testing/support/shipped_scenes.h"
#include "verify/scenes/generated_scene.h"

using namespace cistula;

namespace {

template <class Real>
class LaneTest : public ::testing::Test {
  public:
    /// Renders in the widest lanes that are not hidden, and compares with one ray after the other. `most`: lanes to ask
    /// for; the instruction set of fewer is what remains where the widest is hidden.
    void compare(const SceneDescription& scene, FrameSettings settings, const std::string& name,
                 const std::vector<int>& most = {0}) {
        const std::shared_ptr<const CompiledScene<Real>> compiled = compile_scene<Real>(scene);
        const std::optional<int> least = test::least_lanes(*compiled, scene.camera, settings);
        if (least && *least <= widest_known) in_lanes_.insert(name);
        const auto renderer = make_embree_renderer<Real>(compiled, EmbreeOptions());
        settings.lanes = 1;
        const Film expected = golden::render_with(*renderer, scene, settings);
        EXPECT_EQ(renderer->lanes(), 1) << name;
        for (const int lanes : most) {
            settings.lanes = lanes;
            const Film film = golden::render_with(*renderer, scene, settings);
            EXPECT_EQ(renderer->lanes(), test::expected_lanes<Real>(least, lanes)) << name << ", " << lanes << " lanes";
            EXPECT_EQ(record_hash(film), record_hash(expected)) << name << ", " << lanes << " lanes";
            EXPECT_EQ(film.flags, expected.flags) << name;
            EXPECT_TRUE(film.layers.plan == expected.layers.plan) << name;
            EXPECT_TRUE(words_of(film) == words_of(expected)) << name << ", " << lanes << " lanes";
            for (const auto kind :
                 {&RayCounts::primary, &RayCounts::reflected, &RayCounts::transmitted, &RayCounts::shadow})
                EXPECT_EQ(film.rays.*kind, expected.rays.*kind) << name << ", " << lanes << " lanes";
        }
    }

    /// The number of scenes that the widest lanes take, whether this processor has them or not.
    size_t in_lanes() const { return in_lanes_.size(); }

  private:
    static constexpr int widest_known = 64 / sizeof(Real);  // of AVX-512

    /// All words of the film's layers, where tables of objects have no order.
    static std::vector<int64_t> words_of(const Film& film) {
        if (film.layers.plan.objects >= 0) return test::ordered_words(film);
        return {film.layers.words.begin(), film.layers.words.end()};
    }

    std::set<std::string> in_lanes_;
};

using Reals = ::testing::Types<float, double>;
TYPED_TEST_SUITE(LaneTest, Reals);

/// Hides AVX-512 where the environment says so, and skips all tests if there is none to hide.
class HiddenSets : public ::testing::Environment {
    void SetUp() override {
        if (test::is_without_avx512() && !hide_avx512()) GTEST_SKIP() << "without AVX-512, as all other tests";
    }
};
const ::testing::Environment* const hidden_sets = ::testing::AddGlobalTestEnvironment(new HiddenSets);

TYPED_TEST(LaneTest, FillTheWidestRegisterThatIsNotHidden) {
    const bool has_avx512 = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512cd") &&
                            __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw") &&
                            __builtin_cpu_supports("avx512vl");
    const int bytes = CISTULA_AVX512_IS_COMPILED && has_avx512 && !test::is_without_avx512() ? 64 : 32;
    ASSERT_NE(widest_tiles<TypeParam>(0), nullptr);
    EXPECT_EQ(widest_tiles<TypeParam>(0)->lanes, bytes / int(sizeof(TypeParam)));
    EXPECT_EQ(widest_tiles<TypeParam>(2), nullptr);
}

TYPED_TEST(LaneTest, NoMoreAreTakenThanAreAskedFor) {
    for (const char* name : {"platonic", "mesh"}) {
        const SceneDescription scene = test::shipped_scene(name);
        FrameSettings settings = golden::settings_for(scene);
        settings.set_size(37, 23);
        this->compare(scene, settings, name, {1, 2, 4, 8, 15, 16, 17, 1000});
    }
}

TYPED_TEST(LaneTest, ShippedScenesAreEqual) {
    for (const char* name : {"benchmark",
                             "platonic",
                             "infinity",
                             "seed",
                             "glass",
                             "hard/critical-angle",
                             "hard/media",
                             "hard/glass-on-floor",
                             "hard/corner",
                             "hard/camera-on-floor",
                             "hard/decal",
                             "hard/big-floor",
                             "hard/lights-on-edges",
                             "hard/mirrors",
                             "hard/index-one",
                             "hard/far-camera",
                             "mesh",
                             "hard/brightness",
                             "hard/closed-box",
                             "hard/degenerate",
                             "hard/doubled",
                             "hard/face-planes",
                             "hard/far-floor",
                             "hard/furnace",
                             "hard/huge",
                             "hard/media-meshes",
                             "hard/planes",
                             "hard/semi-mirror",
                             "hard/slivers",
                             "hard/tiny",
                             "hard/tiny-beside-unit"}) {
        const SceneDescription scene = test::shipped_scene(name);
        FrameSettings settings = golden::settings_for(scene);
        settings.set_size(97, 61);  // no multiple of a tile, nor of a register
        settings.supersample = 2;
        settings.depth = std::min(settings.depth, 12);
        settings.cutoff = 0;
        this->compare(scene, settings, name);
    }
    EXPECT_GE(this->in_lanes(), 29u);  // not where meshes touch: media-meshes and degenerate
}

TYPED_TEST(LaneTest, GeneratedScenesAreEqual) {
    for (uint64_t seed = 0; seed < generated_scene_count; ++seed) {
        const SceneDescription scene = generated_scene(seed);
        FrameSettings settings = generated_settings(scene);
        settings.target_error = seed % 4 == 1 ? 0.03 : 0;
        if (settings.adaptive()) settings.set_size(15, 9);
        settings.depth = std::min(settings.depth, 10);
        this->compare(scene, settings, "scene " + std::to_string(seed));
    }
    EXPECT_GE(this->in_lanes(), 15u);
}

/// A scene of transparent solids, one around the other, over a floor of tiles; `rise` lifts each tile over the one
/// before.
SceneDescription tiled_scene(int tiles, double rise, int nested) {
    std::string objects;
    for (int i = 0; i < tiles * tiles; ++i) {
        const double x = i % tiles - tiles / 2, y = i / tiles - tiles / 2, z = i * rise;
        objects += fmt::format(R"({{"quad": [[{0}, {1}, {4}], [{2}, {1}, {4}], [{2}, {3}, {4}], [{0}, {3}, {4}]],
                                   "material": "{5}"}}, )",
                               x, y, x + 1, y + 1, z, (i % tiles + i / tiles) % 2 ? "white" : "mirror");
    }
    for (int i = 0; i < nested; ++i)
        objects += fmt::format(R"({{"solid": "cube", "center": [0, 0, 1.3], "radius": {}, "material": "glass{}"}}{})",
                               1.2 - 0.1 * i, i % 3, i + 1 < nested ? ", " : "");
    return test::json_scene(R"({"film": {"width": 40, "height": 30}, "depth": 9, "background": [0.3, 0.4, 0.5],
        "camera": {"position": [0.3, -6, 4], "target": [0, 0, 1]}, "materials": {
        "white": {"color": 0.8, "diffuse": 0.7}, "mirror": {"color": 0.5, "diffuse": 0.4, "reflection": 0.5},
        "glass0": {"color": 1, "transmission": 1, "fresnel": true, "index": 1.5, "absorption": [0.1, 0.3, 0.2]},
        "glass1": {"color": 1, "transmission": 0.9, "index": 1.2}, "glass2": {"color": 1, "transmission": 1}},
        "objects": [)" + objects +
                            R"(], "lights": [{"position": [4, -5, 8], "color": 0.9}, {"position": [0, 0, 1.3]}]})");
}

TYPED_TEST(LaneTest, TreesAndSharedPlanesAreEqual) {
    size_t scenes = 0;
    for (const int tiles : {2, 3, 12})
        for (const double rise : {0.0, 0.001})
            for (const int nested : {1, 3, InteriorList::capacity}) {
                const SceneDescription scene = tiled_scene(tiles, rise, nested);
                this->compare(scene, golden::settings_for(scene), fmt::format("{} {} {}", tiles, rise, nested));
                ++scenes;
            }
    EXPECT_EQ(this->in_lanes(), scenes);
}

/// A scene with 36 more solids, of all its materials, which stand on one floor in a corner of it: too many for a bit
/// each. Some touch, some are one inside the other.
SceneDescription crowded(const SceneDescription& scene) {
    SceneDescription more = scene;
    more.frame.reset();  // which may not reach as far
    const SceneDescription unit = test::json_scene(
        R"({"materials": {"m": {"color": 0.5}}, "objects": [
            {"solid": "cube", "center": [0, 0, 0], "radius": 1, "material": "m"},
            {"quad": [[-2, -2, 0], [20, -2, 0], [20, 20, 0], [-2, 20, 0]], "material": "m"}]})");
    std::vector<int> plain;  // materials without a texture
    for (size_t i = 0; i < scene.materials.size(); ++i)
        if (scene.materials[i].texture < 0) plain.push_back(int(i));
    plain.push_back(int(more.materials.size()));
    more.materials.push_back(unit.materials[0]);
    for (int i = 0; i < 37; ++i) {
        ObjectDescription object = unit.objects[i < 36 ? 0 : 1];
        object.name.clear();
        object.material = plain[size_t(i) % plain.size()];
        if (auto* solid = std::get_if<SolidObject>(&object.shape)) {
            const double size = i % 6 == 5 ? 0.2 : 0.5;
            solid->radius = size * std::sqrt(3.0) / 2;
            solid->center = {-3 + 0.5 * (i % 6 == 5 ? i % 6 - 1 : i % 6), 2 + 0.75 * (i / 6), size / 2};
        } else {
            for (glm::dvec3& vertex : std::get<TrianglesObject>(object.shape).vertices) vertex *= 0.25;
        }
        more.objects.push_back(object);
    }
    return more;
}

TYPED_TEST(LaneTest, ScenesOfManySolidsAreEqual) {
    size_t scenes = 0;
    for (const int nested : {1, 2, 5}) {
        const SceneDescription scene = crowded(tiled_scene(3, 0, nested));
        FrameSettings settings = golden::settings_for(scene);
        this->compare(scene, settings, fmt::format("{} nested", nested));
        settings.cutoff = 0.004;
        settings.layers = test::all_layers();
        this->compare(scene, settings, fmt::format("{} nested with a cutoff and layers", nested));
        scenes += 2;
    }
    for (uint64_t seed = 0; seed < 60; ++seed) {
        const SceneDescription scene = crowded(generated_scene(seed));
        FrameSettings settings = generated_settings(scene);
        settings.depth = std::min(settings.depth, 8);
        this->compare(scene, settings, "scene " + std::to_string(seed));
    }
    EXPECT_GE(this->in_lanes(), scenes + 15);
}

TYPED_TEST(LaneTest, SolidsBeyondAnInteriorListAreToldOf) {
    const SceneDescription scene = tiled_scene(2, 0, InteriorList::capacity + 1);
    const auto renderer = make_embree_renderer<TypeParam>(compile_scene<TypeParam>(scene), EmbreeOptions());
    for (const int lanes : {1, 16}) {
        FrameSettings settings = golden::settings_for(scene);
        settings.lanes = lanes;
        EXPECT_TRUE(golden::render_with(*renderer, scene, settings).flags & flag_media_overflow) << lanes;
    }
}

/// Boxes as one object of triangles, from `low` to `low + size` in all axes each.
std::string boxes_of_triangles(const std::vector<std::pair<std::array<double, 3>, double>>& boxes) {
    std::string vertices, indices;
    const int faces[12][3] = {{0, 1, 3}, {0, 3, 2}, {4, 6, 7}, {4, 7, 5}, {0, 4, 5}, {0, 5, 1},
                              {2, 3, 7}, {2, 7, 6}, {0, 2, 6}, {0, 6, 4}, {1, 5, 7}, {1, 7, 3}};
    for (size_t box = 0; box < boxes.size(); ++box) {
        const auto& [low, size] = boxes[box];
        for (int i = 0; i < 8; ++i)
            vertices += fmt::format("{}[{}, {}, {}]", vertices.empty() ? "" : ", ", low[0] + (i & 4 ? size : 0),
                                    low[1] + (i & 2 ? size : 0), low[2] + (i & 1 ? size : 0));
        for (const auto& face : faces)
            indices += fmt::format("{}[{}, {}, {}]", indices.empty() ? "" : ", ", 8 * box + size_t(face[0]),
                                   8 * box + size_t(face[1]), 8 * box + size_t(face[2]));
    }
    return fmt::format(R"("triangles": {{"vertices": [{}], "indices": [{}]}}, "keep_triangles": true)", vertices,
                       indices);
}

/// Glass meshes, one of them of overlapping parts, with solids in and around them, over a floor at `height`.
SceneDescription scene_of_meshes(double height, const std::string& position, const std::string& glass) {
    const std::string parts = boxes_of_triangles({{{-1, -1, 0}, 1.5}, {{-0.5, -0.5, 0.5}, 1.5}, {{0, 0, 0.25}, 0.5}});
    const std::string box = boxes_of_triangles({{{1.25, -1, 0}, 1}});
    return test::json_scene(fmt::format(
        R"({{"film": {{"width": 61, "height": 43, "supersample": 2}}, "depth": 9, "background": [0.3, 0.4, 0.5],
        "camera": {{"position": {}, "target": [0.4, 0, 0.7], "fov": 50}}, "materials": {{
        "floor": {{"color": 0.8, "diffuse": 0.7, "reflection": 0.2}}, "glass": {{"color": 1, {}}},
        "clear": {{"color": 1, "transmission": 1}}, "solid": {{"color": 0.7, "diffuse": 0.6}}}},
        "objects": [{{"quad": [[-4, -4, {}], [4, -4, {}], [4, 4, {}], [-4, 4, {}]], "material": "floor"}},
        {{"solid": "cube", "center": [0, 0, 0.8], "radius": 0.6, "material": "glass"}},
        {{{}, "material": "glass"}}, {{{}, "material": "clear"}},
        {{"solid": "cube", "center": [1.75, -0.5, 0.5], "radius": 0.4, "material": "solid"}}],
        "lights": [{{"position": [4, -5, 8], "color": 0.9}}, {{"position": [-0.25, -0.25, 0.75], "color": 0.5}}]}})",
        position, glass, height, height, height, height, parts, box));
}

const char* const kinds_of_glass[] = {R"("transmission": 1)", R"("transmission": 0.8, "reflection": 0.1)",
                                      R"("transmission": 1, "index": 1.5, "fresnel": true)",
                                      R"("transmission": 1, "index": 1.5, "absorption": [0.2, 0.4, 0.1])"};

TYPED_TEST(LaneTest, MeshesOfOverlappingPartsAreEqual) {
    for (const char* position : {"[1, -5, 3]", "[-3, -0.25, 0.5]", "[1.5, -0.75, 0.75]", "[-0.75, -0.75, 0.25]"})
        for (const char* glass : kinds_of_glass) {
            const SceneDescription scene = scene_of_meshes(-0.25, position, glass);
            this->compare(scene, golden::settings_for(scene), std::string(position) + glass);
        }
    EXPECT_EQ(this->in_lanes(), 16u);
}

/// Opaque meshes that touch on a floor, seen from the plane of some of their faces, where rounding decides on which
/// side of an edge a ray starts.
SceneDescription scene_of_contacts(double height) {
    std::string meshes;
    for (const auto& mesh :
         {boxes_of_triangles({{{-1, -1, 0}, 1}, {{-0.5, -1.5, 0}, 0.75}}), boxes_of_triangles({{{0.75, -1, 0}, 1}}),
          boxes_of_triangles({{{0.75, 0, 0}, 1}}), boxes_of_triangles({{{0.75, -1, 1}, 0.5}})})
        meshes += fmt::format(R"(, {{{}, "material": "solid"}})", mesh);
    return test::json_scene(fmt::format(
        R"({{"film": {{"width": 121, "height": 121}}, "depth": 9, "background": [0.3, 0.4, 0.5],
        "camera": {{"position": [0.75, -5, {}], "target": [0.75, 0, 0.5], "fov": 40}}, "materials": {{
        "floor": {{"color": 0.8, "diffuse": 0.7, "reflection": 0.3, "transmission": 0.3}},
        "solid": {{"color": 0.7, "diffuse": 0.6, "reflection": 0.3}}}},
        "objects": [{{"quad": [[-4, -4, 0], [4, -4, 0], [4, 4, 0], [-4, 4, 0]], "material": "floor"}}{}],
        "lights": [{{"position": [4, -5, 8], "color": 0.9}}, {{"position": [0.75, -3, 2], "color": 0.5}},
        {{"position": [0.75, -3, -2], "color": 0.5}}]}})",
        height, meshes));
}

TYPED_TEST(LaneTest, OpaqueMeshesAtContactsAreEqual) {
    for (const double height : {3.0, 0.5}) {
        const SceneDescription scene = scene_of_contacts(height);
        this->compare(scene, golden::settings_for(scene), fmt::format("from {}", height));
    }
    EXPECT_EQ(this->in_lanes(), 2u);
}

TYPED_TEST(LaneTest, GlassMeshesAtContactsAreTracedOneRayAfterTheOther) {
    const SceneDescription scene = scene_of_meshes(0, "[1, -5, 3]", kinds_of_glass[2]);
    const auto renderer = make_embree_renderer<TypeParam>(compile_scene<TypeParam>(scene), EmbreeOptions());
    golden::render_with(*renderer, scene, golden::settings_for(scene));
    EXPECT_EQ(renderer->lanes(), 1);
}

TYPED_TEST(LaneTest, CutoffsAndTargetsAreEqual) {
    for (const char* name : {"benchmark", "platonic", "infinity", "seed", "glass", "hard/critical-angle", "hard/media",
                             "hard/glass-on-floor", "hard/decal"}) {
        const SceneDescription scene = test::shipped_scene(name);
        FrameSettings settings = golden::settings_for(scene);
        settings.set_size(49, 31);
        settings.depth = std::min(settings.depth, 12);
        settings.supersample = 2;
        settings.cutoff = 0.004;
        this->compare(scene, settings, std::string(name) + " with a cutoff");
        settings.layers = test::all_layers();
        this->compare(scene, settings, std::string(name) + " with a cutoff and layers");
        settings.set_size(29, 17);
        settings.cutoff = 0;
        settings.target_error = 0.01;
        this->compare(scene, settings, std::string(name) + " with a target and layers");
        settings.layers = LayerRequest();
        this->compare(scene, settings, std::string(name) + " with a target");
        settings.target_error = 0.1;
        settings.max_samples = 24;
        this->compare(scene, settings, std::string(name) + " with few samples");
    }
    EXPECT_EQ(this->in_lanes(), 45u);
}

TYPED_TEST(LaneTest, CutoffsAndTargetsOfMeshesAreEqual) {
    std::vector<SceneDescription> scenes{test::shipped_scene("mesh"), scene_of_contacts(3), scene_of_contacts(0.5)};
    for (const char* position : {"[1, -5, 3]", "[-0.75, -0.75, 0.25]"})
        for (const char* glass : kinds_of_glass) scenes.push_back(scene_of_meshes(-0.25, position, glass));
    for (size_t i = 0; i < scenes.size(); ++i) {
        FrameSettings settings = golden::settings_for(scenes[i]);
        settings.set_size(49, 31);
        settings.supersample = 2;
        settings.depth = 12;
        settings.cutoff = 0.004;
        settings.layers = i % 2 == 0 ? test::all_layers() : LayerRequest();
        this->compare(scenes[i], settings, fmt::format("scene {} with a cutoff", i));
        settings.set_size(25, 17);
        settings.cutoff = 0;
        settings.target_error = 0.01;
        this->compare(scenes[i], settings, fmt::format("scene {} with a target", i));
    }
    EXPECT_EQ(this->in_lanes(), 22u);
}

/// Trees of more than most_branches, which are traced again with larger budgets.
TYPED_TEST(LaneTest, TreesWithoutEndAreEqual) {
    const SceneDescription scene = test::room_of_mirrors();
    FrameSettings settings = test::endless_settings(3, 2);
    settings.target_error = 0.02;  // some trees come near most_branches; with 0.05 none does
    this->compare(scene, settings, "mirrors");
    settings.layers = test::all_layers();
    this->compare(scene, settings, "mirrors with layers");
    // A mesh of overlapping parts, inside of which branches are traced by themselves.
    SceneDescription with_mesh = scene;
    const SceneDescription meshes = scene_of_meshes(-0.25, "[1, -5, 3]", R"("transmission": 0.5, "reflection": 0.5)");
    ObjectDescription object = meshes.objects[2];
    for (glm::dvec3& vertex : std::get<TrianglesObject>(object.shape).vertices) vertex *= 0.3;
    object.material = int(with_mesh.materials.size());
    with_mesh.objects.push_back(object);
    with_mesh.materials.push_back(meshes.materials[size_t(meshes.objects[2].material)]);
    settings.layers = LayerRequest();
    this->compare(with_mesh, settings, "mirrors around a mesh");
    EXPECT_EQ(this->in_lanes(), 3u);
}

/// All layers, with room for all objects of the shipped scenes.
LayerRequest all_layers() {
    LayerRequest layers = test::all_layers();
    layers.object_entries = 64;
    return layers;
}

TYPED_TEST(LaneTest, LayersOfShippedScenesAreEqual) {
    // Textures, visible lights, refraction, shared planes, several lights.
    for (const char* name : {"benchmark", "platonic", "infinity", "seed", "glass", "hard/critical-angle", "hard/media",
                             "hard/glass-on-floor", "hard/corner", "hard/decal", "hard/camera-on-floor"}) {
        const SceneDescription scene = test::shipped_scene(name);
        FrameSettings settings = golden::settings_for(scene);
        settings.set_size(71, 43);  // no multiple of a tile, nor of a register
        settings.supersample = 2;
        settings.depth = std::min(settings.depth, 12);
        settings.cutoff = 0;
        settings.layers = all_layers();
        this->compare(scene, settings, name);
    }
    EXPECT_EQ(this->in_lanes(), 11u);
}

TYPED_TEST(LaneTest, LayersOfMeshesAreEqual) {
    for (const char* position : {"[1, -5, 3]", "[-0.75, -0.75, 0.25]"})
        for (const char* glass : kinds_of_glass) {
            const SceneDescription scene = scene_of_meshes(-0.25, position, glass);
            FrameSettings settings = golden::settings_for(scene);
            settings.layers = all_layers();
            this->compare(scene, settings, std::string(position) + glass);
        }
    FrameSettings settings = golden::settings_for(scene_of_contacts(3));
    settings.layers = all_layers();
    this->compare(scene_of_contacts(3), settings, "contacts");
    EXPECT_EQ(this->in_lanes(), 9u);
}

/// The scene is so small in the picture that some rays, though near it, do not even enter the sphere around it.
TYPED_TEST(LaneTest, LayersOfRaysThatMissTheSceneAreEqual) {
    SceneDescription scene = test::shipped_scene("glass");
    scene.camera.position = 20.0 * scene.camera.position;
    scene.camera.field_of_view = 150;
    FrameSettings settings = golden::settings_for(scene);
    settings.set_size(64, 64);
    settings.supersample = 3;
    settings.layers = all_layers();
    this->compare(scene, settings, "glass from afar");
    EXPECT_EQ(this->in_lanes(), 1u);
}

TYPED_TEST(LaneTest, LayersOfEachKindAloneAreEqual) {
    SceneDescription scene = test::shipped_scene("seed");
    for (auto& light : scene.lights) light.group = "all";
    scene.lights[0].group = "first";
    FrameSettings settings = golden::settings_for(scene);
    settings.set_size(64, 40);
    settings.supersample = 3;
    for (const auto kind :
         {&LayerRequest::path, &LayerRequest::light, &LayerRequest::first_hit, &LayerRequest::objects}) {
        settings.layers = LayerRequest();
        settings.layers.*kind = true;
        this->compare(scene, settings, "seed");
    }
    EXPECT_EQ(this->in_lanes(), 1u);
}

TYPED_TEST(LaneTest, LayersOfGeneratedScenesAreEqual) {
    for (uint64_t seed = 0; seed < generated_scene_count; seed += 2) {
        const SceneDescription scene = generated_scene(seed);
        FrameSettings settings = generated_settings(scene);
        settings.target_error = seed % 8 == 2 ? 0.03 : 0;
        if (settings.adaptive()) settings.set_size(15, 9);
        settings.depth = std::min(settings.depth, 10);
        settings.layers = all_layers();
        this->compare(scene, settings, "scene " + std::to_string(seed));
    }
    EXPECT_GE(this->in_lanes(), 10u);
}

TYPED_TEST(LaneTest, LayersOfTreesAndSharedPlanesAreEqual) {
    for (const int tiles : {2, 12}) {
        const SceneDescription scene = tiled_scene(tiles, 0, 3);
        FrameSettings settings = golden::settings_for(scene);
        settings.supersample = 2;
        settings.layers = all_layers();
        settings.layers.object_entries = 256;
        this->compare(scene, settings, fmt::format("{}", tiles));
    }
    EXPECT_EQ(this->in_lanes(), 2u);
}

TYPED_TEST(LaneTest, ObjectsBeyondAPixelsTableAreToldOf) {
    const SceneDescription scene = tiled_scene(12, 0, 1);
    const auto renderer = make_embree_renderer<TypeParam>(compile_scene<TypeParam>(scene), EmbreeOptions());
    for (const double target : {0.0, 0.1})
        for (const int entries : {1, 64})
            for (const int lanes : {1, 16}) {
                FrameSettings settings = golden::settings_for(scene);
                settings.supersample = 3;
                settings.target_error = target;
                settings.lanes = lanes;
                settings.layers.objects = true;
                settings.layers.object_entries = entries;
                EXPECT_EQ(golden::render_with(*renderer, scene, settings).flags,
                          entries == 1 ? flag_objects_overflow : 0u)
                    << entries << " entries, " << lanes << " lanes, target " << target;
                EXPECT_EQ(renderer->lanes() > 1, lanes > 1);
            }
}

}  // namespace
