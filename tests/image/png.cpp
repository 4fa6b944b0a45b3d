// What is in the PNGs: the very codes, as libpng reads them.
#include <gtest/gtest.h>

#include "image/color/srgb_codes.h"
#include "image/picture/picture_io.h"
#include "testing/support/pictures/png_pixels.h"
#include "testing/support/pictures/srgb_codes.h"
#include "testing/support/special_values.h"

namespace cistula {
namespace {

/// Bytes of red, green and blue, row-major, after the size has been checked.
std::vector<uint8_t> decoded(const std::string& png, uint32_t width, uint32_t height) {
    const PngPixels pixels = png_pixels(png);
    EXPECT_EQ(pixels.width, width);
    EXPECT_EQ(pixels.height, height);
    return pixels.bytes;
}

TEST(Png, HoldsTheNearestCodes) {
    using test::infinity, test::nan;
    const ColorPicture picture{
        2, 2, {{0, 0.5f, 1}, {-1, 100, nan}, {0.2158605f, 0.001f, 0.9f}, {infinity, -infinity, 1e-42f}}};
    const std::string png = encode_png(picture);
    EXPECT_EQ(decoded(png, 2, 2), (std::vector<uint8_t>{0, 188, 255, 0, 255, 0, 128, 3, 243, 255, 0, 0}));
    EXPECT_NE(png.find("sRGB"), std::string::npos);
    EXPECT_EQ(png, encode_png(picture));
}

TEST(Png, HoldsAlpha) {
    ColorPicture picture{3, 1, {{0, 0.5f, 1}, {1, 1, 1}, {0, 0, 0}}};
    picture.alpha = {1, 0.5f, 0};
    EXPECT_EQ(decoded(encode_png(picture), 3, 1),
              (std::vector<uint8_t>{0, 188, 255, 255, 255, 255, 255, 128, 0, 0, 0, 0}));
}

/// Nothing of the machine, the time, or what a version of libpng adds.
TEST(Png, HasNoChunksButThoseOfThePicture) {
    const auto chunks = [](const std::string& png) {
        std::string names;
        for (size_t at = 8; at + 8 <= png.size();) {
            size_t size = 0;
            for (size_t i = at; i < at + 4; ++i) size = 256 * size + static_cast<unsigned char>(png[i]);
            names += png.substr(at + 4, 4) + " ";
            at += size + 12;
        }
        return names;
    };
    EXPECT_EQ(chunks(encode_png({2, 1, {{0, 0.5f, 1}, {1, 1, 1}}})), "IHDR sRGB IDAT IEND ");
}

TEST(Png, HoldsEveryCode) {
    ColorPicture picture{256, 1, {}};
    std::vector<uint8_t> codes;
    for (int i = 0; i < 256; ++i) {
        for (const int code : {i, 255 - i, i ^ 85}) codes.push_back(static_cast<uint8_t>(code));
        picture.texels.emplace_back(linear_from_srgb8(codes[codes.size() - 3]),
                                    linear_from_srgb8(codes[codes.size() - 2]), linear_from_srgb8(codes.back()));
    }
    EXPECT_EQ(decoded(encode_png(picture), 256, 1), codes);
    for (const uint8_t code : codes) EXPECT_EQ(srgb8_to_linear(code), linear_from_srgb8(code));
}

TEST(Png, SaysWhatLibpngSays) {
    EXPECT_THROW(encode_png(ColorPicture{0, 0, {}}), std::runtime_error);
}

}  // namespace
}  // namespace cistula
