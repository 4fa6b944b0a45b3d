// The raw pictures of the course work, byte by byte, and every way in which such a file can be wrong.
#include "image/picture/raw_picture.h"

#include <gtest/gtest.h>

#include <cmath>

#include "cistula/numerics/elementary.h"
#include "image/color/srgb_codes.h"
#include "testing/support/expect_error.h"
#include "testing/support/pictures/srgb_codes.h"
#include "testing/support/scratch_directory.h"
#include "testing/support/special_values.h"

namespace cistula {
namespace {

std::string bytes_from(std::initializer_list<int> values) {
    std::string bytes;
    for (const int value : values) bytes += static_cast<char>(value);
    return bytes;
}

TEST(RawPicture, ReadsTopRowFirstAndDropsAlpha) {
    const ScratchDirectory scratch;
    const std::string path = scratch.file("a.data");
    put_bytes(path, bytes_from({2, 0, 0, 0, 1, 0, 0, 0, 0, 128, 255, 7, 10, 11, 188, 0}));
    const ColorPicture picture = read_raw_picture(path);
    ASSERT_EQ(picture.width, 2u);
    ASSERT_EQ(picture.height, 1u);
    ASSERT_EQ(picture.texels.size(), 2u);
    // IEC 61966-2-1, worked out by hand: 10/255 lies on the line, 11/255 on the curve.
    EXPECT_EQ(picture.texels[0].x, 0.0f);
    EXPECT_NEAR(picture.texels[0].y, 0.215860500, 1e-8);
    EXPECT_EQ(picture.texels[0].z, 1.0f);
    EXPECT_EQ(picture.texels[1].x, static_cast<float>(10 / 255.0 / 12.92));
    EXPECT_NEAR(picture.texels[1].y, 0.00334653576, 0x1p-33);  // half an ulp
    EXPECT_NEAR(picture.texels[1].z, 0.502886458, 1e-7);
}

TEST(RawPicture, WritesTheExactBytes) {
    const ScratchDirectory scratch;
    const std::string path = scratch.file("frame0.out");
    using test::infinity, test::nan;
    const ColorPicture picture{1, 3, {{0, 0.5f, 1}, {-1, 7, 0.2158605f}, {nan, infinity, -infinity}}};
    write_raw_picture(path, picture);
    EXPECT_EQ(bytes_of(path), bytes_from({1, 0, 0, 0, 3, 0, 0, 0, 0, 188, 255, 255, 0, 255, 128, 255, 0, 255, 0, 255}));
}

TEST(RawPicture, EveryByteComesBack) {
    const ScratchDirectory scratch;
    std::string bytes = bytes_from({16, 0, 0, 0, 16, 0, 0, 0});
    for (int i = 0; i < 256; ++i) bytes += bytes_from({i, 255 - i, i ^ 85, 255});
    put_bytes(scratch.file("a.data"), bytes);
    write_raw_picture(scratch.file("b.data"), read_raw_picture(scratch.file("a.data")));
    EXPECT_EQ(bytes_of(scratch.file("b.data")), bytes);
}

TEST(RawPicture, Errors) {
    const ScratchDirectory scratch;
    const std::string path = scratch.file("a.data");
    const auto message = [&](const std::string& bytes) {
        put_bytes(path, bytes);
        try {
            read_raw_picture(path);
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::file);
            const std::string start = path + ": cannot read: ", what = error.what();
            EXPECT_EQ(what.substr(0, start.size()), start);
            return what.substr(start.size());
        }
        return std::string("no error");
    };
    const std::string two_by_one = bytes_from({2, 0, 0, 0, 1, 0, 0, 0, 1, 2, 3, 4, 5, 6, 7, 8});
    EXPECT_EQ(message(two_by_one), "no error");
    for (const size_t length : {0, 1, 7})
        EXPECT_EQ(message(two_by_one.substr(0, length)),
                  "it has " + std::to_string(length) +
                      " bytes; a .data file begins with 8, its width and height as two 32-bit integers");
    for (const size_t length : {8, 9, 12, 15})
        EXPECT_EQ(message(two_by_one.substr(0, length)),
                  "it has " + std::to_string(length) + " bytes, which is too few; a .data file of 2x1 texels has 16");
    EXPECT_EQ(message(two_by_one + "x"), "it has 17 bytes, which is too many; a .data file of 2x1 texels has 16");
    EXPECT_EQ(message(bytes_from({254, 255, 255, 255, 1, 0, 0, 0})),
              "its size is -2x1; width and height of a texture are 1 to 65536");
    EXPECT_EQ(message(bytes_from({0, 0, 0, 0, 1, 0, 0, 0})),
              "its size is 0x1; width and height of a texture are 1 to 65536");
    EXPECT_EQ(message(bytes_from({255, 255, 255, 127, 255, 255, 255, 127})),
              "its size is 2147483647x2147483647; width and height of a texture are 1 to 65536");
    EXPECT_EQ(message(bytes_from({0, 0, 1, 0, 0, 0, 1, 0})),
              "it has 8 bytes, which is too few; a .data file of 65536x65536 texels has 17179869192");
    EXPECT_ERROR(read_raw_picture(scratch.file("no.data")), ExitCode::file,
                 scratch.file("no.data") + ": cannot read: No such file or directory; check the spelling");
}

TEST(SrgbCodes, CodesAreTheNearest) {
    for (int i = 0; i < 256; ++i) {
        const auto code = static_cast<uint8_t>(i);
        EXPECT_EQ(srgb8_from_linear(linear_from_srgb8(code)), code);
    }
    // Away from the halves, where one rounding decides, it is linear_to_srgb rounded.
    int compared = 0;
    for (int i = 0; i <= 100000; ++i) {
        const float linear = static_cast<float>(i) / 100000.0f;
        const double coded = 255 * elementary::linear_to_srgb(static_cast<double>(linear));
        if (std::abs(coded - std::floor(coded) - 0.5) < 1e-5) continue;
        ASSERT_EQ(srgb8_from_linear(linear), std::floor(coded + 0.5)) << linear;
        ++compared;
    }
    EXPECT_GT(compared, 99000);
}

}  // namespace
}  // namespace cistula
