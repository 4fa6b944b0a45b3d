#include "apps/common/render_options.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "cistula/transport/ray_tree.h"
#include "image/picture/stored_picture.h"
#include "render/record/film_picture.h"
#include "render/record/frame_header.h"
#include "render/renderer.h"
#include "scene/readers/json_reader.h"
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
    for (const char* part : {"--output",       "--frames",         "--backend",    "--res",
                             "--crop",         "--supersample",    "--depth",      "--cutoff",
                             "--precision",    "--threads",        "--lanes",      "--bits",
                             "--preview",      "--exposure",       "--view",       "--bloom",
                             "--layers",       "--split",          "--explain",    "--pixel",
                             "--json",         "--explore",        "--explore-mb", "--effects",
                             "--stats",        "--resume",         "--progress",   "--quiet",
                             "--verbose",      "--help",           "--device ",    "--list-devices",
                             "--version",      "--print-template", "Examples:",    "Exit codes: 0 done",
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

}  // namespace
}  // namespace cistula
