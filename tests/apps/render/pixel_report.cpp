// --pixel: a pixel's ray trees are what the renderer gives, add up, and are told alike as text and as JSON.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "apps/common/render_options.h"
#include "image/exr/exr.h"
#include "render/pixel_report.h"
#include "scene/compile/scene_names.h"
#include "testing/support/golden.h"
#include "testing/support/render_program.h"

namespace cistula {
namespace {

using nlohmann::json;

std::vector<std::string> scene_files() {
    std::vector<std::string> files;
    for (const char* folder : {"/scenes", "/scenes/hard"})
        for (const auto& entry : std::filesystem::directory_iterator(std::string(CISTULA_SOURCE_DIR) + folder))
            if (entry.path().extension() == ".json") files.push_back(entry.path().string());
    std::sort(files.begin(), files.end());
    return files;
}

FixedColor plus(FixedColor a, const FixedColor& b) {
    for (size_t c = 0; c < 3; ++c) a[c] += b[c];
    return a;
}
FixedColor color_of(const int64_t (&sums)[3]) {
    return {sums[0], sums[1], sums[2]};
}

/// What single branches say, added up without the sums that the tree keeps.
void expect_adds_up(const SampleTree& sample) {
    FixedColor radiance{}, ledger{};
    RayCounts rays;
    for (const PixelBranch& branch : sample.branches) {
        radiance = plus(radiance, branch.adds);
        ledger = plus(ledger, branch.ledger);
        if (branch.end == BranchEnd::pruned || branch.end == BranchEnd::cut) {
            EXPECT_EQ(branch.adds, FixedColor{});
            EXPECT_TRUE(branch.children.empty());
            continue;
        }
        (branch.kind == BranchKind::primary    ? rays.primary
         : branch.kind == BranchKind::mirrored ? rays.reflected
                                               : rays.transmitted) += 1;
        if (branch.end != BranchEnd::surface) continue;
        FixedColor here = branch.surface.ambient_adds;
        for (const LightContribution& light : branch.surface.lights) {
            here = plus(here, light.adds);
            rays.shadow += light.fate == LightFate::adds || light.fate == LightFate::shadow ? 1 : 0;
            if (light.fate != LightFate::adds) {
                EXPECT_EQ(light.adds, FixedColor{});
            }
        }
        EXPECT_EQ(here, branch.adds);
    }
    EXPECT_EQ(radiance, color_of(sample.record.radiance));
    EXPECT_EQ(ledger, plus(color_of(sample.record.pruned), color_of(sample.record.cut)));
    EXPECT_EQ(rays.primary, sample.rays.primary);
    EXPECT_EQ(rays.reflected, sample.rays.reflected);
    EXPECT_EQ(rays.transmitted, sample.rays.transmitted);
    EXPECT_EQ(rays.shadow, sample.rays.shadow);
}

/// Weights, shares and what lights add, against the light model in double.
void expect_follows_the_model(const SampleTree& sample, const Film& film, double tolerance) {
    for (const PixelBranch& branch : sample.branches) {
        if (branch.end != BranchEnd::surface) continue;
        const PixelSurface& s = branch.surface;
        for (const uint32_t number : branch.children) {
            const PixelBranch& child = sample.branches[number];
            const glm::dvec3 share = child.kind == BranchKind::mirrored ? glm::dvec3(s.mirrored) : s.through;
            for (int c = 0; c < 3; ++c) EXPECT_NEAR(child.weight[c], branch.arriving[c] * share[c], tolerance);
            EXPECT_EQ(child.depth, branch.depth + 1);
        }
        for (int c = 0; c < 3; ++c) {
            EXPECT_LE(branch.arriving[c], branch.weight[c]);
            EXPECT_LE(s.local + s.mirrored + s.through[c], 1 + tolerance);
        }
        const double scale = std::ldexp(1.0, film.radiance_exponent);
        for (const LightContribution& light : s.lights) {
            const glm::dvec3 adds = radiance_of(light.adds, film);
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(adds[c] / scale,
                            branch.arriving[c] * s.local * light.arrives[c] * light.unshadowed[c] / scale, tolerance);
            // What takes light away is named, and nothing else.
            if (light.fate == LightFate::shadow) {
                EXPECT_FALSE(light.through.empty());
            }
            if (light.arrives == glm::dvec3(1)) {
                EXPECT_TRUE(light.through.empty());
            }
        }
    }
}

/// Pixels all over a frame, the same in every run.
std::vector<ChosenPixel> places(int width, int height, int count) {
    std::vector<ChosenPixel> list = {{0, 0}, {width - 1, height - 1}, {width / 2, height / 2}};
    uint32_t state = 12345;
    const auto below = [&](int limit) {
        state = state * 1664525u + 1013904223u;
        return static_cast<int>((state >> 8) % static_cast<uint32_t>(limit));
    };
    while (static_cast<int>(list.size()) < count) list.push_back({below(width), below(height)});
    return list;
}

template <class Real>
class PixelTrees : public testing::Test {};
using Precisions = testing::Types<float, double>;
TYPED_TEST_SUITE(PixelTrees, Precisions);

TYPED_TEST(PixelTrees, AreTheFilmsPixels) {
    using Real = TypeParam;
    size_t surfaces = 0, passed = 0, cut = 0;
    for (const std::string& file : scene_files()) {
        SCOPED_TRACE(file);
        const SceneDescription scene = read_scene(file);
        const FrameSettings settings = golden::settings_for(scene);
        const std::shared_ptr<const CompiledScene<Real>> compiled = compile_scene<Real>(scene);
        const CameraFrame camera = camera_at(scene.camera, 0);
        const std::unique_ptr<Renderer> renderer = make_embree_renderer<Real>(compiled);
        Film film;
        RenderProgress progress;
        ASSERT_TRUE(renderer->render(camera, settings, film, progress));
        for (const ChosenPixel& place : places(settings.full_width, settings.full_height, 40)) {
            SCOPED_TRACE(fmt::format("pixel {},{}", place.x, place.y));
            const PixelTree tree = renderer->pixel_tree(camera, settings, place.x, place.y);
            ASSERT_EQ(tree.samples.size(), 1u);
            const PixelRecord& expected =
                film.pixels[static_cast<size_t>(place.y) * static_cast<size_t>(settings.full_width) +
                            static_cast<size_t>(place.x)];
            const PixelRecord& record = tree.samples[0].record;
            EXPECT_EQ(color_of(record.radiance), color_of(expected.radiance));
            EXPECT_EQ(color_of(record.pruned), color_of(expected.pruned));
            EXPECT_EQ(color_of(record.cut), color_of(expected.cut));
            EXPECT_EQ(record.rays, expected.rays);
            EXPECT_EQ(record.id, expected.id);
            EXPECT_EQ(record.hits, expected.hits);
            expect_adds_up(tree.samples[0]);
            expect_follows_the_model(tree.samples[0], tree.film, 64 * RealTraits<Real>::unit);
            const PixelBranch& primary = tree.samples[0].branches.front();
            if (primary.end == BranchEnd::surface) {
                EXPECT_EQ(static_cast<int32_t>(primary.surface.solid) + 1, record.id);
                const double depth = primary.distance * dot(primary.direction, camera.camera.forward);
                EXPECT_NEAR(depth, static_cast<double>(record.z), 1e-6 * std::abs(depth));
            }
            for (const PixelBranch& branch : tree.samples[0].branches) {
                surfaces += branch.end == BranchEnd::surface ? 1 : 0;
                passed += branch.passed.size();
                cut += branch.end == BranchEnd::cut ? 1 : 0;
            }
        }
    }
    // What there is to tell was met.
    EXPECT_GT(surfaces, 2000u);
    EXPECT_GT(passed, 50u);
    EXPECT_GT(cut, 50u);
}

TYPED_TEST(PixelTrees, AddUpWithACutoffAndSamples) {
    using Real = TypeParam;
    const SceneDescription scene = read_scene(std::string(CISTULA_SOURCE_DIR) + "/scenes/glass.json");
    const std::shared_ptr<const CompiledScene<Real>> compiled = compile_scene<Real>(scene);
    const CameraFrame camera = camera_at(scene.camera, 0);
    FrameSettings settings = golden::settings_for(scene);
    settings.supersample = 3;
    settings.cutoff = 0.02;
    const std::unique_ptr<Renderer> renderer = make_embree_renderer<Real>(compiled);
    size_t pruned = 0;
    for (const ChosenPixel& place : places(settings.full_width, settings.full_height, 60)) {
        const PixelTree tree = renderer->pixel_tree(camera, settings, place.x, place.y);
        ASSERT_EQ(tree.samples.size(), 9u);
        FixedColor sum{};
        for (const SampleTree& sample : tree.samples) {
            expect_adds_up(sample);
            sum = plus(sum, color_of(sample.record.radiance));
            for (const PixelBranch& branch : sample.branches) pruned += branch.end == BranchEnd::pruned ? 1 : 0;
        }
        EXPECT_EQ(sum, color_of(tree.film.pixels.at(0).radiance));
    }
    EXPECT_GT(pruned, 100u);
}

TEST(SceneNames, NameWhatIsCompiled) {
    for (const std::string& file : scene_files()) {
        SCOPED_TRACE(file);
        const SceneDescription scene = read_scene(file);
        const auto compiled = compile_scene<double>(scene);
        const SceneNames names = name_scene(gather_scene(scene));
        ASSERT_EQ(names.solids.size(), compiled->solids.size());
        for (size_t i = 0; i < names.solids.size(); ++i) EXPECT_EQ(names.solids[i].name, compiled->solid_names[i]);
        EXPECT_EQ(names.materials.size(), compiled->materials.size());
        EXPECT_EQ(names.lights.size(), compiled->lights.size());
        EXPECT_EQ(names.visible_lights.size(), compiled->visible_lights.size());
    }
}

TEST(SceneNames, NamelessObjectsAreNumbered) {
    const SceneDescription scene = read_scene_text(R"({"materials": {"m": {}}, "objects": [
        {"solid": "cube", "material": "m", "edge_lights": {"count": 1, "radius": 0.01}},
        {"solid": "sphere", "center": [9, 0, 0], "material": "m", "name": "moon"}]})",
                                                   "a.json", "");
    const SceneNames names = name_scene(gather_scene(scene));
    ASSERT_EQ(names.solids.size(), 2u);
    EXPECT_EQ(names.solids[0].name, "object0");
    EXPECT_EQ(names.solids[1].name, "moon");
    EXPECT_EQ(names.lights.at(11).name, "object0 edge 11 light 0");
    EXPECT_EQ(names.visible_lights.at(0).name, "object0 edge 0 light 0");
}

class PixelReports : public RenderProgram {
  protected:
    json report(Arguments arguments) const {
        arguments.insert(arguments.end(), {"--json", "-"});
        const ProgramResult result = run(arguments);
        EXPECT_EQ(result.code, 0) << result.error;
        return json::parse(result.out);
    }
};

/// All branches of a tree.
void gather(const json& branch, std::vector<json>& all) {
    all.push_back(branch);
    if (branch.contains("children"))
        for (const json& child : branch["children"]) gather(child, all);
}

TEST_F(PixelReports, TextAndJsonTellTheSame) {
    const Arguments arguments = {"s.json", "--pixel", "20,7", "--depth", "3"};
    const ProgramResult text = run(arguments);
    EXPECT_EQ(text.code, 0) << text.error;
    EXPECT_EQ(text.error, "");
    const json tree = report(arguments);
    EXPECT_EQ(tree["pixel"], (json{20, 7}));
    EXPECT_EQ(tree["resolution"], (json{40, 24}));
    EXPECT_EQ(tree["depth"], 3);
    ASSERT_EQ(tree["samples"].size(), 1u);
    std::vector<json> branches;
    gather(tree["samples"][0]["tree"], branches);
    std::array<int64_t, 3> radiance{}, ledger{};
    size_t surfaces = 0, cut = 0;
    for (const json& branch : branches) {
        for (size_t c = 0; c < 3; ++c) {
            if (branch.contains("adds")) radiance[c] += branch["adds"]["sum"][c].get<int64_t>();
            if (branch.contains("ledger")) ledger[c] += branch["ledger"]["sum"][c].get<int64_t>();
        }
        cut += branch["end"] == "cut";
        if (branch["end"] != "surface") continue;
        ++surfaces;
        const json& surface = branch["surface"];
        const std::string name = surface["object"]["name"], place = surface["object"]["place"];
        EXPECT_NE(text.out.find(fmt::format("meets {} ({})", name, place)), std::string::npos) << name;
        EXPECT_NE(text.out.find("material " + surface["material"].get<std::string>()), std::string::npos);
        if (surface["bends"] && !surface["total_reflection"]) {
            const std::string bends = fmt::format("bends to {:.1f} degrees", surface["angle_beyond"].get<double>());
            EXPECT_NE(text.out.find(bends), std::string::npos) << bends;
        }
    }
    EXPECT_GT(surfaces, 2u);
    EXPECT_GT(cut, 0u);
    const json& totals = tree["totals"];
    EXPECT_EQ(json(radiance), totals["sums"]["radiance"]);
    EXPECT_EQ(json(ledger), totals["sums"]["cut"]);
    const auto has = [&](const std::string& part) {
        EXPECT_NE(text.out.find(part), std::string::npos) << part << "\n" << text.out;
    };
    has(fmt::format("radiance  {} {} {}\n", totals["radiance"][0].get<float>(), totals["radiance"][1].get<float>(),
                    totals["radiance"][2].get<float>()));
    has(fmt::format("ledger    {} {} {} at most is missing", totals["error"][0].get<float>(),
                    totals["error"][1].get<float>(), totals["error"][2].get<float>()));
    has(fmt::format("rays      {}: 1 primary, ", totals["rays"]["total"].get<int>()));
    has("beyond the depth of 3");
    has("index 1 -> 1.3");
}

TEST_F(PixelReports, ShowTheImagesValues) {
    expect_done({"s.json", "-q", "-o", "a.exr", "--layers", "error,cost,id,Z", "-f", "2", "--precision", "double"});
    const LayeredPicture picture = read_exr(file("a.exr"));
    const auto value = [&](const std::string& name, size_t i) {
        for (const LayeredPicture::Channel& channel : picture.channels)
            if (channel.name == name) return channel.values[i];
        throw std::runtime_error("no channel " + name);
    };
    for (const ChosenPixel& place : places(40, 24, 12)) {
        const json tree =
            report({"s.json", "-f", "2", "--precision", "double", "--pixel", fmt::format("{},{}", place.x, place.y)});
        const size_t i = static_cast<size_t>(place.y) * 40 + static_cast<size_t>(place.x);
        const json& totals = tree["totals"];
        const char* channels[] = {"R", "G", "B"};
        for (size_t c = 0; c < 3; ++c) {
            EXPECT_EQ(totals["radiance"][c].get<float>(), value(channels[c], i));
            EXPECT_EQ(totals["error"][c].get<float>(), value(std::string("error.") + channels[c], i));
        }
        EXPECT_EQ(totals["rays"]["total"].get<float>(), value("cost", i));
        EXPECT_EQ(totals["id"].get<float>(), value("id", i));
        if (totals["id"] == 0) {
            EXPECT_EQ(totals["Z"], "inf");
        } else {
            EXPECT_EQ(totals["Z"].get<float>(), value("Z", i));
        }
    }
}

TEST_F(PixelReports, SeveralSamples) {
    const json tree = report({"s.json", "--pixel", "20,11", "--supersample", "3"});
    ASSERT_EQ(tree["samples"].size(), 9u);
    EXPECT_EQ(tree["samples"][5]["row"], 1);
    EXPECT_EQ(tree["samples"][5]["column"], 2);
    const std::string brief = run({"s.json", "--pixel", "20,11", "--supersample", "3"}).out;
    const std::string whole = run({"s.json", "--pixel", "20,11", "--supersample", "3", "-v"}).out;
    const auto count = [](const std::string& text, const std::string& part) {
        size_t n = 0;
        for (size_t at = text.find(part); at != text.npos; at = text.find(part, at + 1)) ++n;
        return n;
    };
    EXPECT_EQ(count(brief, "primary ray from the camera"), 1u);
    EXPECT_NE(brief.find("the sample in column 2 of 3, row 2 of 3, the nearest to the pixel's center"),
              std::string::npos);
    EXPECT_NE(brief.find("column row  rays"), std::string::npos);
    EXPECT_EQ(count(whole, "primary ray from the camera"), 9u);
    EXPECT_EQ(whole.find("folded"), std::string::npos);
}

TEST_F(PixelReports, WriteFilesAndStandardInput) {
    const ProgramResult both = run({"s.json", "--pixel", "3,4", "--json", "p.json"});
    EXPECT_EQ(both.code, 0) << both.error;
    EXPECT_NE(both.out.find("pixel 3,4 of 40x24"), std::string::npos);
    EXPECT_EQ(json::parse(bytes_of(file("p.json"))), report({"s.json", "--pixel", "3,4"}));
    const ProgramResult input = run({"-", "--pixel", "3,4", "--threads", "1"}, scene_text);
    EXPECT_EQ(input.code, 0) << input.error;
    EXPECT_EQ(input.out.substr(input.out.find('\n')), both.out.substr(both.out.find('\n')));
    EXPECT_FALSE(exists("s.exr"));
}

TEST_F(PixelReports, FacesArePassedEnteredAndLeft) {
    const auto scene = [&](double y) {
        put_bytes(file("way.json"), fmt::format(R"({{"film": {{"width": 9, "height": 9}},
            "camera": {{"position": [0, {}, 0], "target": [0, 9, 0]}},
            "materials": {{"clear": {{"transmission": 1, "color": 0}}, "m": {{}}}},
            "objects": [{{"solid": "sphere", "material": "clear"}},
                {{"disk": {{"center": [0, 2, 0], "normal": [0, 1, 0]}}, "material": "clear"}},
                {{"solid": "cube", "center": [0, 4, 0], "material": "clear"}},
                {{"solid": "sphere", "center": [0, 9, 0], "material": "m"}}],
            "lights": [{{"position": [0, 20, 0]}}, {{"position": [0, 8.2, 4]}}]}})",
                                                y));
        return run({"way.json", "--pixel", "4,4"}).out;
    };
    const auto expect_in_order = [](const std::string& text, const std::vector<std::string>& parts) {
        size_t at = 0;
        for (const std::string& part : parts) {
            at = text.find(part, at);
            ASSERT_NE(at, std::string::npos) << part << "\n" << text;
        }
    };
    const std::vector<std::string> rest = {"leaves object0 (/objects/0), distance",
                                           "passes object1 (/objects/1), distance", "enters object2 (/objects/2), face",
                                           "leaves object2 (/objects/2), face",
                                           "meets object3 (/objects/3), from outside, at (0, 8, 0)"};
    std::vector<std::string> all = {"enters object0 (/objects/0), distance 4"};
    all.insert(all.end(), rest.begin(), rest.end());
    expect_in_order(scene(-5), all);
    const std::string inside = scene(-0.5);
    expect_in_order(inside, rest);
    EXPECT_EQ(inside.find("enters object0"), std::string::npos) << inside;
    const json tree = report({"way.json", "--pixel", "4,4"});
    std::vector<json> crossings;
    for (const json& face : tree["samples"][0]["tree"]["passed"])
        crossings.push_back({face["object"]["name"], face["crossing"]});
    EXPECT_EQ(json(crossings),
              json::array({{"object0", "leaves"}, {"object1", "sheet"}, {"object2", "enters"}, {"object2", "leaves"}}));
}

TEST_F(PixelReports, ShowTheIdOfALight) {
    put_bytes(file("lamp.json"), R"({"film": {"width": 40, "height": 24},
        "camera": {"position": [0, -5, 0]}, "materials": {"m": {}},
        "objects": [{"solid": "cube", "center": [3, 3, 0], "material": "m"},
                    {"name": "lit", "solid": "cube", "center": [-3, 3, 0], "material": "m",
                     "edge_lights": {"count": 1, "radius": 0.1}}],
        "lights": [{"position": [9, 9, 9]}, {"position": [2, 0, 0], "radius": 0.1}, {"position": [0, 0, 0], "radius": 1}]})");
    const json tree = report({"lamp.json", "--pixel", "20,12"});
    EXPECT_EQ(tree["totals"]["id"], 4);  // two solids, one light before it
    EXPECT_NEAR(tree["totals"]["Z"].get<double>(), 4, 0.01);
    EXPECT_NEAR(tree["totals"]["N"][1].get<double>(), -1, 0.01);
    EXPECT_EQ(tree["samples"][0]["tree"]["light"], (json{{"id", 4}, {"name", "light 2"}, {"place", "/lights/2"}}));
}

TEST_F(PixelReports, RefuseInOneLine) {
    for (const char* text : {"12", "1;2", "1,", ",2", "1,2,3", "-1,2", "1.5,2", "x,y", " 1,2"})
        expect_refused({"s.json", std::string("--pixel=") + text}, ExitCode::usage,
                       std::string("--pixel ") + text + ": must be X,Y in pixels from the top left");
    for (const char* text : {"40,0", "0,24", "99999,99999"})
        expect_refused(
            {"s.json", "--pixel", text}, ExitCode::usage,
            std::string("--pixel ") + text + ": is outside of the frame, which is 40x24; its last pixel is 39,23");
    expect_refused({"s.json", "--pixel", "16,8", "--res", "16x9"}, ExitCode::usage,
                   "which is 16x9; its last pixel is 15,8");
    const std::vector<Arguments> senseless = {{"-o", "a.exr"},       {"--preview", "p.png"}, {"--stats", "t.json"},
                                              {"--layers", "id"},    {"--bits", "half"},     {"--strict"},
                                              {"--crop", "4x4+0+0"}, {"--resume"},           {"--progress", "plain"},
                                              {"--explain"},         {"--backend", "cuda"}};
    for (const Arguments& more : senseless) {
        Arguments arguments = {"s.json", "--pixel", "1,2"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        expect_refused(arguments, ExitCode::usage, "--pixel 1,2: " + more[0] + " has no place here");
    }
    expect_refused({"s.json", "--pixel", "1,2", "-f", "0-2"}, ExitCode::usage, "--frames names 3 frames");
    expect_refused({"s.json", "--json", "a.json"}, ExitCode::usage, "--json requires --pixel");
    expect_refused({"s.json", "--pixel", "1,2", "--json", "s.json"}, ExitCode::usage,
                   "would be both the scene and --json");
    expect_refused({"s.json", "--pixel", "1,2", "--json", "s.json/a.json"}, ExitCode::file,
                   "the directory s.json cannot be made: Not a directory");
    expect_refused({"none.json", "--pixel", "1,2"}, ExitCode::file, "none.json");
    EXPECT_FALSE(exists("a.exr") || exists("a.json"));
}

/// The sample in the documentation is what the program prints.
TEST(PixelDocs, ShowWhatIsPrinted) {
    const std::string docs = bytes_of(std::string(CISTULA_SOURCE_DIR) + "/docs/programs/pixel.md");
    const size_t option = docs.find(" --pixel ", docs.find("$ render scenes/glass.json --pixel"));
    ASSERT_NE(option, docs.npos);
    const size_t command = docs.rfind("$ render", option);
    const size_t end_of_line = docs.find('\n', command), end = docs.find("```", command);
    std::istringstream words(docs.substr(command + 2, end_of_line - command - 2));
    Arguments arguments;
    for (std::string word; words >> word;) arguments.push_back(word);
    const std::string program = std::string(CISTULA_BIN_DIR) + "/" + arguments.at(0);
    arguments.erase(arguments.begin());
    const ProgramResult result = RunningProgram(program, arguments, CISTULA_SOURCE_DIR).wait();
    EXPECT_EQ(result.code, 0) << result.error;
    EXPECT_EQ(result.out, docs.substr(end_of_line + 1, end - end_of_line - 1));
}

/// A pixel that a render refuses is told all the same, and not passed off as good.
TEST_F(PixelReports, FailWhereThePixelCannotBeTrusted) {
    std::string nested = scene_text;
    std::string objects;
    for (int i = 0; i < 10; ++i)
        objects += fmt::format(
            R"({{"name": "shell {}", "solid": "cube", "center": [0, 0, 1.5], "radius": {}, "material": "glass"}},)", i,
            3.0 - 0.2 * i);
    const size_t at = nested.find("\"objects\": [") + std::string("\"objects\": [").size();
    nested.insert(at, objects);
    put_bytes(file("n.json"), nested);
    const ProgramResult film = run({"n.json", "-q", "-o", "n.exr", "--depth", "12", "--crop", "1x1+20+11"});
    ASSERT_EQ(film.code, 1) << film.error;
    const ProgramResult result = run({"n.json", "--pixel", "20,11", "--depth", "12"});
    EXPECT_EQ(result.code, 1);
    EXPECT_NE(result.error.find("pixel 20,11 cannot be trusted: a ray was inside more than 8 solids at once"),
              std::string::npos)
        << result.error;
    EXPECT_NE(result.out.find("meets shell 0"), std::string::npos);
    const json report = json::parse(run({"n.json", "--pixel", "20,11", "--depth", "12", "--json", "-"}).out);
    EXPECT_TRUE(report.contains("cannot_be_trusted"));
    EXPECT_NE(report.dump().find("\"dropped\""), std::string::npos) << "the ray goes on";
}

/// A film of two nests of glass shells, which lie behind one another at frame 0. From frame 1 on they lie apart; at
/// frame 3 the second nest is in the first, and their bodies are too many for one ray. A third nest is never seen.
TEST_F(PixelReports, NameTheSolidsOfOneRayThatIsInsideTooMany) {
    std::string objects;
    const auto add = [&](const std::string& name, double radius, const std::string& center) {
        objects += fmt::format(R"({}{{"name": "{}", "solid": "sphere", "radius": {}, "center": {}, "material": "g"}})",
                               objects.empty() ? "" : ", ", name, radius, center);
    };
    for (int i = 0; i < 5; ++i) add(fmt::format("outer {}", i), 1 - 0.1 * i, "[0, 0, 0]");
    for (int i = 0; i < 5; ++i)
        add(fmt::format("inner {}", i), 0.5 - 0.05 * i,
            R"({"keys": [[0, [0, 9, 0]], [1, [5, 9, 0]], [3, [0, 0, 0]]]})");
    for (int i = 0; i < 10; ++i) add(fmt::format("unseen {}", i), 1 - 0.05 * i, "[0, -40, 0]");
    put_bytes(file("f.json"), fmt::format(R"({{"film": {{"width": 24, "height": 16}}, "depth": 12, "background": 1,
                  "camera": {{"position": [0, -4, 0.2], "target": [0, 0, 0], "fov": 40}},
                  "materials": {{"g": {{"transmission": 0.9, "index": 1.1}}}}, "objects": [{}]}})",
                                          objects));
    const ProgramResult early = run({"f.json", "-q", "-o", "f#.exr", "--frames", "0-2"});
    EXPECT_EQ(early.code, 0) << early.error;
    for (const char* lanes : {"1", "16"})
        for (const std::vector<std::string>& more :
             {std::vector<std::string>{}, {"--target-error", "0.05"}, {"--precision", "double"}}) {
            std::vector<std::string> arguments = {"f.json", "-q", "-o", "f#.exr", "--frames", "3", "--lanes", lanes};
            arguments.insert(arguments.end(), more.begin(), more.end());
            const ProgramResult result = run(arguments);
            EXPECT_EQ(result.code, 1);
            EXPECT_NE(result.error.find("frame 3 cannot be trusted and is not written: a ray was inside more than 8 "
                                        "solids at once, which is all it can list: outer 0, outer 1, outer 2, outer "
                                        "3, outer 4, inner 0, inner 1, inner 2, inner 3; take some away"),
                      std::string::npos)
                << result.error;
        }
}

/// Memory for trees has a bound.
TEST_F(PixelReports, RefuseToFollowRaysWithoutEnd) {
    expect_refused({CISTULA_SOURCE_DIR "/scenes/hard/furnace.json", "--pixel", "30,27", "--depth", "1024"},
                   ExitCode::failed, "the pixel's rays branch too often to be followed one by one");
}

}  // namespace
}  // namespace cistula
