// Textures of every kind become the same linear values; previews are exact 8-bit sRGB.
#include "image/picture/picture_io.h"

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <limits>

#include "image/exr/exr.h"
#include "image/picture/raw_picture.h"
#include "testing/support/byte_order.h"
#include "testing/support/expect_error.h"
#include "testing/support/pictures/icc_profiles.h"
#include "testing/support/pictures/srgb_codes.h"
#include "testing/support/scratch_directory.h"
#include "testing/support/special_values.h"

namespace cistula {
namespace {

/// `profile`: ICC, or empty.
template <class T>
void write_image(const std::string& path, int width, int channels, OIIO::TypeDesc type, const std::vector<T>& samples,
                 const std::string& profile = "", float gamma = 0) {
    const int height = static_cast<int>(samples.size()) / width / channels;
    OIIO::ImageSpec spec(width, height, channels, type);
    spec["oiio:UnassociatedAlpha"] = 1;
    if (!profile.empty())
        spec.attribute("ICCProfile", OIIO::TypeDesc(OIIO::TypeDesc::UINT8, static_cast<int>(profile.size())),
                       profile.data());
    if (gamma > 0) {
        spec.attribute("oiio:ColorSpace", "GammaCorrected");
        spec.attribute("oiio:Gamma", gamma);
    }
    const auto output = OIIO::ImageOutput::create(path);
    ASSERT_TRUE(output) << OIIO::geterror();
    ASSERT_TRUE(output->open(path, spec)) << output->geterror();
    ASSERT_TRUE(output->write_image(OIIO::BaseTypeFromC<T>::value, samples.data())) << output->geterror();
    ASSERT_TRUE(output->close());
}

glm::vec3 decoded(int r, int g, int b) {
    const auto channel = [](int code) { return linear_from_srgb8(static_cast<uint8_t>(code)); };
    return {channel(r), channel(g), channel(b)};
}

TEST(Textures, EightBitsAreDecoded) {
    const ScratchDirectory scratch;
    const std::vector<uint8_t> samples = {0, 10, 11, 128, 188, 255, 1, 2, 3, 200, 100, 50};
    for (const char* name : {"a.png", "a.tif", "a.bmp", "a.tga"}) {
        write_image(scratch.file(name), 2, 3, OIIO::TypeDesc::UINT8, samples);
        const ColorPicture picture = read_texture(scratch.file(name));
        EXPECT_EQ(picture.width, 2u);
        EXPECT_EQ(picture.height, 2u);
        EXPECT_EQ(picture.texels, (std::vector<glm::vec3>{decoded(0, 10, 11), decoded(128, 188, 255), decoded(1, 2, 3),
                                                          decoded(200, 100, 50)}))
            << name;
    }
}

/// Profiles in files are read; a texture's encoding comes before them, and what they are not known for is an error.
TEST(Textures, ProfilesAreRead) {
    const ScratchDirectory scratch;
    const auto texel = [&](const char* name, const std::string& profile, const char* encoding = "") {
        const std::string path = scratch.file(name);
        write_image<uint8_t>(path, 8, 3, OIIO::TypeDesc::UINT8, std::vector<uint8_t>(8 * 8 * 3, 128), profile);
        return read_texture(path, encoding).texels.at(0).x;
    };
    const auto profile = [](const char* space, uint32_t gamma) {
        return test::icc_profile("RGB ", test::matrix_tags(*find_color_space(space), test::gamma_curve(gamma), "Mine"));
    };
    for (const char* name : {"a.png", "a.tif", "a.jpg"}) {
        EXPECT_NEAR(texel(name, ""), 0.215861f, 1e-6f) << name;
        EXPECT_NEAR(texel(name, profile("lin_rec709_scene", 256)), 128 / 255.0f, 1e-6f) << name;
        EXPECT_NEAR(texel(name, profile("lin_adobergb_scene", 563)), 0.219638f, 1e-6f) << name;
        const std::string other = profile("lin_p3d65_scene", 700);
        EXPECT_EQ(texel(name, other, "srgb"), texel(name, "")) << name;
        try {
            texel(name, other);
            ADD_FAILURE() << name;
        } catch (const Error& error) {
            EXPECT_NE(std::string(error.what()).find("its color profile 'Mine' is none of the encodings known here"),
                      std::string::npos)
                << error.what();
        }
    }
}

TEST(Textures, GammasOfPngAreRead) {
    const ScratchDirectory scratch;
    const auto texel = [&](float gamma) {
        write_image<uint8_t>(scratch.file("a.png"), 1, 3, OIIO::TypeDesc::UINT8, {128, 128, 128}, "", gamma);
        return read_texture(scratch.file("a.png")).texels.at(0).x;
    };
    EXPECT_NEAR(texel(1.0f), 128 / 255.0f, 1e-6f);
    EXPECT_NEAR(texel(1.8f), 0.289205f, 1e-6f);
    EXPECT_EQ(texel(2.2f), decoded(128, 0, 0).x);
}

/// What the library does not tell is read from the header.
TEST(Textures, PrimariesOfPngAndRadianceAreRead) {
    const ScratchDirectory scratch;
    const std::string png = scratch.file("a.png"), hdr = scratch.file("a.hdr");
    const auto with_header = [](const std::string& path, size_t at, const std::string& more) {
        const std::string bytes = bytes_of(path);
        put_bytes(path, bytes.substr(0, at) + more + bytes.substr(at));
    };
    write_image<uint8_t>(png, 1, 3, OIIO::TypeDesc::UINT8, {200, 100, 50});
    const std::string told = "srgb_p3d65_scene";
    const glm::vec3 expected = read_texture(png, told).texels.at(0);
    EXPECT_NE(read_texture(png).texels.at(0), expected);
    std::string chunk = "cHRM";
    for (const uint64_t xy : {31270, 32900, 68000, 32000, 26500, 69000, 15000, 6000}) chunk += test::big_endian(xy, 4);
    constexpr size_t after_size = 33;
    with_header(png, after_size, test::big_endian(32, 4) + chunk + test::big_endian(0xf1f8'ca57, 4));
    EXPECT_EQ(read_texture(png).texels.at(0), expected);

    write_image<float>(hdr, 1, 3, OIIO::TypeDesc::FLOAT, {0.5f, 0.25f, 0.75f});
    const glm::vec3 rec2020 = read_texture(hdr, "lin_rec2020_scene").texels.at(0);
    EXPECT_NE(read_texture(hdr).texels.at(0), rec2020);
    with_header(hdr, bytes_of(hdr).find('\n') + 1, "PRIMARIES= 0.708 0.292 0.170 0.797 0.131 0.046 0.3127 0.3290\n");
    EXPECT_EQ(read_texture(hdr).texels.at(0), rec2020);
}

TEST(Textures, AlphaChangesNoColor) {
    const ScratchDirectory scratch;
    for (const char* name : {"a.png", "a.tif", "a.tga"}) {
        write_image<uint8_t>(scratch.file(name), 2, 4, OIIO::TypeDesc::UINT8, {200, 100, 50, 128, 10, 20, 30, 0});
        EXPECT_EQ(read_texture(scratch.file(name)).texels,
                  (std::vector<glm::vec3>{decoded(200, 100, 50), decoded(10, 20, 30)}))
            << name;
    }
}

TEST(Textures, GrayWithAndWithoutAlpha) {
    const ScratchDirectory scratch;
    const std::vector<glm::vec3> expected = {decoded(7, 7, 7), decoded(250, 250, 250)};
    write_image<uint8_t>(scratch.file("a.png"), 2, 1, OIIO::TypeDesc::UINT8, {7, 250});
    EXPECT_EQ(read_texture(scratch.file("a.png")).texels, expected);
    write_image<uint8_t>(scratch.file("b.png"), 2, 2, OIIO::TypeDesc::UINT8, {7, 255, 250, 3});
    EXPECT_EQ(read_texture(scratch.file("b.png")).texels, expected);
}

TEST(Textures, SixteenBitsAreDecodedAndFloatsAreLinear) {
    const ScratchDirectory scratch;
    const std::vector<uint16_t> samples = {0, 1, 300, 40000, 65534, 65535};
    std::vector<glm::vec3> expected;
    for (size_t i = 0; i < 6; i += 3)
        expected.emplace_back(linear_from_srgb16(samples[i]), linear_from_srgb16(samples[i + 1]),
                              linear_from_srgb16(samples[i + 2]));
    for (const char* name : {"a.png", "a.tif"}) {
        write_image(scratch.file(name), 2, 3, OIIO::TypeDesc::UINT16, samples);
        EXPECT_EQ(read_texture(scratch.file(name)).texels, expected) << name;
    }
    write_image<float>(scratch.file("f.tif"), 1, 3, OIIO::TypeDesc::FLOAT, {0.1f, 1e-42f, 3e38f});
    EXPECT_EQ(read_texture(scratch.file("f.tif")).texels, (std::vector<glm::vec3>{{0.1f, 1e-42f, 3e38f}}));
    write_image<float>(scratch.file("a.hdr"), 1, 3, OIIO::TypeDesc::FLOAT, {64, 0.5f, 33});
    EXPECT_EQ(read_texture(scratch.file("a.hdr")).texels, (std::vector<glm::vec3>{{64, 0.5f, 33}}));
}

TEST(Textures, ExrByExtensionOrContentAndData) {
    const ScratchDirectory scratch;
    LayeredPicture layers;
    layers.width = layers.height = layers.display_width = layers.display_height = 1;
    layers.channels = {{"R", false, {0.1f}}, {"G", false, {123456.7f}}, {"B", false, {1e-30f}}, {"A", false, {0}}};
    const std::vector<glm::vec3> expected = {{0.1f, 123456.7f, 1e-30f}};
    for (const char* name : {"a.exr", "b.EXR", "renamed.png", "none"}) {
        write_exr(scratch.file(name), layers);
        EXPECT_EQ(read_texture(scratch.file(name)).texels, expected) << name;
    }
    for (const char* name : {"a.data", "a.out"}) {
        write_raw_picture(scratch.file(name), ColorPicture{1, 1, {decoded(9, 99, 199)}});
        EXPECT_EQ(read_texture(scratch.file(name)).texels, std::vector<glm::vec3>{decoded(9, 99, 199)}) << name;
    }
}

TEST(Textures, Errors) {
    const ScratchDirectory scratch;
    EXPECT_ERROR(read_texture(scratch.file("no.png")), ExitCode::file,
                 scratch.file("no.png") + ": cannot read: No such file or directory; check the spelling");
    put_bytes(scratch.file("empty.png"), "");
    EXPECT_ERROR(read_texture(scratch.file("empty.png")), ExitCode::file,
                 scratch.file("empty.png") + ": cannot read: it is empty; give a picture");
    put_bytes(scratch.file("a.data"), "1234567");
    EXPECT_ERROR(read_texture(scratch.file("a.data")), ExitCode::file,
                 scratch.file("a.data") +
                     ": cannot read: it has 7 bytes; a .data file begins with 8, its width and height as two 32-bit "
                     "integers");

    // Not a PNG: what libpng leaves by longjmp, OpenImageIO does not free, and leak checkers say so.
    write_image<uint8_t>(scratch.file("a.bmp"), 64, 3, OIIO::TypeDesc::UINT8, std::vector<uint8_t>(64 * 64 * 3, 77));
    const std::string bytes = bytes_of(scratch.file("a.bmp"));
    for (const std::string& bad : {bytes.substr(0, bytes.size() / 2), std::string("no picture")}) {
        put_bytes(scratch.file("bad.bmp"), bad);
        try {
            read_texture(scratch.file("bad.bmp"));
            ADD_FAILURE() << "no error for " << bad.size() << " bytes";
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::file);
            EXPECT_EQ(std::string(error.what()).rfind(scratch.file("bad.bmp") + ": cannot read: ", 0), 0u);
            EXPECT_GT(std::string(error.what()).size(), scratch.file("bad.bmp").size() + 20) << error.what();
        }
    }
    write_image<uint32_t>(scratch.file("w.tif"), 1, 3, OIIO::TypeDesc::UINT32, {1, 2, 3});
    EXPECT_ERROR(read_texture(scratch.file("w.tif")), ExitCode::file,
                 scratch.file("w.tif") +
                     ": cannot read: its samples are of type uint; a texture has 8 or 16 bits, half or float");
}

TEST(Textures, TexelsAreFiniteAndNotNegative) {
    const ScratchDirectory scratch;
    const std::string path = scratch.file("a.tif");
    const auto write = [&](float value) {
        write_image<float>(path, 2, 3, OIIO::TypeDesc::FLOAT, {0, 1, 2, 3, value, 5});
    };
    write(-0.0f);
    EXPECT_EQ(read_texture(path).texels.size(), 2u);
    const auto expect_refused = [&](const std::string& value) {
        EXPECT_ERROR(
            read_texture(path), ExitCode::file,
            path + ": texel (1, 0) has G = " + value + ", and so 1 of 6 values; texels are finite and not negative");
    };
    write(-0.5f);
    expect_refused("-0.5");
    write(std::numeric_limits<float>::infinity());
    expect_refused("inf");
    write(std::numeric_limits<float>::quiet_NaN());
    expect_refused("nan");
}

TEST(Preview, ExactBytesAndOneFile) {
    const ScratchDirectory scratch;
    const std::string path = scratch.file("a.png");
    using test::nan;
    ColorPicture picture{3, 1, {{0, 0.5f, 1}, {-1, 100, nan}, {0.2158605f, 0.001f, 0.9f}}};
    write_preview(path, picture);
    const auto input = OIIO::ImageInput::open(path);
    ASSERT_TRUE(input);
    EXPECT_EQ(std::string(input->format_name()), "png");
    EXPECT_EQ(input->spec().width, 3);
    EXPECT_EQ(input->spec().height, 1);
    EXPECT_EQ(input->spec().nchannels, 3);
    EXPECT_EQ(input->spec().format, OIIO::TypeDesc::UINT8);
    EXPECT_EQ(input->spec().get_string_attribute("oiio:ColorSpace"), "sRGB");
    std::vector<uint8_t> bytes(9);
    ASSERT_TRUE(input->read_image(0, 0, 0, 3, OIIO::TypeDesc::UINT8, bytes.data()));
    EXPECT_EQ(bytes, (std::vector<uint8_t>{0, 188, 255, 0, 255, 0, 128, 3, 243}));
    EXPECT_EQ(scratch.names(), std::vector<std::string>{"a.png"});

    // It replaces, and equal pictures are equal files.
    write_preview(scratch.file("b.png"), picture);
    EXPECT_EQ(bytes_of(path), bytes_of(scratch.file("b.png")));
    picture.texels[0].x = 1;
    write_preview(path, picture);
    EXPECT_NE(bytes_of(path), bytes_of(scratch.file("b.png")));
}

TEST(Preview, EveryCodeComesBackThroughATexture) {
    const ScratchDirectory scratch;
    ColorPicture picture{256, 1, {}};
    for (int i = 0; i < 256; ++i) picture.texels.push_back(decoded(i, 255 - i, i));
    write_preview(scratch.file("a.png"), picture);
    EXPECT_EQ(read_texture(scratch.file("a.png")).texels, picture.texels);
}

TEST(Preview, Errors) {
    const ScratchDirectory scratch;
    const ColorPicture picture{1, 1, {{1, 1, 1}}};
    EXPECT_ERROR(write_preview(scratch.file("a.jpg"), picture), ExitCode::file,
                 scratch.file("a.jpg") + ": cannot write: a preview is a PNG; give a name that ends in .png");
    EXPECT_ERROR(write_preview(scratch.file("no/a.png"), picture), ExitCode::file,
                 scratch.file("no/a.png") + ": cannot write: No such file or directory; create the directory " +
                     scratch.file("no") + " first, or give another");
    EXPECT_THROW(write_preview(scratch.file("a.png"), ColorPicture{2, 1, {{1, 1, 1}}}), std::invalid_argument);
    EXPECT_TRUE(scratch.names().empty());
}

}  // namespace
}  // namespace cistula
