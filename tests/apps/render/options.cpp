#include "apps/common/render_options.h"

#include <gtest/gtest.h>
#include <poll.h>
#include <pty.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "apps/common/sequence_progress.h"
#include "apps/common/step_progress.h"
#include "apps/render/explain.h"
#include "cistula/transport/ray_tree.h"
#include "image/picture/stored_picture.h"
#include "render/record/film_difference.h"
#include "render/record/film_picture.h"
#include "render/record/frame_header.h"
#include "render/renderer.h"
#include "scene/readers/json_reader.h"
#include "sequence/sequence_loop.h"
#include "sequence/stats.h"
#include "testing/support/expect_error.h"
#include "testing/support/scene.h"
#include "testing/support/scratch_directory.h"

namespace cistula {
namespace {

RenderCommand parse(std::vector<const char*> arguments) {
    arguments.insert(arguments.begin(), "render");
    return parse_options(static_cast<int>(arguments.size()), arguments.data());
}

void expect_refused(const std::vector<const char*>& arguments, const std::string& message) {
    EXPECT_ERROR(parse(arguments), ExitCode::usage, message);
}

TEST(RenderOptions, Defaults) {
    const RenderCommand options = parse({"s.json"});
    EXPECT_EQ(options.action, Action::render);
    EXPECT_EQ(options.scene, "s.json");
    EXPECT_EQ(options.backend, Backend::embree);
    EXPECT_FALSE(options.devices.all);
    EXPECT_EQ(options.devices.indices, (std::vector<int>{0}));
    EXPECT_EQ(options.precision, std::nullopt);
    EXPECT_EQ(options.progress, ProgressStyle::automatic);
    EXPECT_TRUE(options.output.empty() && options.frames.empty() && options.preview.empty() && options.stats.empty());
    for (const RequestKey& key : request_keys())
        EXPECT_EQ(key.given(options), key.name == "scene") << key.name << ": " << key.text(options);
    EXPECT_FALSE(options.channels.half || options.channels.error || options.resume || options.quiet || options.verbose);
    EXPECT_EQ(options.threads, 0);
}

TEST(RenderOptions, AllTogether) {
    const RenderCommand options = parse({"-o",
                                         "b.####.exr",
                                         "-f",
                                         "0-10x5,7",
                                         "--backend",
                                         "cuda",
                                         "--device",
                                         "2,0",
                                         "--res",
                                         "320x180",
                                         "--crop=8x4+16+2",
                                         "--supersample",
                                         "3",
                                         "--depth",
                                         "9",
                                         "--cutoff",
                                         "1e-3",
                                         "--precision",
                                         "double",
                                         "--threads",
                                         "2",
                                         "--bits",
                                         "half",
                                         "--preview",
                                         "p.png",
                                         "--layers",
                                         "error,Z",
                                         "--stats",
                                         "s.json",
                                         "--resume",
                                         "--progress",
                                         "plain",
                                         "-v",
                                         "-"});
    EXPECT_EQ(options.scene, "-");
    EXPECT_EQ(options.output, "b.####.exr");
    EXPECT_EQ(options.frames, (std::vector<int>{0, 5, 10, 7}));
    EXPECT_EQ(options.backend, Backend::cuda);
    EXPECT_EQ(options.devices.indices, (std::vector<int>{2, 0}));
    EXPECT_EQ(options.frame.full_width, 320);
    EXPECT_EQ(options.frame.full_height, 180);
    EXPECT_EQ(options.frame.crop, (PixelRect{16, 2, 8, 4}));
    EXPECT_EQ(options.frame.supersample, 3);
    EXPECT_EQ(options.frame.depth, 9);
    EXPECT_EQ(options.frame.cutoff, 1e-3);
    EXPECT_EQ(options.precision, Precision::double_);
    EXPECT_EQ(options.threads, 2);
    EXPECT_EQ(options.preview, "p.png");
    EXPECT_EQ(options.stats, "s.json");
    EXPECT_EQ(options.progress, ProgressStyle::plain);
    EXPECT_TRUE(options.channels.half && options.channels.error && options.channels.z && options.resume &&
                options.verbose);
    EXPECT_FALSE(options.channels.id || options.channels.samples || options.channels.cost || options.channels.normal);
}

TEST(RenderOptions, Actions) {
    EXPECT_EQ(parse({"--help"}).action, Action::print_help);
    EXPECT_EQ(parse({"-h", "s.json", "-o", "a.exr"}).action, Action::print_help);
    EXPECT_EQ(parse({"--version"}).action, Action::print_version);
    EXPECT_EQ(parse({"--print-template"}).action, Action::print_template);
    EXPECT_EQ(parse({"--list-devices"}).action, Action::list_devices);
    EXPECT_EQ(parse({"--list-devices", "--explain"}).action, Action::list_devices);
    EXPECT_EQ(parse({"--list-devices", "--help"}).action, Action::print_help);
    EXPECT_EQ(parse({"s.json", "--explain"}).action, Action::explain);
    EXPECT_EQ(parse({"s.json", "--explain=measure"}).action, Action::measure);
    EXPECT_EQ(parse({"--explain", "s.json"}).action, Action::explain);
    EXPECT_EQ(parse({"--explain", "s.json"}).scene, "s.json");
    EXPECT_EQ(parse({"--explain", "--explain=measure", "s.json"}).action, Action::measure);
    expect_refused({"s.json", "--explain=mesure"},
                   "--explain mesure: must be needs or measure; did you mean 'measure'?");
    expect_refused({"s.json", "--explain=measure", "--target-error", "0.01"},
                   "--explain measure: --target-error has no place here: it times the samples of a grid; --supersample "
                   "chooses one; "
                   "leave it out");
    EXPECT_EQ(parse({"s.json", "--effects", "auto"}).frame.effects, 0u);
    EXPECT_EQ(parse({"s.json", "--effects", "all"}).frame.effects, all_effects);
    expect_refused({"s.json", "--effects", "most"}, "--effects most: must be auto or all; known names: auto, all");
    const RenderCommand pixel = parse({"s.json", "--pixel", "12,034", "--json", "-", "-f", "7", "-v"});
    EXPECT_EQ(pixel.action, Action::pixel);
    EXPECT_EQ(pixel.pixel.x, 12);
    EXPECT_EQ(pixel.pixel.y, 34);
    EXPECT_EQ(pixel.json, "-");
    EXPECT_EQ(pixel.frames, (std::vector<int>{7}));
}

/// A request with a value of every key, none the default, but for a target error, which excludes others.
RenderRequest request_of_all(bool with_target) {
    const std::map<std::string_view, const char*> values = {{"scene", "s.json"},
                                                            {"output", "o.exr"},
                                                            {"frames", "0-10x5,7"},
                                                            {"backend", "cuda"},
                                                            {"device", "2,0"},
                                                            {"resolution", "320x180"},
                                                            {"crop", "8x4+16+2"},
                                                            {"tiles", "4x3"},
                                                            {"tile", "11"},
                                                            {"supersample", "3"},
                                                            {"depth", "9"},
                                                            {"cutoff", "0.001"},
                                                            {"target_error", "0.5"},
                                                            {"max_samples", "64"},
                                                            {"effects", "all"},
                                                            {"precision", "double"},
                                                            {"threads", "2"},
                                                            {"lanes", "8"},
                                                            {"max_texture_gb", "0.5"},
                                                            {"bits", "half"},
                                                            {"strict", "true"},
                                                            {"layers", "Z,error"},
                                                            {"split", "parts"},
                                                            {"z_far", "inf"},
                                                            {"background", "transparent"},
                                                            {"colorspace", "lin_ap1_scene"},
                                                            {"compression", "dwab"},
                                                            {"dwa_level", "20.5"},
                                                            {"preview", "p.png"},
                                                            {"exposure", "-1.5"},
                                                            {"view", "filmic"},
                                                            {"bloom", "2"},
                                                            {"stats", "t.json"},
                                                            {"resume", "true"},
                                                            {"progress", "json"},
                                                            {"quiet", "true"},
                                                            {"verbose", "true"}};
    RenderRequest request;
    for (const RequestKey& key : request_keys()) {
        const bool of_target = key.name == "target_error" || key.name == "max_samples";
        if (of_target != with_target && (of_target || key.name == "supersample" || key.name == "cutoff")) continue;
        EXPECT_FALSE(key.given(request)) << key.name;
        key.set(request, values.at(key.name));
        EXPECT_TRUE(key.given(request)) << key.name;
        EXPECT_EQ(key.text(request), values.at(key.name)) << key.name;
    }
    return request;
}

TEST(RequestKeys, TextsAreReadBackAndNoTwoKeysShareAMember) {
    for (const bool with_target : {false, true}) {
        const RenderRequest all = request_of_all(with_target);
        for (const RequestKey& key : request_keys()) {
            if (!key.given(all) || key.name == "device") continue;  // which asks for the backend
            RenderRequest one;
            key.set(one, key.text(all));
            for (const RequestKey& other : request_keys())
                EXPECT_EQ(other.given(one), other.name == key.name) << other.name << " by " << key.name;
        }
    }
}

TEST(RequestKeys, HeadersTellThoseThatHaveAnAttribute) {
    SceneDescription scene;
    for (const bool with_target : {false, true}) {
        const RenderRequest request = request_of_all(with_target);
        const FrameSettings settings = frame_settings(request, scene);
        Film film;
        film.full_width = film.full_height = film.rect.width = film.rect.height = 1;
        film.pixels.assign(1);
        Attributes attributes = to_layers(film, request.channels).attributes;
        attributes.merge(
            header_attributes(FrameHashes("abc"), settings, *request.precision, camera_at(scene.camera, 0)));
        for (const RequestKey& key : request_keys()) {
            if (key.attribute.empty() || !key.given(request)) continue;
            const auto found = attributes.find(std::string(key.attribute));
            ASSERT_NE(found, attributes.end()) << key.attribute;
            RenderRequest read;
            key.set(read, attribute_text(found->second));
            EXPECT_EQ(key.text(read), key.text(request)) << key.name;
        }
    }
}

TEST(RequestKeys, ThePagesHaveEveryOption) {
    const std::string pages = std::string(CISTULA_SOURCE_DIR) + "/docs/programs/";
    const std::string page = bytes_of(pages + "render.md") + bytes_of(pages + "running.md");
    for (const RequestKey& key : request_keys())
        EXPECT_NE(page.find("`" + option_name(key.name)), std::string::npos) << key.name;
}

TEST(RequestKeys, AreReadFromJsonAsFromText) {
    const auto read = [](const char* name, const char* json) {
        RenderRequest request;
        read_key(request, request_key(name), JsonValue(Json::parse(json), "s", "/a"));
        return request_key(name).text(request);
    };
    EXPECT_EQ(read("depth", "7") + read("cutoff", "0.25") + read("bits", "\"half\"") + read("strict", "true"),
              "70.25halftrue");
    EXPECT_EQ(read("resolution", "[64, 48]") + " " + read("crop", "[8, 6, 2, 1]"), "64x48 8x6+2+1");
    EXPECT_EQ(read("frames", "5") + " " + read("frames", "\"3-5\""), "5 3-5");
    const auto refused = [&](const char* name, const char* json, const char* message) {
        EXPECT_ERROR(read(name, json), ExitCode::usage, std::string("s: /a: ") + message);
    };
    refused("depth", "1025", "1025: must be a whole number from 1 to 1024");
    refused("depth", "2.5", "2.5: must be a whole number from 1 to 1024");
    refused("depth", "\"2\"", "expected a whole number from 1 to 1024, found '2'");
    refused("strict", "1", "expected true or false, found 1");
    refused("scene", "5", "expected a string that is not empty, found 5");
    refused("scene", "\"\"", "expected a string that is not empty, found an empty string");
    refused("crop", "[1, 2]", "[1,2]: must be WIDTHxHEIGHT+X+Y in pixels from the top left, as in 64x64+128+96");
}

TEST(RenderOptions, HelpNamesEveryOptionAndExitCode) {
    const std::string help = help_text();
    for (const char* part : {"--output",       "--frames",
                             "--backend",      "--res",
                             "--crop",         "--supersample",
                             "--depth",        "--cutoff",
                             "--precision",    "--threads",
                             "--lanes",        "--bits",
                             "--preview",      "--exposure",
                             "--view",         "--bloom",
                             "--layers",       "--split",
                             "--explain",      "--pixel",
                             "--json",         "--effects",
                             "--stats",        "--resume",
                             "--progress",     "--quiet",
                             "--verbose",      "--help",
                             "--device ",      "--list-devices",
                             "--version",      "--print-template",
                             "Examples:",      "Exit codes: 0 done",
                             "130 interrupted"})
        EXPECT_NE(help.find(part), std::string::npos) << part;
}

TEST(RenderOptions, Errors) {
    expect_refused({}, "no scene is given: render SCENE -o FILE.exr, or - for standard input; --help tells more");
    expect_refused({"a.json", "b.json"}, "b.json: one scene at a time, and a.json is it already");
    expect_refused({"s", "--dept", "3"}, "--dept: no such option; did you mean '--depth'?; --help lists them");
    expect_refused({"s", "--dept=3"}, "--dept=3: no such option; did you mean '--depth'?; --help lists them");
    for (const char* depth : {"0", "-1", "1025", "x", "4.0", "4 "})
        expect_refused({"s", "--depth", depth},
                       std::string("--depth ") + depth + ": must be a whole number from 1 to 1024");
    expect_refused({"s", "--supersample", "65"}, "--supersample 65: must be a whole number from 1 to 64");
    expect_refused({"s", "--threads", "0"}, "--threads 0: must be a whole number from 1 to 1024");
    expect_refused({"s", "--lanes", "17"}, "--lanes 17: must be a whole number from 1 to 16");
    for (const char* cutoff : {"-1", "nan", "inf", "1e", "x"})
        expect_refused(
            {"s", "--cutoff", cutoff},
            std::string("--cutoff ") + cutoff + ": must be a number from 0 to 1e30, in the scene's units of radiance");
    expect_refused({"s", "--backend", "cud"}, "--backend cud: must be embree or cuda; did you mean 'cuda'?");
    expect_refused({"s", "--precision", "half"},
                   "--precision half: must be auto or float or double; known names: auto, float, double");
    expect_refused({"s", "--bits", "hal"}, "--bits hal: must be float or half; did you mean 'half'?");
    expect_refused({"s", "--progress", "plane"},
                   "--progress plane: must be auto or plain or none or json or openjd; did you mean 'plain'?");
    expect_refused({"s", "--layers", "N", "--aov", "Z"}, "--aov Z: is another name of --layers; give one of them");
    expect_refused({"s", "-q", "-v"}, "-q and -v exclude each other; give one");
    expect_refused({"s", "--frames", "9-3"}, "--frames 9-3: 9-3 runs backward; write 3-9");
    EXPECT_THROW(parse({"s", "-o"}), Error);
    EXPECT_THROW(parse({"s", "-o", ""}), Error);
    EXPECT_THROW(parse({"s", "--depth", "3", "--depth", "4"}), Error);
}

TEST(RenderOptions, TargetErrors) {
    for (const char* part : {"--target-error", "--max-samples", "5 target error not met"})
        EXPECT_NE(help_text().find(part), std::string::npos) << part;
    for (const auto& [text, value] : {std::pair("0.004", 0.004), {"1e-3", 1e-3}, {"7", 7.0}, {"1e-300", 1e-300}}) {
        const RenderCommand options = parse({"s", "--target-error", text});
        EXPECT_EQ(options.frame.target_error, value);
        EXPECT_EQ(options.frame.max_samples, 256);
    }
    for (const auto& [text, value] : {std::pair("5", 5), {"64", 64}, {"256", 256}})
        EXPECT_EQ(parse({"s", "--target-error", "1", "--max-samples", text}).frame.max_samples, value);
    EXPECT_EQ(parse({"s", "--target-error", "1", "--depth", "3"}).frame.depth, 3);
    for (const char* target : {"0", "-0", "-1", "nan", "inf", "1e", "x", "0.1 ", "0,1"})
        expect_refused({"s", "--target-error", target},
                       std::string("--target-error ") + target +
                           ": must be a number above 0, to 1e30, in the scene's units of radiance");
    for (const char* samples : {"0", "4", "257", "-5", "x", "8.0"})
        expect_refused({"s", "--target-error", "1", "--max-samples", samples},
                       std::string("--max-samples ") + samples + ": must be a whole number from 5 to 256");
    expect_refused({"s", "--max-samples", "64"}, "--max-samples 64: is for --target-error");
    expect_refused({"s", "--target-error", "0.1", "--supersample", "2"},
                   "--target-error 0.1: --supersample has no place here: pixels get as many samples as they need; "
                   "leave it out");
    expect_refused({"s", "--cutoff", "0", "--target-error", "0.1"},
                   "--target-error 0.1: --cutoff has no place here: a quarter of the target is the cutoff; leave it "
                   "out");
    expect_refused({"s", "--target-error", "0.1", "--pixel", "1,2"},
                   "--pixel 1,2: --target-error has no place here: it shows the samples of a grid; --supersample "
                   "chooses one; leave it out");
}

TEST(RenderOptions, ATargetGoesAsDeepAsItTakes) {
    SceneDescription scene;
    scene.film.supersample = 3;
    scene.depth = 7;
    scene.cutoff = 0.25;
    const FrameSettings target = frame_settings(parse({"s", "--target-error", "0.004"}), scene);
    EXPECT_TRUE(target.adaptive());
    EXPECT_EQ(target.target_error, 0.004);
    EXPECT_EQ(target.truncation(), 0.001);  // whatever the scene's cutoff
    EXPECT_EQ(target.grid(), 16);           // whatever the scene's grid
    EXPECT_EQ(target.depth, largest_depth);
    EXPECT_EQ(target.max_samples, 256);
    const FrameSettings given =
        frame_settings(parse({"s", "--target-error", "0.004", "--depth", "2", "--max-samples", "9"}), scene);
    EXPECT_EQ(given.depth, 2);
    EXPECT_EQ(given.max_samples, 9);
    const FrameSettings fixed = frame_settings(parse({"s"}), scene);
    EXPECT_FALSE(fixed.adaptive());
    EXPECT_EQ(fixed.depth, 7);
    EXPECT_EQ(fixed.grid(), 3);
    EXPECT_EQ(fixed.truncation(), 0.25);
}

TEST(RenderOptions, Devices) {
    EXPECT_TRUE(parse({"s", "--backend", "cuda", "--device", "all"}).devices.all);
    for (const char* device : {"x", "-1", "0,", ",1", "0;1", "0, 1", "ALL", "all,0", "99999999999"})
        expect_refused({"s", "--backend", "cuda", "--device", device},
                       std::string("--device ") + device +
                           ": must be numbers of GPUs, as in 0 or 0,2, or all; render --list-devices shows them");
    expect_refused({"s", "--backend", "cuda", "--device", "1,0,1"},
                   "--device 1,0,1: names GPU 1 twice; once is enough");
    for (const char* device : {"0", "all", "x"})
        expect_refused({"s", "--device", device},
                       std::string("--device ") + device +
                           ": chooses GPUs, and --backend is embree; add --backend cuda or leave it out");
}

std::vector<int> picked(const DeviceChoice& choice, const std::vector<CudaDevice>& present) {
    std::vector<int> indices;
    for (const CudaDevice& device : pick_devices(choice, present)) indices.push_back(device.index);
    return indices;
}

TEST(Backends, DevicesAreThoseThatWereChosenAndCanBeUsed) {
    const std::vector<CudaDevice> present = {{0, "Old", 6, 1, size_t{1} << 30, 8, "capability 6.1 is below 7.5"},
                                             {1, "New", 9, 0, size_t{3} << 29, 132, ""},
                                             {2, "New", 9, 0, size_t{3} << 29, 132, ""}};
    EXPECT_EQ(picked({true, {}}, present), (std::vector<int>{1, 2}));
    EXPECT_EQ(picked({false, {2, 1}}, present), (std::vector<int>{2, 1}));
    EXPECT_ERROR(picked({false, {1, 3}}, present), ExitCode::device,
                 "--device 3: there is no such GPU; this machine has 0, 1, 2");
    EXPECT_ERROR(picked({}, present), ExitCode::device, "--device 0: Old cannot be used: capability 6.1 is below 7.5");
    EXPECT_ERROR(picked({true, {}}, {present[0]}), ExitCode::device,
                 "--device all: no GPU can be used; 0: Old: capability 6.1 is below 7.5");
    EXPECT_ERROR(picked({true, {}}, {}), ExitCode::device, "--device all: this machine has no GPU");
    EXPECT_ERROR(picked({}, {}), ExitCode::device, "--device 0: there is no such GPU; this machine has none");
    EXPECT_EQ(list_devices_text(present),
              "0: Old, capability 6.1, 1.0 GiB, 8 multiprocessors; cannot be used: capability 6.1 is below 7.5\n"
              "1: New, capability 9.0, 1.5 GiB, 132 multiprocessors\n"
              "2: New, capability 9.0, 1.5 GiB, 132 multiprocessors\n");
    EXPECT_EQ(list_devices_text({}), "no GPU\n");
}

TEST(Backends, EmbreeUsesNoDevice) {
    const ChosenDevices none = choose_devices(Backend::embree, {true, {}});
    EXPECT_TRUE(none.options.devices.empty() && none.names.empty() && none.driver.empty());
}

TEST(Backends, WithoutCudaThereIsNothingInstead) {
    if (has_cuda_backend()) GTEST_SKIP() << "this build has the CUDA backend";
    const std::string message = "--backend cuda: this build has no CUDA backend; --backend embree renders on the CPU";
    EXPECT_ERROR(choose_devices(Backend::cuda, {}), ExitCode::device, message);
    EXPECT_ERROR(make_renderer<float>(Backend::cuda, nullptr, {}), ExitCode::device, message);
    EXPECT_ERROR(make_renderer<double>(Backend::cuda, nullptr, {}), ExitCode::device, message);
    EXPECT_EQ(list_devices_text(), "no GPU: this build has no CUDA backend\n");
}

TEST(Backends, WithOneKernelThereIsNothingInstead) {
    if (!has_cuda_backend() || CISTULA_EVERY_KERNEL) GTEST_SKIP() << "this build has every kernel, or none";
    const std::string message =
        "this build has one kernel of many, to see that it compiles, and uses no GPU; make with CUDA=yes, or CMake "
        "with "
        "-DCISTULA_EVERY_KERNEL=ON, builds all; --backend embree renders on the CPU";
    EXPECT_ERROR(choose_devices(Backend::cuda, {}), ExitCode::device, message);
    EXPECT_ERROR(make_renderer<float>(Backend::cuda, compile_scene<float>(SceneDescription()), {}), ExitCode::device,
                 message);
    EXPECT_EQ(with_options(list_devices_text()), message + "\n");
}

TEST(Stats, NameTheGpusWhereOnesRan) {
    RunStats stats;
    const ScratchDirectory scratch;
    const auto context = [&] {
        StatsFile(scratch.file("s.json"), {}, !stats.devices.empty()).finish(stats);
        return nlohmann::json::parse(bytes_of(scratch.file("s.json"))).at("context");
    };
    EXPECT_EQ(context().at("backend"), "embree");
    EXPECT_FALSE(context().contains("devices") || context().contains("driver"));
    stats.backend = Backend::cuda;
    stats.devices = {"New", "Newer"};
    stats.driver = "13.0";
    EXPECT_EQ(context().at("backend"), "cuda");
    EXPECT_EQ(context().at("devices"), nlohmann::json({"New", "Newer"}));
    EXPECT_EQ(context().at("driver"), "13.0");
}

TEST(RenderOptions, Sizes) {
    for (const char* text :
         {"", "640", "640x", "x480", "0x480", "640x-1", "640x480x2", "640X480", "65537x1", "640x480+0+0"})
        EXPECT_ERROR(parse_size(text), ExitCode::usage, "must be WIDTHxHEIGHT, each from 1 to 65536, as in 1280x720");
    for (const char* text :
         {"", "8x8", "8x8+1", "8x8+1+", "8x8+-1+0", "8x8+1+-1", "8x8--1+0", "8x8-+0", "8x8+1+1+1", "0x8+0+0", "8+1+1"})
        EXPECT_ERROR(parse_crop(text), ExitCode::usage,
                     "must be WIDTHxHEIGHT+X+Y in pixels from the top left, as in 64x64+128+96");
    for (const PixelRect& rect : {PixelRect{0, 0, 8, 9}, PixelRect{3, -4, 8, 9}, PixelRect{-3, 0, 8, 9}})
        EXPECT_EQ(parse_crop(format_rect(rect)), rect) << format_rect(rect);  // as it is printed
}

TEST(RenderOptions, Layers) {
    const OutputChannels all = parse_layers("N,Z,cost,samples,id,error,id");
    EXPECT_TRUE(all.normal && all.z && all.cost && all.samples && all.id && all.error);
    const OutputChannels groups = parse_layers("path,cryptomatte,uv");
    EXPECT_TRUE(groups.path[0] && groups.path[path_layer_count - 1] && groups.uv && !groups.light && !groups.z);
    EXPECT_TRUE(groups.object_mattes && groups.material_mattes && groups.light_mattes);
    const OutputChannels lights = parse_layers("Combined_key,Z,Combined_glow");
    EXPECT_TRUE(lights.light && lights.z);
    EXPECT_EQ(lights.light_layers, (std::vector<std::string>{"key", "glow"}));
    EXPECT_TRUE(parse_layers("Combined_key,light").light_layers.empty());
    LayerNames known;
    known.light_groups = {"key", "fill"};
    require_light_layers(lights, known);
    known.light_groups = {"keys", "fill"};
    EXPECT_ERROR(
        require_light_layers(lights, known), ExitCode::usage,
        "--layers Combined_key: the scene has no such group of lights; the groups are: keys, ambient, environment, "
        "glow, fill");
    const OutputChannels data = parse_layers("data");
    EXPECT_TRUE(data.position && data.material_id && data.error && data.coverage && !data.path[0]);
    EXPECT_TRUE(parse_layers("light").light && parse_layers("specular").path[4]);
    const OutputChannels every = parse_layers("Combined_key,all");
    EXPECT_TRUE(every.light && every.light_layers.empty() && every.path[0] && every.error && every.light_mattes);
    const auto message_of = [](const char* text) -> std::string {
        try {
            parse_layers(text);
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::usage);
            return error.what();
        }
        return "";
    };
    const std::string eror = message_of("eror"), empty = message_of("id,");
    EXPECT_EQ(eror.rfind("there is no layer 'eror'; the layers are: error, ", 0), 0u) << eror;
    for (const char* layer : {"path", "light", "data", "cryptomatte", "material_id", "transmission", "CryptoLight"})
        EXPECT_NE(eror.find(layer), std::string::npos) << layer;
    EXPECT_EQ(empty.rfind("there is no layer ''; the layers are: ", 0), 0u) << empty;
}

TEST(RenderOptions, OptionsOverrideTheScene) {
    SceneDescription scene;
    scene.film.width = 100;
    scene.film.height = 50;
    scene.film.supersample = 2;
    scene.depth = 7;
    scene.cutoff = 0.25;
    const FrameSettings own = frame_settings(parse({"s"}), scene);
    EXPECT_EQ(own.full_width, 100);
    EXPECT_EQ(own.full_height, 50);
    EXPECT_EQ(own.crop.width, 100);
    EXPECT_EQ(own.crop.height, 50);
    EXPECT_EQ(own.supersample, 2);
    EXPECT_EQ(own.depth, 7);
    EXPECT_EQ(own.cutoff, 0.25);
    EXPECT_EQ(own.parts, (KeptParts{false, false}));
    FrameSettings of_scene = frame_settings(scene);
    of_scene.parts = own.parts;
    EXPECT_EQ(own, of_scene);
    EXPECT_EQ(frame_settings(parse({"s", "--layers", "error"}), scene).parts, KeptParts());
    EXPECT_EQ(frame_settings(parse({"s", "--layers", "Z"}), scene).parts, (KeptParts{false, true}));
    const FrameSettings given = frame_settings(
        parse({"s", "--res", "20x10", "--crop", "5x10+15+0", "--supersample", "1", "--depth", "1", "--cutoff", "0"}),
        scene);
    EXPECT_EQ(given.full_width, 20);
    EXPECT_EQ(given.full_height, 10);
    EXPECT_EQ(given.crop.x, 15);
    EXPECT_EQ(given.supersample, 1);
    EXPECT_EQ(given.depth, 1);
    EXPECT_EQ(given.cutoff, 0);
    for (const char* crop : {"5x10+16+0", "5x10+15+1", "101x1+0+0", "1x1+2147483647+0", "1x1+0+2147483647"})
        EXPECT_ERROR(frame_settings(parse({"s", "--res", "20x10", "--crop", crop}), scene), ExitCode::usage,
                     std::string("--crop ") + crop + ": leaves the frame, which is 20x10");
}

TEST(HeaderAttributes, MatricesTakePointsWhereTheCameraSeesThem) {
    CameraDescription description;
    description.position = {3, -5, 2};
    description.target = {0.5, 1, 0.25};
    description.field_of_view = 70;
    const Camera camera = camera_at(description, 0).camera;
    const auto transformed = [](const std::vector<float>& m, const Vec3<double>& p) {
        std::array<double, 4> q{};
        for (size_t c = 0; c < 4; ++c) q[c] = p.x * m[c] + p.y * m[4 + c] + p.z * m[8 + c] + m[12 + c];
        return q;
    };
    const int width = 320, height = 180;
    for (const double x : {0.5, 100.0, 319.5})
        for (const double y : {0.5, 90.0, 150.25})
            for (const double distance : {0.25, 6.0}) {
                const Vec3<double> direction = camera_direction(camera, x, y, width, height);
                const Vec3<double> point = camera.position + distance * direction;
                const double depth = distance * dot(direction, camera.forward);
                const auto ndc = transformed(world_to_ndc(camera, width, height), point);
                EXPECT_NEAR(ndc[3], depth, 1e-5);
                EXPECT_NEAR(ndc[0] / ndc[3], x / width, 2e-5);
                EXPECT_NEAR(ndc[1] / ndc[3], y / height, 2e-5);
                EXPECT_NEAR(ndc[2] / ndc[3], 1 - 1 / depth, 2e-5);
                const auto seen = transformed(world_to_camera(camera), point);
                EXPECT_NEAR(seen[0], distance * dot(direction, camera.right), 1e-5);
                EXPECT_NEAR(seen[1], distance * dot(direction, camera.up), 1e-5);
                EXPECT_NEAR(seen[2], depth, 1e-5);
                EXPECT_EQ(seen[3], 1);
            }
}

TEST(HeaderAttributes, TellImagesApart) {
    FrameSettings settings;
    CameraFrame camera;
    camera.camera.position = {0, 0, 0};
    camera.camera.forward = {0, 1, 0};
    camera.camera.right = {1, 0, 0};
    camera.camera.up = {0, 0, 1};
    LayeredPicture picture;
    picture.width = picture.display_width = 4;
    picture.height = picture.display_height = 2;
    picture.channels = {{"R", false, {}}, {"G", false, {}}};
    picture.attributes = header_attributes(FrameHashes("abc"), settings, Precision::single_, camera);
    EXPECT_TRUE(is_same_image(picture, picture));
    const auto differs = [&](const std::function<void(LayeredPicture&)>& change) {
        LayeredPicture other = picture;
        change(other);
        return !is_same_image(other, picture);
    };
    EXPECT_TRUE(differs([](LayeredPicture& p) { p.x = 1; }));
    EXPECT_TRUE(differs([](LayeredPicture& p) { p.display_width = 5; }));
    EXPECT_TRUE(differs([](LayeredPicture& p) { p.channels[0].half = true; }));
    EXPECT_TRUE(differs([](LayeredPicture& p) { p.channels.pop_back(); }));
    EXPECT_TRUE(differs([](LayeredPicture& p) { p.compression = Compression::dwaa; }));
    EXPECT_FALSE(differs([](LayeredPicture& p) { std::swap(p.channels[0], p.channels[1]); }));
    const auto attributes_differ = [&](const Attributes& attributes) {
        return differs([&](LayeredPicture& p) { p.attributes = attributes; });
    };
    EXPECT_TRUE(attributes_differ(header_attributes(FrameHashes("abd"), settings, Precision::single_, camera)));
    EXPECT_TRUE(attributes_differ(header_attributes(FrameHashes("abc"), settings, Precision::double_, camera)));
    FrameSettings other = settings;
    other.cutoff = 1e-9;
    EXPECT_TRUE(attributes_differ(header_attributes(FrameHashes("abc"), other, Precision::single_, camera)));
    other = settings;
    other.depth = 5;
    EXPECT_TRUE(attributes_differ(header_attributes(FrameHashes("abc"), other, Precision::single_, camera)));
    other = settings;
    other.supersample = 2;
    EXPECT_TRUE(attributes_differ(header_attributes(FrameHashes("abc"), other, Precision::single_, camera)));
    other = settings;
    other.target_error = 0.01;
    const Attributes target = header_attributes(FrameHashes("abc"), other, Precision::single_, camera);
    EXPECT_TRUE(attributes_differ(target));
    EXPECT_EQ(std::get<double>(target.at("cistula:targetError")), 0.01);
    EXPECT_EQ(std::get<double>(target.at("cistula:cutoff")), 0.0025);
    other.max_samples = 32;
    EXPECT_EQ(std::get<int>(
                  header_attributes(FrameHashes("abc"), other, Precision::single_, camera).at("cistula:maxSamples")),
              32);
    EXPECT_EQ(picture.attributes.count("cistula:targetError") + picture.attributes.count("cistula:maxSamples"), 0u);
    CameraFrame moved = camera;
    moved.frame = 1;
    EXPECT_TRUE(attributes_differ(header_attributes(FrameHashes("abc"), settings, Precision::single_, moved)));
    // What does not reach the image does not reach the header.
    other = settings;
    other.tile = 64;
    other.effects = all_effects;
    EXPECT_FALSE(attributes_differ(header_attributes(FrameHashes("abc"), other, Precision::single_, camera)));
}

TEST(Progress, Texts) {
    EXPECT_EQ(format_duration(0), "0:00");
    EXPECT_EQ(format_duration(6.2), "0:07");
    EXPECT_EQ(format_duration(754), "12:34");
    EXPECT_EQ(format_duration(3723), "1:02:03");
    EXPECT_EQ(format_rate(950), "950 rays/s");
    EXPECT_EQ(format_rate(12.34e6), "12.3 Mrays/s");
    EXPECT_EQ(format_rate(999.6e6), "1.00 Grays/s");
    ProgressState state{12, 2, 10, 0.5, 25, 3e6};
    EXPECT_DOUBLE_EQ(remaining_seconds(state), 75);
    EXPECT_EQ(progress_line(state), "frame 12 (3/10): 50 %, 3.0 Mrays/s, ETA 1:15");
    EXPECT_EQ(progress_bar(state, 64), "frame 12 (3/10) [########---------]  50 %  3.0 Mrays/s  ETA 1:15");
    for (int columns = 0; columns < 200; ++columns)
        EXPECT_LE(progress_bar(state, columns).size(), static_cast<size_t>(columns));
    state.index = 0;
    state.fraction = 0;
    EXPECT_LT(remaining_seconds(state), 0);
    EXPECT_EQ(progress_line(state), "frame 12 (1/10): 0 %, 3.0 Mrays/s, ETA ?");
}

/// Makes standard error a terminal as long as it lives.
class Terminal {
  public:
    Terminal() : before_(dup(STDERR_FILENO)) {
        int shown = -1;
        if (openpty(&seen_, &shown, nullptr, nullptr, nullptr) != 0) throw std::runtime_error("there is no terminal");
        dup2(shown, STDERR_FILENO);
        close(shown);
        setenv("TERM", "xterm", 1);
    }
    ~Terminal() {
        dup2(before_, STDERR_FILENO);
        close(before_);
        close(seen_);
    }

    /// Whether `text` appears within a minute, after what was found before.
    bool shows(const std::string& text) {
        const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(1);
        pollfd waited{seen_, POLLIN, 0};
        while (shown_.find(text) == std::string::npos) {
            char bytes[256];
            if (std::chrono::steady_clock::now() > end || poll(&waited, 1, 60'000) != 1) return false;
            shown_.append(bytes, static_cast<size_t>(std::max<ssize_t>(read(seen_, bytes, sizeof bytes), 0)));
        }
        shown_.erase(0, shown_.find(text) + text.size());
        return true;
    }

  private:
    const int before_;
    int seen_ = -1;
    std::string shown_;
};

TEST(Progress, IsDrawnAgainOnATerminalAndIsGoneInTheEnd) {
    Terminal terminal;
    {
        StepProgress progress(ProgressStyle::automatic);
        progress.begin("cases", 4);
        progress.name_part("geometry/fans");
        progress.advance();
        EXPECT_TRUE(terminal.shows("\rcases: geometry/fans: 25 %, ETA 0:"));
        progress.aside([] { std::fputs("a row\n", stderr); });
        EXPECT_TRUE(terminal.shows("\r\033[Ka row\r\n\rcases: geometry/fans: 25 %, ETA 0:"));
        progress.advance(2);
        progress.render.pixels_done = 50;
        progress.frame(100);
        EXPECT_TRUE(terminal.shows("\rcases: geometry/fans: 87 %"));
    }
    EXPECT_TRUE(terminal.shows("\033[K\r\033[K"));
}

TEST(Stats, LedgerTotalsAreInTheScenesUnits) {
    Film film;
    film.samples = 4;
    film.fixed_shift = 60;
    film.radiance_exponent = 1;
    film.pixels.assign(2);
    film.pixels.change(0, [](PixelRecord& pixel) { pixel.pruned[1] = int64_t{1} << 60; });
    film.pixels.change(1, [](PixelRecord& pixel) {
        pixel.pruned[1] = int64_t{1} << 62;
        pixel.cut[2] = int64_t{1} << 59;
        pixel.samples = 4;
        pixel.rays = 1 << 30;
    });
    film.totals = totals_of(film);
    const LedgerTotals pruned = ledger_totals(film, film.totals.pruned), cut = ledger_totals(film, film.totals.cut);
    EXPECT_EQ(pruned.mean, (std::array<double, 3>{0, 1.25, 0}));
    EXPECT_EQ(pruned.worst, (std::array<double, 3>{0, 2, 0}));
    EXPECT_EQ(cut.mean, (std::array<double, 3>{0, 0, 0.125}));
    EXPECT_EQ(cut.worst, (std::array<double, 3>{0, 0, 0.25}));
    EXPECT_EQ(unit_totals(film).worst, (std::array<double, 3>{0x1p-31, 0x1p-31, 0x1p-31}));
    EXPECT_EQ(unit_totals(film).mean, (std::array<double, 3>{0x1p-32, 0x1p-32, 0x1p-32}));
}

TEST(Stats, OfWhatTheDepthTookTheWorstFrameIsSaidOnce) {
    SequenceTotals totals;
    FrameStats frame;
    frame.file = "a.exr";
    frame.depth_loss = {0.0078125, 0.5, 0.5};  // just under what is seen
    totals.add(frame);
    EXPECT_EQ(describe_depth_loss(totals, "a.#.exr", 4), "");
    frame.frame = 7;
    frame.depth_loss = {0.15, 1.0, 0.5};
    totals.add(frame);
    frame.frame = 8;
    frame.depth_loss = {0.01, 0.1, 0.5};
    totals.add(frame);
    EXPECT_EQ(with_options(describe_depth_loss(totals, "a.#.exr", 4)),
              "a.#.exr: in 2 of 3 frames, most in frame 7: depth 4 may have taken up to 1 from a pixel and 0.15 in the "
              "mean, where the picture's mean is 0.5: see --depth and --layers error");
    SequenceTotals black;
    frame.depth_loss = {0.01, 0.1, 0};
    black.add(frame);
    EXPECT_NE(describe_depth_loss(black, "a.exr", 4), "");
}

TEST(Explain, NamesWhatIsNeededWhatRunsAndWhatIsLeftOut) {
    std::vector<EffectReason> reasons;
    for (int i = 0; i < effect_count; ++i)
        reasons.push_back(
            {1u << i, (1u << i) == effect_diffuse, (1u << i) == effect_diffuse ? "material clay" : "no reason"});
    const std::string table = explain_table("s.json", {reasons, {"a and b overlap"}}, Backend::cuda);
    EXPECT_NE(table.find("diffuse              yes     in        material clay\n"), std::string::npos) << table;
    EXPECT_NE(table.find("fresnel              no      left out  no reason\n"), std::string::npos) << table;
    EXPECT_NE(table.find("5 sets of effects for which code is compiled, number 1 runs"), std::string::npos) << table;
    const std::string on_cpu = explain_table("s.json", {reasons, {}}, Backend::embree);
    EXPECT_NE(on_cpu.find("3 sets of effects for which code is compiled, number 1 runs"), std::string::npos) << on_cpu;
    EXPECT_NE(on_cpu.find("transmission         no      in        no reason\n"), std::string::npos) << on_cpu;
    EXPECT_EQ(table.find("cost"), std::string::npos) << table;
    EXPECT_NE(table.find("\na and b overlap\n"), std::string::npos) << table;
    const EffectCosts costs{12.5, 7, {{effect_diffuse, 0.25}}};
    const std::string measured = explain_table("s.json", {reasons, {}}, Backend::cuda, &costs);
    EXPECT_NE(measured.find("diffuse              yes     in        25.0 %   material clay\n"), std::string::npos)
        << measured;
    EXPECT_NE(measured.find("fresnel              no      left out  -        no reason\n"), std::string::npos)
        << measured;
    EXPECT_NE(measured.find("7 frames of 12.5 ms"), std::string::npos) << measured;
}

/// Cubes in one another.
SceneDescription nested_cubes(int count) {
    SceneDescription scene;
    for (int i = 0; i < count; ++i) test::add_solid(scene, PlatonicSolid::cube, glm::dvec3(0), 1 + count - i);
    return scene;
}

TEST(RenderFlags, EveryFlagHasItsWords) {
    const SceneDescription scene = nested_cubes(InteriorList::capacity + 1);
    EXPECT_EQ(describe_flags(flag_not_finite, scene), "a radiance was infinite or not a number");
    EXPECT_EQ(
        describe_flags(flag_not_finite | flag_media_overflow, scene),
        "a radiance was infinite or not a number; a ray was inside more than 8 solids at once, which is all it can "
        "list: o0, o1, o2, o3, o4, o5, o6, o7, o8; take some away");
    EXPECT_EQ(describe_flags(flag_media_overflow, nested_cubes(2)),
              "a ray was inside more than 8 solids at once, which is all it can list; take some away");
    for (const RenderFlag flag : {flag_not_finite, flag_media_overflow, flag_stack_overflow, flag_too_many_crossings})
        EXPECT_FALSE(describe_flags(flag, scene).empty());
}

}  // namespace
}  // namespace cistula
