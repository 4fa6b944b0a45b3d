// How `render` gives colors and alpha: backgrounds, color spaces, compression.
#include <cmath>
#include <map>

#include "image/color/color_space.h"
#include "image/exr/exr.h"
#include "testing/support/render_program.h"

namespace cistula {
namespace {

class RenderColors : public RenderProgram {
  protected:
    RenderColors() {
        std::string text = scene_text;
        put_bytes(file("b.json"), text.replace(text.find('{') + 1, 0, "\"background\": [0.25, 0.5, 1],"));
    }

    /// The channels of b.json, rendered with these options.
    std::map<std::string, std::vector<float>> rendered(Arguments options) {
        options.insert(options.begin(), {"b.json", "-q", "-o", "b.exr"});
        expect_done(options);
        last_ = read_exr(file("b.exr"));
        std::map<std::string, std::vector<float>> channels;
        for (const auto& channel : last_.channels) channels[channel.name] = channel.values;
        return channels;
    }

    LayeredPicture last_;
};

TEST_F(RenderColors, ATransparentBackgroundIsTakenOutOfColorAndAlpha) {
    for (const Arguments& sampling : {Arguments{"--supersample", "3"}, Arguments{"--target-error", "0.05"}}) {
        const auto with = [&](Arguments options) {
            options.insert(options.end(), sampling.begin(), sampling.end());
            return rendered(options);
        };
        auto opaque = with({"--layers", "coverage,Z"}),
             clear = with({"--background", "transparent", "--layers", "Z", "--z-far", "inf"});
        EXPECT_EQ(std::get<std::string>(last_.attributes.at("cistula:background")), "transparent");
        EXPECT_EQ(clear["A"], opaque["coverage"]);
        size_t empty = 0, part = 0;
        const float background[3] = {0.25f, 0.5f, 1};
        for (size_t i = 0; i < clear["A"].size(); ++i) {
            const float covered = clear["A"][i];
            EXPECT_EQ(opaque["A"][i], 1);
            EXPECT_EQ(clear["Z"][i], opaque["Z"][i] == 1e10f ? std::numeric_limits<float>::infinity() : opaque["Z"][i]);
            for (int c = 0; c < 3; ++c) {
                const std::string name(1, "RGB"[c]);
                EXPECT_NEAR(clear[name][i], opaque[name][i] - (1 - covered) * background[c], 1e-6);
                if (covered == 0) {
                    EXPECT_EQ(clear[name][i], 0);
                }
            }
            empty += covered == 0;
            part += covered > 0 && covered < 1;
        }
        EXPECT_GT(empty, 100u);
        EXPECT_GT(part, 10u);
    }
}

TEST_F(RenderColors, SpacesAreThoseOfTheHeader) {
    auto own = rendered({});
    EXPECT_EQ(std::get<std::string>(last_.attributes.at("colorInteropID")), "lin_rec709_scene");
    for (const ColorSpace& space : color_spaces().subspan(1)) {
        auto other = rendered({"--colorspace", std::string(space.id)});
        EXPECT_EQ(std::get<std::string>(last_.attributes.at("colorInteropID")), space.id);
        const glm::dmat3 matrix = color_matrix(color_spaces().front(), space);
        for (size_t i = 0; i < own["R"].size(); ++i)
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(other[std::string(1, "RGB"[c])][i],
                            matrix[0][c] * own["R"][i] + matrix[1][c] * own["G"][i] + matrix[2][c] * own["B"][i], 1e-5);
    }
    expect_refused(
        {"b.json", "-o", "b.exr", "--colorspace", "lin_ap2_scene"}, ExitCode::usage,
        "--colorspace lin_ap2_scene: there is no such space; the spaces are: "
        "lin_ap1_scene, lin_ap0_scene, lin_p3d65_scene, lin_rec2020_scene, lin_rec709_scene, lin_adobergb_scene");
}

TEST_F(RenderColors, RawFramesRefuseWhatTheyCannotHold) {
    for (const Arguments& option : {Arguments{"--layers", "coverage"}, Arguments{"--background", "transparent"},
                                    Arguments{"--colorspace", "lin_ap1_scene"}, Arguments{"--compression", "piz"}}) {
        Arguments arguments{"b.json", "-o", "b.data"};
        arguments.insert(arguments.end(), option.begin(), option.end());
        expect_refused(arguments, ExitCode::usage, "-o b.data: " + option[0]);
        EXPECT_FALSE(exists("b.data"));
    }
    expect_done({"b.json", "-q", "-o", "b.data"});
}

TEST_F(RenderColors, LosslessCompressionsGiveTheSamePixels) {
    const auto own = rendered({"--layers", "Z,id"});
    for (const char* name : {"none", "rle", "zips", "zip", "piz"}) {
        EXPECT_EQ(rendered({"--layers", "Z,id", "--compression", name}), own) << name;
    }
    const auto lossy = rendered({"--layers", "Z,id", "--bits", "half", "--compression", "dwaa", "--dwa-level", "20"});
    EXPECT_NE(lossy.at("R"), own.at("R"));
    for (size_t i = 0; i < own.at("R").size(); ++i) EXPECT_NEAR(lossy.at("R")[i], own.at("R")[i], 0.1);
    EXPECT_EQ(lossy.at("id"), own.at("id"));
    expect_refused({"b.json", "-o", "b.exr", "--compression", "lzma"}, ExitCode::usage, "--compression");
    expect_refused({"b.json", "-o", "b.exr", "--dwa-level", "20"}, ExitCode::usage,
                   "--dwa-level 20: is for --compression dwaa and dwab");
    expect_refused({"b.json", "-o", "b.exr", "--compression", "dwab", "--dwa-level", "nan"}, ExitCode::usage,
                   "from 0 to 1000");
    for (const char* wrong : {"-1", "0", "nan", "1e39", "far"})
        expect_refused({"b.json", "-o", "b.exr", "--layers", "Z", std::string("--z-far=") + wrong}, ExitCode::usage,
                       "must be a number above 0 in single precision, or inf");
}

}  // namespace
}  // namespace cistula
