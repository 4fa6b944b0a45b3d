// What the headers of PNG and Radiance pictures say of their colors.
#include "image/color/stated_colors.h"

#include <cmath>

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

/// A TIFF of these tags, each with RATIONALs in tenths of thousandths.
std::string tiff(bool little, const std::vector<std::pair<int, std::vector<int>>>& tags) {
    const auto number = [&](uint64_t value, int size) {
        return little ? test::little_endian(value, size) : big_endian(value, size);
    };
    std::string entries, values;
    const size_t first = 8 + 2 + 12 * tags.size() + 4;
    for (const auto& [tag, list] : tags) {
        entries += number(static_cast<uint64_t>(tag), 2) + number(5, 2) + number(list.size(), 4) +
                   number(first + values.size(), 4);
        for (const int value : list) values += number(static_cast<uint64_t>(value), 4) + number(10000, 4);
    }
    return (little ? "II" : "MM") + number(42, 2) + number(8, 4) + number(tags.size(), 2) + entries + number(0, 4) +
           values;
}

TEST_F(StatedColors, PrimariesOfTiff) {
    const std::vector<int> red_green_blue = {7130, 2930, 1650, 8300, 1280, 440}, white = {3217, 3377};
    for (const bool little : {true, false}) {
        const auto colors = stated(tiff(little, {{318, white}, {319, red_green_blue}}));
        ASSERT_TRUE(colors && colors->chromaticities) << little;
        EXPECT_EQ(*colors->chromaticities,
                  (Chromaticities{0.713f, 0.293f, 0.165f, 0.83f, 0.128f, 0.044f, 0.3217f, 0.3377f}));
        EXPECT_FALSE(stated(tiff(little, {{318, white}})));
        EXPECT_FALSE(stated(tiff(little, {{318, white}, {319, {1, 2}}})));
        EXPECT_FALSE(stated(tiff(little, {{318, white}, {319, red_green_blue}, {34675, {1}}})));  // the profile counts
        EXPECT_EQ(stated(tiff(little, {{319, red_green_blue}}))->profile, "PrimaryChromaticities without a WhitePoint");
    }
    const std::string whole = tiff(true, {{318, white}, {319, red_green_blue}});
    for (size_t size = 0; size < whole.size(); ++size) stated(whole.substr(0, size));  // ends
}

TEST_F(StatedColors, OfFilmScans) {
    const auto dpx = [](char transfer) {
        std::string bytes(2048, '\0');
        bytes.replace(0, 4, "SDPX");
        bytes[801] = transfer;
        return bytes;
    };
    EXPECT_FALSE(stated(dpx(0)));
    EXPECT_FALSE(stated(dpx(4)));
    EXPECT_FALSE(stated(dpx(char(255))));
    EXPECT_EQ(stated(dpx(2))->id, "linear");
    EXPECT_EQ(stated(dpx(3))->profile, "transfer characteristic logarithmic");
    EXPECT_EQ(stated(dpx(6))->profile, "transfer characteristic ITU-R 709-4");
    EXPECT_EQ(stated(big_endian(0x802a5fd7, 4))->profile, "Cineon's printing density");
}

TEST_F(StatedColors, GammaOfTga) {
    const auto tga = [](uint64_t over, uint64_t under) {
        using test::little_endian;
        std::string extension = little_endian(495, 2) + std::string(493, '\0');
        extension.replace(478, 4, little_endian(over, 2) + little_endian(under, 2));
        return std::string(30, 'p') + extension + little_endian(30, 4) + little_endian(0, 4) + "TRUEVISION-XFILE." +
               std::string(1, '\0');
    };
    EXPECT_EQ(stated(tga(1, 1))->id, "linear");
    EXPECT_EQ(stated(tga(22, 10))->id, "");
    EXPECT_EQ(stated(tga(3, 1))->profile, "gamma 3");
    EXPECT_FALSE(stated(tga(0, 0)));
    EXPECT_FALSE(stated("any bytes"));
}

TEST_F(StatedColors, ProfileOfWebp) {
    using test::little_endian;
    const auto riff = [](const std::string& type, const std::string& data) {
        return type + little_endian(data.size(), 4) + data + std::string(data.size() % 2, '\0');
    };
    const auto webp = [&](const std::string& chunks) { return riff("RIFF", "WEBP" + riff("VP8X", "123") + chunks); };
    EXPECT_FALSE(stated(webp(riff("VP8L", "pixels"))));
    const std::optional<FileColors> colors = stated(webp(riff("ICCP", "no profile") + riff("VP8L", "pixels")));
    ASSERT_TRUE(colors);
    EXPECT_NE(colors->profile, "");
    EXPECT_EQ(stated("RIFF" + little_endian(99, 4) + "WEBPICCP" + little_endian(0xffffffff, 4))->profile,
              "an ICC profile of 4294967295 bytes");
}

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

TEST_F(StatedColors, RadianceIsDividedByAllItsFactors) {
    using Factors = std::array<double, 3>;
    const auto of = [&](const std::string& lines) {
        return stated("#?RADIANCE\n" + lines + "\nFORMAT=32-bit_rle_rgbe\n\nEXPOSURE=9\n")->factors;
    };
    EXPECT_EQ(of("EXPOSURE= 2.5e-01"), (Factors{0.25, 0.25, 0.25}));
    EXPECT_EQ(of("EXPOSURE=2\nSOFTWARE=EXPOSURE=7\n\tEXPOSURE=7\nEXPOSURE=0.125"), (Factors{0.25, 0.25, 0.25}));
    EXPECT_EQ(of("COLORCORR= 1 2 4\nEXPOSURE=2\nCOLORCORR=2 1 0.5"), (Factors{4, 4, 4}));
    EXPECT_EQ(of("COLORCORR= 1 2 4"), (Factors{1, 2, 4}));
    EXPECT_EQ(of("PRIMARIES= .64 .33 .3 .6 .15 .06 .3127 .329\nEXPOSURE=3"), (Factors{3, 3, 3}));
    EXPECT_EQ(of("PRIMARIES= .64\n" + std::string(70000, '#') + "\nEXPOSURE=3"), (Factors{3, 3, 3}));
    for (const char* line : {"EXPOSURE=", "EXPOSURE=x", "EXPOSURE=1e999", "COLORCORR= 1 2"})
        EXPECT_TRUE(std::isnan(of(line)[2])) << line;
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
