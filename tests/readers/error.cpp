// What an error tells besides its text, and how texts name settings.
#include "base/error.h"

#include <gtest/gtest.h>

#include "base/file_bytes.h"
#include "render/record/film_picture.h"
#include "scene/assets/assets.h"
#include "sequence/render_request.h"
#include "testing/support/read_text.h"

namespace cistula {
namespace {

struct Told {
    ErrorKind kind;
    std::string subject, place, remedy;
    bool operator==(const Told&) const = default;
};
std::ostream& operator<<(std::ostream& out, const Told& told) {
    return out << int(told.kind) << " | " << told.subject << " | " << told.place << " | " << told.remedy;
}

Told told(const Error& error) {
    return {error.kind(), error.subject(), error.place(), error.remedy()};
}

template <class Run>
Error error_of(const Run& run) {
    try {
        run();
    } catch (const Error& error) {
        return error;
    }
    ADD_FAILURE() << "no error";
    return Error(ErrorKind::failed, "none");
}

TEST(Error, OfASceneHasItsPlace) {
    const Error key = error_of([] { test::json_scene(R"({"objects": [{"solid": "cube", "raduis": 1}]})"); });
    EXPECT_EQ(told(key), (Told{ErrorKind::scene, "", "a.json: /objects/0/raduis", "did you mean 'radius'?"}));
    EXPECT_EQ(std::string(key.what()), key.place() + ": unknown key; " + key.remedy());
    const Error syntax = error_of([] { test::json_scene("{\n  \"objects\": }"); });
    EXPECT_EQ(told(syntax), (Told{ErrorKind::scene, "", "a.json:2:14", ""}));
    const Error input = error_of([] { read_scene_text("3 nosuch", "s.txt", ""); });
    EXPECT_EQ(told(input), (Told{ErrorKind::scene, "", "s.txt:1", ""}));
}

TEST(Error, OfAFileHasItsPath) {
    const Error missing = error_of([] { read_file("/no/such"); });
    EXPECT_EQ(told(missing), (Told{ErrorKind::file, "", "/no/such", "check the spelling"}));
    EXPECT_STREQ(missing.what(), "/no/such: cannot read: No such file or directory; check the spelling");
    MeshObject mesh;
    mesh.file = "no.ply";
    SceneDescription scene;
    scene.source = "s.json";
    scene.objects.resize(1);
    scene.objects[0].place = "/objects/0";
    scene.objects[0].shape = mesh;
    EXPECT_EQ(told(error_of([&] { load_assets(scene); })),
              (Told{ErrorKind::file, "", "s.json: /objects/0: mesh no.ply", "check the path"}));
}

TEST(Error, OfASettingNamesItsKey) {
    RenderRequest request;
    const auto unknown = [&] { request_key("layers").set(request, "Zz"); };
    const Error layer = error_of(unknown).of("layers", "Zz");
    EXPECT_EQ(layer.kind(), ErrorKind::usage);
    EXPECT_EQ(layer.subject(), "layers");
    EXPECT_EQ(layer.remedy().rfind("the layers are: ", 0), 0u) << layer.remedy();
    EXPECT_EQ(std::string(layer.what()), "`layers` Zz: there is no layer 'Zz'; " + layer.remedy());
    const Error depth = error_of([&] { request_key("depth").set(request, "0"); }).of("depth", "0");
    EXPECT_EQ(std::string(depth.what()), "`depth` 0: " + depth.remedy());

    OutputChannels channels;
    channels.light = true;
    channels.light_layers = {"key"};
    EXPECT_EQ(error_of([&] { require_light_layers(channels, {}); }).subject(), "layers");

    const Error absent = error_of([] { pick_devices({false, {7}}, {}); });
    EXPECT_EQ(told(absent), (Told{ErrorKind::device, "device", "", "this machine has none"}));
    EXPECT_STREQ(absent.what(), "`device` 7: there is no such GPU; this machine has none");
}

TEST(Error, ReachesItsReaderWithPlaceAndNames) {
    const Error inner = Error(ErrorKind::usage, "is for `preview`", "leave `view` out").of("view", "a\nb").at("3");
    const Error error = inner.at("s.json").named(quoted_name);
    EXPECT_EQ(told(error), (Told{ErrorKind::usage, "view", "s.json: 3", "leave \"view\" out"}));
    EXPECT_STREQ(error.what(), "s.json: 3: \"view\" a\\nb: is for \"preview\"; leave \"view\" out");
}

TEST(Error, TextsNameSettingsAsProgramsDo) {
    EXPECT_EQ(with_options("`max_samples`, `resolution` and `output`"), "--max-samples, --res and -o");
    EXPECT_EQ(with_options("raise `fail`"), "raise --fail");
    // What is no setting's, such as names of files and objects, stays.
    for (const char* text : {"", "`", "``", "'`glass`'", "a `max-samples` `", "`layers"})
        EXPECT_EQ(with_options(text), text);
    EXPECT_EQ(with_options("a` and `b` and `layers`"), "a` and `b` and --layers");
    for (const RequestKey& key : request_keys()) {
        EXPECT_NE(option_name(key.name), "");
        EXPECT_EQ(with_options(key.help).find('`'), std::string::npos) << key.help;
    }
}

}  // namespace
}  // namespace cistula
