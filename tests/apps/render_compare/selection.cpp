// What of two images is compared: layers by pattern, windows that overlap, a crop, a mask.
#include <gtest/gtest.h>

#include "apps/render_compare/fixture.h"
#include "testing/support/special_values.h"

namespace cistula {
namespace {

using CompareSelection = RenderCompare;

Channel constant(const std::string& name, float value) {
    return {name, false, std::vector<float>(8, value)};
}

TEST_F(CompareSelection, LayersByPattern) {
    put("a.exr", picture_of({constant("R", 1), constant("diffuse.R", 1), constant("diffuse.G", 1), constant("Z", 1)}));
    put("b.exr", picture_of({constant("R", 1), constant("diffuse.R", 1), constant("diffuse.G", 1), constant("Z", 2)}));
    expect_code(1, {"a.exr", "b.exr"});
    const std::string text = expect_code(0, {"a.exr", "b.exr", "--layers", "R,diffuse.*"});
    EXPECT_TRUE(contains(text, "not compared: 1 channel that --layers leaves out: Z\n")) << text;
    EXPECT_TRUE(contains(text, "equal: every bit of 24 floats and of the header\n")) << text;
    for (const char* all_of_diffuse : {"diffuse", "d*", "diffuse.[RG]", "diffuse.?"})
        EXPECT_TRUE(contains(expect_code(0, {"a.exr", "b.exr", "--layers", all_of_diffuse}), "every bit of 16 floats"))
            << all_of_diffuse;
    expect_code(1, {"a.exr", "b.exr", "--layers", "Z"});
    expect_code(0, {"a.exr", "b.exr", "--layers", "R", "--diff", "d.exr"});
    EXPECT_EQ(read_exr(file("d.exr")).channels.size(), 1u);
    // Channels that only one has count if they are chosen.
    put("c.exr", picture_of({constant("R", 1)}));
    expect_code(0, {"a.exr", "c.exr", "--layers", "R"});
    EXPECT_TRUE(contains(expect_code(1, {"a.exr", "c.exr", "--layers", "R,Z"}), "channel Z: only in the first\n"));
    expect_refused({"a.exr", "b.exr", "--layers", "R,difuse.*"}, ExitCode::usage,
                   "--layers difuse.*: no channel has such a name; the channels are: diffuse.");
    expect_refused({"a.exr", "b.exr", "--layers", "R,,G"}, ExitCode::usage, "has an empty name");
}

/// 3 x 2 pixels of its x + 10 y at (x, y).
LayeredPicture ramp(int x, int y) {
    LayeredPicture picture;
    picture.width = 3;
    picture.height = 2;
    picture.x = x;
    picture.y = y;
    picture.display_width = 20;
    picture.display_height = 10;
    Channel channel{"Z", false, {}};
    for (int row = y; row < y + 2; ++row)
        for (int column = x; column < x + 3; ++column) channel.values.push_back(static_cast<float>(column + 10 * row));
    picture.channels = {channel};
    return picture;
}

TEST_F(CompareSelection, WindowsThatOnlyOverlap) {
    put("a.exr", ramp(4, 3));
    put("b.exr", ramp(5, 4));
    expect_code(1, {"a.exr", "b.exr"});
    const std::string text = expect_code(0, {"a.exr", "b.exr", "--intersection", "--diff", "d.exr"});
    EXPECT_TRUE(contains(text, "not compared: data window: 3x2+4+3 / 3x2+5+4\n")) << text;
    EXPECT_TRUE(contains(text, "not compared: pixels other than 2 of 2x1+5+4\n")) << text;
    EXPECT_TRUE(contains(text, "equal: every bit of 2 floats")) << text;
    const LayeredPicture difference = read_exr(file("d.exr"));
    EXPECT_EQ(difference.width, 2);
    EXPECT_EQ(difference.height, 1);
    EXPECT_EQ(difference.x, 5);
    EXPECT_EQ(difference.y, 4);
    LayeredPicture other = ramp(5, 4);
    other.channels[0].values[1] += 2;
    put("b.exr", other);
    EXPECT_TRUE(contains(expect_code(1, {"a.exr", "b.exr", "--intersection"}), "(6, 4): 46 / 48\n"));
    put("b.exr", ramp(7, 3));
    EXPECT_TRUE(contains(expect_code(1, {"a.exr", "b.exr", "--intersection"}), "no pixel is in both data windows\n"));
}

TEST_F(CompareSelection, ACropCountsInPixelSpace) {
    put("a.exr", ramp(4, 3));
    LayeredPicture other = ramp(4, 3);
    other.channels[0].values[0] = 0;
    put("b.exr", other);
    expect_code(1, {"a.exr", "b.exr"});
    for (const char* crop : {"5,3,2,2", "2x2+5+3"}) {
        const std::string text = expect_code(0, {"a.exr", "b.exr", "--crop", crop});
        EXPECT_TRUE(contains(text, "not compared: pixels other than 4 of 2x2+5+3\n")) << text;
    }
    expect_code(1, {"a.exr", "b.exr", "--crop", "4,3,1,1"});
    // Windows may differ where both have the crop.
    put("c.exr", ramp(5, 4));
    expect_code(0, {"a.exr", "c.exr", "--crop", "6,4,1,1"});
    expect_refused({"a.exr", "c.exr", "--crop", "4,3,2,2"}, ExitCode::usage,
                   "--crop 2x2+4+3: leaves the data window of the second image, 3x2+5+4");
    EXPECT_TRUE(contains(expect_code(0, {"a.exr", "c.exr", "--crop", "4,3,9,9", "--intersection"}), "of 2 floats"));
    for (const char* text : {"1,2,3", "1,2,0,4", "1,2,3,-4", "a,2,3,4", "1,2,3,4,5", "10x10"})
        expect_refused({"a.exr", "c.exr", "--crop", text}, ExitCode::usage,
                       "--crop " + std::string(text) + ": must be");
}

TEST_F(CompareSelection, AMaskSaysWhichPixelsCount) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    put("a.exr", picture_of({first_r}));
    put("b.exr", picture_of({second_r}));  // pixels 1 and 3 differ
    put("mask.exr", picture_of({{"Y", true, {1, 0, 0.5f, -1, nan, test::infinity, 0, 0}}}));
    const std::string text = expect_code(0, {"a.exr", "b.exr", "--mask", "mask.exr", "--diff", "d.exr"});
    EXPECT_TRUE(contains(text, "not compared: pixels other than 3 of 4x2+5+7\n")) << text;
    EXPECT_TRUE(contains(text, "equal: every bit of 3 floats")) << text;
    EXPECT_EQ(read_exr(file("d.exr")).channels[0].values, std::vector<float>(8));
    put("mask.exr", picture_of({{"A", true, std::vector<float>(8, 1)}, {"R", true, {0, 1, 0, 0, 0, 0, 0, 0}}}));
    const std::string one = expect_code(1, {"a.exr", "b.exr", "--mask", "mask.exr", "--fail", "0.1"});
    EXPECT_TRUE(contains(one, "1 of 1 pixel (100 %) over --fail 0.1")) << one;
    put("mask.exr", picture_of({{"A", true, {1, 0, 1, 0, 1, 1, 1, 1}}}));
    expect_code(0, {"a.exr", "b.exr", "--mask", "mask.exr"});
    put("mask.exr", picture_of({{"Y", true, std::vector<float>(8)}}));
    expect_refused({"a.exr", "b.exr", "--mask", "mask.exr"}, ExitCode::usage, "--mask: counts none of the pixels");
    put("mask.exr", ramp(5, 7));
    expect_refused({"a.exr", "b.exr", "--mask", "mask.exr"}, ExitCode::usage,
                   "--mask: has the pixels 3x2+5+7, and 4x2+5+7 are compared; give a mask with all of them");
    expect_code(1, {"a.exr", "b.exr", "--mask", "mask.exr", "--crop", "5,7,3,2"});
    expect_refused({"a.exr", "b.exr", "--mask", "none.exr"}, ExitCode::file, "none.exr: cannot read");
    expect_refused({"a.exr", "b.exr", "--mask", "mask.exr", "--json", "mask.exr"}, ExitCode::usage,
                   "--mask and --json");
}

TEST_F(CompareSelection, BelongsToTwoImages) {
    for (const Arguments& option : {Arguments{"--layers", "R"},
                                    {"--intersection"},
                                    {"--crop", "0,0,1,1"},
                                    {"--mask", "m.exr"},
                                    {"--metrics", "ssim"}}) {
        Arguments arguments{"--sums=a.exr"};
        arguments.insert(arguments.end(), option.begin(), option.end());
        expect_refused(arguments, ExitCode::usage, option[0] + ": ");
    }
}

}  // namespace
}  // namespace cistula
