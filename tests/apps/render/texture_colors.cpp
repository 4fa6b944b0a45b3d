// Color spaces of textures: those of files, and the key that overrides them.
#include <map>

#include "image/color/color_encoding.h"
#include "image/exr/exr.h"
#include "image/picture/raw_picture.h"
#include "testing/support/render_program.h"

namespace cistula {
namespace {

using Attributes = decltype(LayeredPicture::attributes);

const std::vector<float> ap1 = {0.713f, 0.293f, 0.165f, 0.83f, 0.128f, 0.044f, 0.32168f, 0.33767f},
                         rec709 = {0.64f, 0.33f, 0.3f, 0.6f, 0.15f, 0.06f, 0.3127f, 0.329f};

class TextureColors : public RenderProgram {
  protected:
    /// Writes NAME.json: a quad that fills the picture, with t.exr, or what `keys` says, as its own light.
    void put_scene(const std::string& name, const std::string& keys, const std::string& picture = "t.exr") const {
        put_bytes(file(name + ".json"), R"({"film": {"width": 8, "height": 6}, "ambient": 1, "camera": {"fov": 20},
            "textures": {"t": {"file": ")" + picture +
                                            R"(", "filter": "nearest")" + keys + R"(}},
            "materials": {"m": {"texture": "t", "color": 1, "diffuse": 0}},
            "objects": [{"quad": [[-9, 0, -9], [9, 0, -9], [9, 0, 9], [-9, 0, 9]], "material": "m"}]})");
    }

    void write_texel(const std::vector<float>& color, const Attributes& attributes) const {
        LayeredPicture layers;
        layers.width = layers.display_width = layers.height = layers.display_height = 1;
        layers.channels = {{"R", false, {color[0]}}, {"G", false, {color[1]}}, {"B", false, {color[2]}}};
        layers.attributes = attributes;
        write_exr(file("t.exr"), layers);
    }

    /// The color of the quad.
    glm::vec3 shown(const std::string& scene, const std::string& out = "o.exr") {
        const ProgramResult result = run({scene + ".json", "-o", out, "--progress", "none"});
        EXPECT_EQ(result.code, 0) << result.error;
        error_ = result.error;
        const LayeredPicture layers = read_exr(file(out));
        std::map<std::string, float> middle;
        for (const auto& channel : layers.channels) middle[channel.name] = channel.values[8 * 3 + 4];
        hash_ = std::get<std::string>(layers.attributes.at("cistula:sceneHash"));
        return {middle["R"], middle["G"], middle["B"]};
    }

    static void expect_near(const glm::vec3& found, const glm::vec3& expected) {
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], expected[c], 3e-6f) << c;
    }

    std::string error_, hash_;
};

const glm::vec3 stored(0.5f, 0.25f, 0.1f), from_acescg(0.688752f, 0.219018f, 0.071053f);

TEST_F(TextureColors, WhatTheFileSaysIsConverted) {
    put_scene("t", "");
    const Attributes spaces[] = {{{"chromaticities", ap1}},
                                 {{"colorInteropID", std::string("lin_ap1_scene")}},
                                 {{"chromaticities", ap1}, {"colorInteropID", std::string("lin_ap1_scene")}}};
    for (const Attributes& attributes : spaces) {
        write_texel({0.5f, 0.25f, 0.1f}, attributes);
        expect_near(shown("t"), from_acescg);
    }
    const Attributes own[] = {{},
                              {{"chromaticities", rec709}},
                              {{"colorInteropID", std::string("unknown")}},
                              {{"colorInteropID", std::string("data")}, {"chromaticities", ap1}}};
    for (const Attributes& attributes : own) {
        write_texel({0.5f, 0.25f, 0.1f}, attributes);
        expect_near(shown("t"), stored);
    }
}

TEST_F(TextureColors, TheKeyOverridesTheFile) {
    put_scene("t", "");
    put_scene("linear", R"(, "colorspace": "linear")");
    put_scene("acescg", R"(, "colorspace": "lin_ap1_scene")");
    put_scene("srgb", R"(, "colorspace": "srgb")");
    const std::string refusal = "render: t.json: /textures/t: t.exr: cannot read: its colorInteropID ";
    const std::pair<Attributes, std::string> files[] = {
        {{{"colorInteropID", std::string("ocio:foo")}}, refusal + "'ocio:foo' is not known; "},
        {{{"colorInteropID", std::string("lin_ap1_scene")}, {"chromaticities", rec709}},
         refusal + "is lin_ap1_scene, but its chromaticities are those of lin_rec709_scene; "}};
    for (const auto& [attributes, reason] : files) {
        write_texel({0.5f, 0.25f, 0.1f}, attributes);
        expect_refused({"t.json", "-o", "t.out.exr"}, ExitCode::file, reason);
        expect_refused({"t.json", "-o", "t.out.exr"}, ExitCode::file,
                       "the key \"colorspace\" of a scene's texture overrides");
        EXPECT_FALSE(exists("t.out.exr"));
        expect_near(shown("linear"), stored);
        const std::string hash = hash_;
        expect_near(shown("acescg"), from_acescg);
        EXPECT_NE(hash_, hash);
        EXPECT_EQ(error_.find("warning"), std::string::npos) << error_;
        glm::vec3 decoded;
        for (int c = 0; c < 3; ++c)
            decoded[c] = static_cast<float>(elementary::srgb_to_linear(static_cast<double>(stored[c])));
        expect_near(shown("srgb"), decoded);
    }
}

TEST_F(TextureColors, RawPicturesAreSrgbUnlessTheKeySaysAnother) {
    write_raw_picture(file("t.data"), {1, 1, {glm::vec3(0.2f, 0.5f, 0.9f)}});
    const std::string bytes = bytes_of(file("t.data"));
    const auto codes = [&](const char* encoding) {
        glm::vec3 color;
        for (int c = 0; c < 3; ++c)
            color[c] = static_cast<float>(
                find_color_encoding(encoding)->curve(static_cast<uint8_t>(bytes[8 + static_cast<size_t>(c)]) / 255.0));
        return color;
    };
    put_scene("none", "", "t.data");
    expect_near(shown("none"), codes("srgb"));
    for (const char* encoding : {"srgb", "srgb_rec709_scene", "linear", "g22_rec709_scene", "data"}) {
        put_scene("t", R"(, "colorspace": ")" + std::string(encoding) + "\"", "t.data");
        expect_near(shown("t"), codes(encoding));
    }
}

TEST_F(TextureColors, OneFileIsTwoTexturesWithTwoKeys) {
    write_texel({0.5f, 0.25f, 0.1f}, {});
    put_bytes(file("two.json"), R"({"film": {"width": 8, "height": 6}, "ambient": 1, "camera": {"fov": 20},
        "textures": {"a": {"file": "t.exr"}, "b": {"file": "t.exr", "colorspace": "lin_ap1_scene"}},
        "materials": {"a": {"texture": "a", "color": 1, "diffuse": 0}, "b": {"texture": "b", "color": 1, "diffuse": 0}},
        "objects": [{"quad": [[-9, 0, -9], [0, 0, -9], [0, 0, 9], [-9, 0, 9]], "material": "a"},
                    {"quad": [[0, 0, -9], [9, 0, -9], [9, 0, 9], [0, 0, 9]], "material": "b"}]})");
    expect_near(shown("two"), from_acescg);
    const LayeredPicture layers = read_exr(file("o.exr"));
    for (const auto& channel : layers.channels)
        if (channel.name == "R") {
            EXPECT_NEAR(channel.values[8 * 3 + 1], stored.x, 3e-6f);
        }
}

TEST_F(TextureColors, APictureWrittenInAnySpaceIsTheSameTexture) {
    put_bytes(file("red.json"), std::string(scene_text).replace(0, 1, R"({"background": [1, 0, 0.25],)"));
    expect_done({"red.json", "-q", "-o", "t.exr"});
    put_scene("t", R"(, "strict": true)");
    shown("t", "own.exr");
    const LayeredPicture own = read_exr(file("own.exr"));
    for (const ColorSpace& space : color_spaces())
        for (const char* bits : {"float", "half"}) {
            expect_done({"red.json", "-q", "-o", "t.exr", "--colorspace", std::string(space.id), "--bits", bits});
            shown("t", "other.exr");
            const LayeredPicture other = read_exr(file("other.exr"));
            const float within = std::string(bits) == "half" ? 0x1p-9f : 0x1p-20f;
            for (size_t c = 0; c < own.channels.size(); ++c)
                for (size_t i = 0; i < own.channels[c].values.size(); ++i)
                    ASSERT_NEAR(other.channels[c].values[i], own.channels[c].values[i], within) << space.id << bits;
        }
}

TEST_F(TextureColors, ColorsThatRec709LacksAreClampedAndCounted) {
    write_texel({0, 1, 0}, {{"colorInteropID", std::string("lin_ap1_scene")}});
    put_scene("t", "");
    expect_near(shown("t"), {0, 1.140805f, 0});
    EXPECT_NE(error_.find("t.exr: values of its texels that are no radiance: 2 negative (taken as 0), of 3"),
              std::string::npos)
        << error_;
    put_scene("t", R"(, "strict": true)");
    expect_refused({"t.json", "-o", "o.exr"}, ExitCode::file, "texel (0, 0) has R = -0.6217");
}

TEST_F(TextureColors, NamesThatAreNoneAreRefusedWithTheNearest) {
    put_scene("t", R"(, "colorspace": "lin_ap1")");
    expect_refused({"t.json", "-o", "o.exr"}, ExitCode::usage,
                   "t.json: /textures/t/colorspace: unknown value 'lin_ap1'; did you mean 'lin_ap1_scene'?");
    put_scene("t", R"(, "colorspace": "unknown")");
    expect_refused({"t.json", "-o", "o.exr"}, ExitCode::usage, "/textures/t/colorspace: unknown value 'unknown'; ");
    put_scene("t", R"(, "colorspace": 3)");
    expect_refused({"t.json", "-o", "o.exr"}, ExitCode::usage, "/textures/t/colorspace: expected one of srgb, linear");
    put_scene("t", R"(, "color_space": "srgb")");
    expect_refused({"t.json", "-o", "o.exr"}, ExitCode::usage, "did you mean 'colorspace'?");
}

}  // namespace
}  // namespace cistula
