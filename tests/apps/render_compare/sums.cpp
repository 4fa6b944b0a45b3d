// render-compare --sums: layers that add up to within their rounding, and those that do not.
#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "image/exr/exr.h"
#include "render/record/film_picture.h"
#include "testing/support/run_program.h"

namespace cistula {
namespace {

class RenderCompareSums : public testing::Test {
  protected:
    /// 3 x 2 pixels whose layers by path add up: `values` of each channel, with those of R G B as given.
    LayeredPicture layered(float whole, float part, bool half = false) const {
        LayeredPicture picture;
        picture.width = picture.display_width = 3;
        picture.height = picture.display_height = 2;
        for (const char* channel : {"R", "G", "B"}) {
            picture.channels.push_back({channel, half, std::vector<float>(6, whole)});
            for (const char* layer : path_layer_names)
                picture.channels.push_back({std::string(layer) + '.' + channel, half, std::vector<float>(6, part)});
        }
        return picture;
    }
    float& value(LayeredPicture& picture, const std::string& name, size_t pixel) const {
        for (auto& channel : picture.channels)
            if (channel.name == name) return channel.values[pixel];
        throw std::logic_error(name);
    }
    ProgramResult checked(const LayeredPicture& picture) const {
        write_exr(folder_.file("a.exr"), picture);
        return RunningProgram(CISTULA_BIN_DIR "/render-compare", {"--sums", "a.exr"}, folder_.file("")).wait();
    }

    ScratchDirectory folder_;
};

TEST_F(RenderCompareSums, HoldWithinTheRoundingOfEachValue) {
    ProgramResult result = checked(layered(7.0f / 4, 0.25f));
    EXPECT_EQ(result.code, 0) << result.error;
    EXPECT_EQ(result.out, "path: 7 layers add up to R G B in all 6 pixels\n");
    // Seven thirds: each layer is off by less than half a unit, and so is the sum.
    EXPECT_EQ(checked(layered(7.0f / 3, 1.0f / 3)).code, 0);
    EXPECT_EQ(checked(layered(2.333984375f, 0.333251953125f, true)).code, 0);
}

TEST_F(RenderCompareSums, OneLayerThatIsOffIsNamedWithItsPlace) {
    LayeredPicture picture = layered(7.0f / 4, 0.25f);
    value(picture, "diffuse.G", 4) = std::nextafter(0.25f, 1.0f) + 0x1p-21f;
    ProgramResult result = checked(picture);
    EXPECT_EQ(result.code, 1);
    EXPECT_EQ(result.out, "path: 7 layers do not add up to R G B in 1 of 6 pixels, by up to 5.066e-07 (G at 1,1)\n");
    for (const float wrong : {NAN, INFINITY, -INFINITY}) {
        value(picture, "diffuse.G", 4) = wrong;
        EXPECT_EQ(checked(picture).code, 1) << wrong;
    }
}

TEST_F(RenderCompareSums, LightLayersAreAllThatAreThere) {
    LayeredPicture picture;
    picture.width = picture.height = picture.display_width = picture.display_height = 1;
    for (const char* channel : {"R", "G", "B"}) {
        picture.channels.push_back({channel, false, {1.5f}});
        for (const char* layer : {"ambient", "environment", "glow", "key", "rim.light"})
            picture.channels.push_back({std::string("Combined_") + layer + '.' + channel,
                                        false,
                                        {std::string(layer) == "glow" ? 0.5f : 0.25f}});
    }
    ProgramResult result = checked(picture);
    EXPECT_EQ(result.out, "light: 5 layers add up to R G B in all 1 pixels\n") << result.error;
    value(picture, "Combined_key.B", 0) = 0.5f;
    EXPECT_EQ(checked(picture).code, 1);
}

/// A file may have some of the scene's light layers, which need not add up.
TEST_F(RenderCompareSums, SomeOfTheLightLayersAreNoDivision) {
    LayeredPicture picture = layered(7.0f / 4, 0.25f);
    for (const char* channel : {"R", "G", "B"})
        for (const char* layer : {"ambient", "environment", "glow"})
            picture.channels.push_back(
                {std::string("Combined_") + layer + '.' + channel, false, std::vector<float>(6, 0)});
    picture.attributes[light_layer_count] = 4;
    EXPECT_EQ(checked(picture).out, "path: 7 layers add up to R G B in all 6 pixels\n");
    picture.attributes[light_layer_count] = 3;
    EXPECT_EQ(checked(picture).code, 1);
}

TEST_F(RenderCompareSums, AFileWithoutWholeDivisionsIsRefused) {
    LayeredPicture picture = layered(1, 1);
    std::erase_if(picture.channels, [](const auto& channel) { return channel.name == "specular.G"; });
    const ProgramResult result = checked(picture);
    EXPECT_EQ(result.code, 3);
    EXPECT_EQ(result.error,
              "render-compare: a.exr: has no R G B with all layers by path or by light; render --layers path,light "
              "writes them\n");
}

}  // namespace
}  // namespace cistula
