// What the headers of PNG and Radiance pictures say of their colors.
#include "scene/image/stated_colors.h"

#include <gtest/gtest.h>

#include "testing/support/byte_order.h"
#include "testing/support/scratch_directory.h"

namespace cistula {
namespace {

using test::big_endian;

class StatedColors : public ::testing::Test {
  protected:
    std::optional<FileColors> stated(const std::string& bytes) const {
        put_bytes(folder_.file("a"), bytes);
        return stated_colors(folder_.file("a"));
    }
    static std::string chunk(const std::string& type, const std::string& data) {
        return big_endian(data.size(), 4) + type + data + "crc.";
    }
    /// A PNG up to its pixels.
    static std::string png(const std::string& chunks) {
        return "\x89PNG\r\n\x1a\n" + chunk("IHDR", std::string(13, '\0')) + chunks + chunk("IDAT", "pixels");
    }
    static std::string gamma(double value) { return chunk("gAMA", big_endian(uint64_t(100000 / value + 0.5), 4)); }
    static std::string primaries(const ColorSpace& space) {
        std::string data;
        for (const auto* xy : {space.white, space.red, space.green, space.blue})
            for (int i = 0; i < 2; ++i) data += big_endian(uint64_t(xy[i] * 100000 + 0.5), 4);
        return chunk("cHRM", data);
    }
    static std::string primaries(const char* id) { return primaries(*find_color_space(id)); }
    static std::string cicp(const char* code) { return chunk("cICP", std::string(code, 4)); }

    /// The id, the name of what is not known, or "xy" where there are chromaticities.
    std::string of_png(const std::string& chunks) const {
        const std::optional<FileColors> colors = stated(png(chunks));
        if (!colors) return "none";
        return colors->chromaticities ? "xy" : colors->id + colors->profile;
    }

    const ScratchDirectory folder_;
};

TEST_F(StatedColors, GammasOfPng) {
    EXPECT_EQ(of_png(""), "");
    EXPECT_EQ(of_png(gamma(1)), "linear");
    EXPECT_EQ(of_png(gamma(1.8)), "g18_rec709_scene");
    EXPECT_EQ(of_png(gamma(2.4)), "g24_rec709_scene");
    EXPECT_EQ(of_png(gamma(2.2)), "");
    EXPECT_EQ(of_png(gamma(3)), "gamma 3");
    EXPECT_EQ(of_png(chunk("gAMA", big_endian(0, 4))), "");
}

TEST_F(StatedColors, PrimariesOfPng) {
    EXPECT_EQ(of_png(primaries("lin_rec709_scene")), "");
    EXPECT_EQ(of_png(gamma(1) + primaries("lin_rec709_scene")), "linear");
    EXPECT_EQ(of_png(primaries("lin_p3d65_scene")), "srgb_p3d65_scene");
    EXPECT_EQ(of_png(gamma(2.2) + primaries("lin_p3d65_scene")), "srgb_p3d65_scene");
    EXPECT_EQ(of_png(primaries("lin_adobergb_scene") + gamma(2.2)), "g22_adobergb_scene");
    EXPECT_EQ(of_png(gamma(1) + primaries("lin_rec2020_scene")), "lin_rec2020_scene");
    EXPECT_EQ(of_png(gamma(1.8) + primaries("lin_p3d65_scene")), "g18_rec709_scene with primaries of other spaces");
    EXPECT_EQ(of_png(gamma(3) + primaries("lin_p3d65_scene")), "gamma 3");
    EXPECT_EQ(of_png(primaries("lin_rec2020_scene")), "xy");
    const FileColors colors = *stated(png(primaries("lin_rec2020_scene")));
    const FileEncoding encoding = file_encoding("", colors, false);
    EXPECT_EQ(encoding.space.id, "lin_rec2020_scene");
    EXPECT_EQ(encoding.curve, find_color_encoding("srgb")->curve);
    EXPECT_EQ(of_png(chunk("cHRM", std::string(32, '\0'))).substr(0, 6), "cHRM: ");
}

TEST_F(StatedColors, WhatComesFirstInPng) {
    const std::string p3 = primaries("lin_p3d65_scene"), profile = chunk("iCCP", "profile");
    EXPECT_EQ(of_png(chunk("sRGB", std::string(1, '\0')) + gamma(1) + p3), "srgb");
    EXPECT_EQ(of_png(profile + p3), "none");
    EXPECT_EQ(of_png(cicp("\1\15\0\1") + profile + p3), "srgb");
    EXPECT_EQ(of_png(p3 + cicp("\14\15\0\1")), "srgb_p3d65_scene");
    EXPECT_EQ(of_png(cicp("\11\10\0\1")), "lin_rec2020_scene");
    for (const auto& [code, name] :
         {std::pair("\11\20\0\1", "cICP 9 16 0 1"), {"\1\15\1\1", "cICP 1 13 1 1"}, {"\1\15\0\0", "cICP 1 13 0 0"}})
        EXPECT_EQ(of_png(cicp(code)), name);
    EXPECT_FALSE(stated(png("")).value().chromaticities);
    // What follows the pixels says nothing.
    EXPECT_EQ(stated(png("") + gamma(1))->id, "");
}

TEST_F(StatedColors, Radiance) {
    const auto of = [&](const std::string& lines) {
        return stated("#?RADIANCE\n" + lines + "\n\n-Y 1 +X 1\nFORMAT=xyze\n");
    };
    EXPECT_FALSE(of("FORMAT=32-bit_rle_rgbe"));
    EXPECT_EQ(of("FORMAT=32-bit_rle_xyze")->profile, "FORMAT=32-bit_rle_xyze");
    const FileColors colors =
        *of("EXPOSURE=2\nPRIMARIES= .708 .292 .17 .797 .131 .046 .3127 .329\nFORMAT=32-bit_rle_rgbe");
    EXPECT_EQ(file_encoding("", colors, true).space.id, "lin_rec2020_scene");
    EXPECT_EQ(file_encoding("", colors, true).curve(0.5), 0.5);
    EXPECT_EQ(of("PRIMARIES= .708 .292 .17")->profile, "PRIMARIES= .708 .292 .17");
}

TEST_F(StatedColors, OtherAndDamagedFiles) {
    EXPECT_FALSE(stated(""));
    EXPECT_FALSE(stated("\xff\xd8\xff\xe0 a JPEG"));
    EXPECT_FALSE(stated_colors(folder_.file("missing")));
    const std::string whole = png(gamma(1) + primaries("lin_p3d65_scene") + cicp("\1\15\0\1"));
    for (size_t size = 8; size < whole.size(); ++size) EXPECT_TRUE(stated(whole.substr(0, size))) << size;
    EXPECT_EQ(of_png(chunk("cHRM", "short") + chunk("gAMA", "") + chunk("cICP", "long one")), "");
    std::string endless = "#?RADIANCE\n" + std::string(1 << 20, 'x');
    EXPECT_FALSE(stated(endless));
}

}  // namespace
}  // namespace cistula
