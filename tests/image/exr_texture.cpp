// What of an OpenEXR file is a texture: its channels, luminance and chroma, and what it says of its colors.
#include <OpenEXR/ImfArray.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfChromaticitiesAttribute.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfRgbaFile.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <gtest/gtest.h>

#include <random>

#include "image/color/file_colors.h"
#include "image/exr/exr.h"
#include "testing/support/expect_error.h"
#include "testing/support/scratch_directory.h"

namespace cistula {
namespace {

const Imf::Chromaticities ap1({0.713f, 0.293f}, {0.165f, 0.83f}, {0.128f, 0.044f}, {0.32168f, 0.33767f});

class ExrTextures : public testing::Test {
  protected:
    std::string file() const { return scratch_.file("a.exr"); }

    /// Writes a picture of 2x1 with these channels, whose values are 1, 2 for the first, 3, 4 for the second ...
    void write(const std::vector<const char*>& names) const {
        LayeredPicture picture;
        picture.width = picture.display_width = 2;
        picture.height = picture.display_height = 1;
        float value = 0;
        for (const char* name : names) {
            picture.channels.push_back({name, false, {value + 1, value + 2}});
            value += 2;
        }
        write_exr(file(), picture);
    }

    void expect_texels(const std::vector<const char*>& names, const std::vector<glm::vec3>& texels) const {
        write(names);
        EXPECT_EQ(read_exr_texture(file()).texels, texels) << names[0];
    }

    void expect_refused(const std::string& reason) const {
        EXPECT_ERROR(read_exr_texture(file()), ExitCode::file, file() + ": cannot read: " + reason);
    }

    /// Writes luminance and chroma of a picture as OpenEXR does, with a data window off the origin.
    void write_chroma(int width, int height, const std::vector<glm::vec3>& colors, const Imf::Chromaticities* space,
                      Imf::Compression compression = Imf::ZIP_COMPRESSION) const {
        const Imath::Box2i window(Imath::V2i(-4, 6), Imath::V2i(width - 5, height + 5));
        Imf::Header header(window, window);
        header.compression() = compression;
        if (space) header.insert("chromaticities", Imf::ChromaticitiesAttribute(*space));
        std::vector<Imf::Rgba> pixels;
        for (const glm::vec3& c : colors) pixels.emplace_back(c.x, c.y, c.z, 1.0f);
        Imf::RgbaOutputFile out(file().c_str(), header, Imf::WRITE_YC);
        out.setYCRounding(10, 10);  // all bits of halves
        out.setFrameBuffer(pixels.data() + 4 - 6 * width, 1, static_cast<size_t>(width));
        out.writePixels(height);
    }

    ScratchDirectory scratch_;
};

TEST_F(ExrTextures, ChannelsAreColorsOrGray) {
    expect_texels({"R", "G", "B"}, {{1, 3, 5}, {2, 4, 6}});
    expect_texels({"B", "A", "R", "G", "Y"}, {{5, 7, 1}, {6, 8, 2}});
    for (const char* only : {"Y", "Z", "R", "A", "id", "mask.left", "RY", "X"})
        expect_texels({only}, {glm::vec3(1), glm::vec3(2)});
    expect_texels({"A", "Y"}, {glm::vec3(3), glm::vec3(4)});
    expect_texels({"Y", "Z", "id"}, {glm::vec3(1), glm::vec3(2)});
    const std::string rule =
        "a texture has the channels R, G and B, or Y, or Y, RY and BY, or a single one; this file has ";
    write({"R", "Z"});
    expect_refused(rule + "R, Z");
    write({"R", "G", "Y"});
    expect_refused(rule + "G, R, Y");
    write({"A", "Z"});
    expect_refused(rule + "A, Z");
    write({"Y", "RY"});
    expect_refused(rule + "RY, Y");
    write({"X", "Y", "Z"});
    expect_refused(rule + "X, Y, Z");
}

TEST_F(ExrTextures, WholeChromaIsTheInverseOfItsFormula) {
    LayeredPicture picture;
    picture.width = picture.display_width = 3;
    picture.height = picture.display_height = 1;
    const glm::dvec3 weights = luminance_weights(color_spaces().front());
    const glm::dvec3 colors[] = {{0.9, 0.2, 0.05}, {100, 100, 100}, {0, 0, 70000}};
    picture.channels = {{"Y", false, {}}, {"RY", false, {}}, {"BY", false, {}}};
    for (const glm::dvec3& c : colors) {
        const double luminance = c.x * weights.x + c.y * weights.y + c.z * weights.z;
        picture.channels[0].values.push_back(static_cast<float>(luminance));
        picture.channels[1].values.push_back(static_cast<float>((c.x - luminance) / luminance));
        picture.channels[2].values.push_back(static_cast<float>((c.z - luminance) / luminance));
    }
    write_exr(file(), picture);
    const ColorPicture read = read_exr_texture(file());
    for (size_t i = 0; i < 3; ++i)
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(read.texels[i][c], colors[i][c], 1e-6 * (colors[i].x + colors[i].y + colors[i].z)) << i;
    EXPECT_EQ(read.texels[1].x, read.texels[1].y);
}

TEST_F(ExrTextures, HalvedChromaIsReadAsTheLibraryReadsIt) {
    constexpr int width = 38, height = 30;
    std::mt19937 random(5);
    std::uniform_real_distribution<float> level(0, 1);
    std::vector<glm::vec3> smooth, noise;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const auto u = static_cast<float>(x) / width, v = static_cast<float>(y) / height;
            smooth.emplace_back(0.2f + 0.6f * u, 0.3f + 0.5f * v, 0.9f - 0.7f * u * v);
            noise.emplace_back(level(random), level(random), level(random));
        }
    for (const auto* colors : {&smooth, &noise})
        for (const Imf::Chromaticities* space : {static_cast<const Imf::Chromaticities*>(nullptr), &ap1})
            for (const auto compression : {Imf::NO_COMPRESSION, Imf::ZIP_COMPRESSION, Imf::PIZ_COMPRESSION}) {
                write_chroma(width, height, *colors, space, compression);
                const ColorPicture read = read_exr_texture(file());
                ASSERT_EQ(read.width, static_cast<uint32_t>(width));
                ASSERT_EQ(read.height, static_cast<uint32_t>(height));
                std::vector<Imf::Rgba> expected(read.texels.size());
                Imf::RgbaInputFile in(file().c_str());
                in.setFrameBuffer(expected.data() + 4 - 6 * width, 1, width);
                in.readPixels(6, height + 5);
                float worst = 0, off = 0, library_off = 0;
                for (size_t i = width; i < expected.size(); ++i) {  // the first row's neighbors are not the library's
                    const glm::vec3 e(expected[i].r, expected[i].g, expected[i].b);
                    for (int c = 0; c < 3; ++c) {
                        worst = std::max(worst, std::abs(read.texels[i][c] - e[c]));
                        off = std::max(off, std::abs(read.texels[i][c] - (*colors)[i][c]));
                        library_off = std::max(library_off, std::abs(e[c] - (*colors)[i][c]));
                    }
                }
                // The library rounds to halves at every step.
                EXPECT_LT(worst, colors == &smooth ? 0.003f : 0.02f);
                EXPECT_LT(off, library_off + 0.003f);
            }
}

TEST_F(ExrTextures, HalvedGrayIsExact) {
    std::vector<glm::vec3> gray;
    for (int i = 0; i < 8 * 6; ++i) gray.emplace_back(static_cast<float>(i) / 64);
    write_chroma(8, 6, gray, nullptr);
    EXPECT_EQ(read_exr_texture(file()).texels, gray);
}

TEST_F(ExrTextures, OtherSamplingIsRefused) {
    const auto write_sampled = [&](const char* name, int x, int y) {
        Imf::Header header(8, 8);
        std::vector<float> values(64, 0.5f);
        Imf::FrameBuffer buffer;
        for (const char* each : {"Y", "RY", "BY"}) {
            const int sx = std::string(each) == name ? x : 1, sy = std::string(each) == name ? y : 1;
            header.channels().insert(each, Imf::Channel(Imf::FLOAT, sx, sy));
            buffer.insert(each, Imf::Slice::Make(Imf::FLOAT, values.data(), header.dataWindow(), 0, 0, sx, sy));
        }
        Imf::OutputFile out(file().c_str(), header);
        out.setFrameBuffer(buffer);
        out.writePixels(8);
    };
    write_sampled("RY", 4, 4);
    expect_refused("channel RY is subsampled; convert it to one value per pixel, or one for two by two");
    write_sampled("BY", 2, 1);
    expect_refused("channel BY is subsampled; convert it to one value per pixel, or one for two by two");
    write_sampled("Y", 2, 2);
    expect_refused("channel Y is subsampled; convert it to one value per pixel");
    write_sampled("BY", 2, 2);
    EXPECT_EQ(read_exr_texture(file()).texels.size(), 64u);
}

TEST_F(ExrTextures, WhatTheFileSaysOfItsColors) {
    const auto colors = [&](const std::function<void(Imf::Header&)>& change, bool half = false) {
        Imf::Header header(1, 1);
        header.channels().insert("Y", Imf::Channel(half ? Imf::HALF : Imf::FLOAT));
        change(header);
        const float value = 0.5f;
        const Imf::Rgba halves(0.5f, 0, 0);
        Imf::FrameBuffer buffer;
        buffer.insert("Y", half ? Imf::Slice::Make(Imf::HALF, &halves.r, header.dataWindow())
                                : Imf::Slice::Make(Imf::FLOAT, &value, header.dataWindow()));
        {
            Imf::OutputFile out(file().c_str(), header);
            out.setFrameBuffer(buffer);
            out.writePixels(1);
        }
        FileColors found;
        read_exr_texture(file(), {}, &found);
        return found;
    };
    FileColors found = colors([](Imf::Header&) {});
    EXPECT_EQ(found.id, "");
    EXPECT_FALSE(found.chromaticities || found.is_aces || found.is_half);
    found = colors(
        [](Imf::Header& header) {
            header.insert("chromaticities", Imf::ChromaticitiesAttribute(ap1));
            header.insert("colorInteropID", Imf::StringAttribute("g22_ap1_scene"));
            header.insert("acesImageContainerFlag", Imf::IntAttribute(1));
        },
        true);
    EXPECT_EQ(found.id, "g22_ap1_scene");
    EXPECT_EQ(found.chromaticities,
              (Chromaticities{0.713f, 0.293f, 0.165f, 0.83f, 0.128f, 0.044f, 0.32168f, 0.33767f}));
    EXPECT_TRUE(found.is_aces && found.is_half);
    EXPECT_ERROR(colors([](Imf::Header& header) { header.insert("colorInteropID", Imf::IntAttribute(3)); }),
                 ExitCode::file,
                 file() +
                     ": cannot read: its attribute colorInteropID is of the type int; it must be of the type "
                     "string");
    EXPECT_ERROR(colors([](Imf::Header& header) { header.insert("chromaticities", Imf::StringAttribute("x")); }),
                 ExitCode::file,
                 file() +
                     ": cannot read: its attribute chromaticities is of the type string; it must be of the type "
                     "chromaticities");
}

}  // namespace
}  // namespace cistula
