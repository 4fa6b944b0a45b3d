// Pictures of kinds that OpenImageIO 2.4 reads as others, without a word, are refused by name.
#include <gtest/gtest.h>

#include <optional>

#include "base/error.h"
#include "image/reader/picture_reader.h"
#include "scene/assets/assets.h"
#include "testing/support/byte_order.h"
#include "testing/support/scratch_directory.h"

namespace cistula {
namespace {

class MisreadPictures : public testing::Test {
  protected:
    /// Why `bytes` are not read under this name; "" if they are, and then what is read in `picture`.
    std::string refusal(const std::string& name, const std::string& bytes, ColorPicture* picture = nullptr) {
        const std::string path = folder_.file(name), start = path + ": cannot read: ";
        put_bytes(path, bytes);
        try {
            const ColorPicture read = reader_.read(path, nullptr);
            if (picture) *picture = read;
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::file);
            EXPECT_EQ(std::string(error.what()).rfind(start, 0), 0u) << error.what();
            return std::string(error.what()).substr(start.size());
        }
        return "";
    }

    const ScratchDirectory folder_;
    TextureReader reader_;
};

struct TiffForm {
    bool little = true, big_tiff = false;
};
constexpr TiffForm tiff_forms[] = {{true, false}, {false, false}, {true, true}, {false, true}};

/// A gray TIFF of 8 x 8 pixels, each row of which is `row`.
std::string tiff(const TiffForm& form, std::optional<int> bits, int photometric, const std::string& row) {
    const auto number = [&](uint64_t value, int size) {
        return form.little ? test::little_endian(value, size) : test::big_endian(value, size);
    };
    const int word = form.big_tiff ? 8 : 4;
    std::string samples, entries;
    for (int i = 0; i < 8; ++i) samples += row;
    const uint64_t first = form.big_tiff ? 16 : 8;
    uint64_t count = 0;
    const auto add = [&](uint64_t tag, uint64_t type, uint64_t value) {
        const int size = type == 3 ? 2 : 4;
        entries += number(tag, 2) + number(type, 2) + number(1, word) + number(value, size) +
                   std::string(static_cast<size_t>(word - size), '\0');
        ++count;
    };
    add(256, 3, 8);
    add(257, 3, 8);
    if (bits) add(258, 3, static_cast<uint64_t>(*bits));
    add(259, 3, 1);
    add(262, 3, static_cast<uint64_t>(photometric));
    add(273, 4, first);
    add(277, 3, 1);
    add(278, 3, 8);
    add(279, 4, samples.size());
    const std::string head = form.big_tiff ? number(43, 2) + number(8, 2) + number(0, 2) : number(42, 2);
    return (form.little ? "II" : "MM") + head + number(first + samples.size(), word) + samples +
           number(count, form.big_tiff ? 8 : 2) + entries + number(0, word);
}

TEST_F(MisreadPictures, BilevelTiffWithoutItsBits) {
    for (const TiffForm& form : tiff_forms) {
        EXPECT_EQ(refusal("a.tif", tiff(form, {}, 1, "\x81")),
                  "it has no tag BitsPerSample, and so 1 bit a sample, and would be read as if it had 8; save it with "
                  "the tag, or as PNG");
        ColorPicture picture;
        EXPECT_EQ(refusal("a.tif", tiff(form, 1, 1, "\x81"), &picture), "");
        ASSERT_EQ(picture.texels.size(), 64u);
        EXPECT_EQ(picture.texels[0], glm::vec3(1));
        EXPECT_EQ(picture.texels[1], glm::vec3(0));
    }
}

TEST_F(MisreadPictures, TiffWhoseZeroIsWhiteOfMoreThanEightBits) {
    const std::string row(16, '\0');
    for (const TiffForm& form : tiff_forms) {
        for (const int bits : {10, 12, 14, 16})
            EXPECT_EQ(refusal("a.tif", tiff(form, bits, 0, row.substr(0, static_cast<size_t>(bits)))),
                      "its samples have " + std::to_string(bits) +
                          " bits, and 0 is white (WhiteIsZero), which would be read as black; save it with 0 as black, "
                          "or as PNG");
        ColorPicture white, black;
        EXPECT_EQ(refusal("a.tif", tiff(form, 8, 0, row.substr(0, 8)), &white), "");
        EXPECT_EQ(refusal("a.tif", tiff(form, 16, 1, row), &black), "");
        ASSERT_EQ(white.texels.size(), 64u);
        ASSERT_EQ(black.texels.size(), 64u);
        EXPECT_EQ(white.texels[9], glm::vec3(1));
        EXPECT_EQ(black.texels[9], glm::vec3(0));
    }
}

TEST_F(MisreadPictures, RadianceThatDoesNotBeginAtTheTopLeft) {
    const auto hdr = [](const std::string& resolution) {
        return "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n" + resolution + "\n" + std::string(8, '\x80');
    };
    EXPECT_EQ(refusal("a.hdr", hdr("-Y 2 +X 1")), "");
    for (const char* resolution : {"+Y 2 +X 1", "-Y 2 -X 1", "+Y 2 -X 1", "+X 1 +Y 2", "+X 1 -Y 2", "-X 1 -Y 2"})
        EXPECT_EQ(refusal("a.hdr", hdr(resolution)),
                  "its resolution line is '" + std::string(resolution) +
                      "', and it would be read as '-Y HEIGHT +X WIDTH', from the top left; save it so, or as EXR");
}

class RadianceFactors : public MisreadPictures {
  protected:
    /// A picture of two texels, (1, 0.5, 0.25) each, if its numbers had no factors.
    static std::string hdr(const std::string& lines) {
        return "#?RADIANCE\n" + lines + "FORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n\x80\x40\x20\x81\x80\x40\x20\x81";
    }
    glm::vec3 texel(const std::string& lines) {
        ColorPicture picture;
        EXPECT_EQ(refusal("a.hdr", hdr(lines), &picture), "");
        return picture.texels.empty() ? glm::vec3(NAN) : picture.texels.at(0);
    }
};

TEST_F(RadianceFactors, AreDividedOut) {
    const glm::vec3 whole = texel("");
    EXPECT_GT(whole.x, whole.y);
    EXPECT_EQ(texel("EXPOSURE=1\n"), whole);
    EXPECT_EQ(texel("EXPOSURE=0.5\n"), 2.0f * whole);
    EXPECT_EQ(texel("EXPOSURE=8\nEXPOSURE= 5.000000e-01\n"), 0.25f * whole);
    EXPECT_EQ(texel("COLORCORR= 1 0.5 0.25\nEXPOSURE=2\n"), glm::vec3(0.5f, 1, 2) * whole);
    ColorPicture bare;
    EXPECT_EQ(refusal("a.hdr", hdr("EXPOSURE=0.5\n").substr(std::string("#?RADIANCE\n").size()), &bare), "");
    EXPECT_EQ(bare.texels.at(0), 2.0f * whole) << "what does not begin as such is read, too";
    EXPECT_EQ(texel("EXPOSURE=3\n"), glm::vec3(glm::dvec3(whole) / 3.0));
    for (const char* line : {"EXPOSURE=0\n", "EXPOSURE=-1\n", "EXPOSURE=x\n", "COLORCORR=1 1\n"})
        EXPECT_EQ(refusal("a.hdr", hdr(line)),
                  "its header's EXPOSURE or COLORCORR is no number above 0, by which its numbers could be divided");
}

TEST_F(RadianceFactors, AreSaid) {
    SceneDescription scene;
    scene.source = "test.json";
    for (const char* lines : {"", "EXPOSURE=4\nEXPOSURE=4\n", "COLORCORR=1 2 0.5\n"}) {
        scene.textures.emplace_back().file = folder_.file(std::to_string(scene.textures.size()) + ".hdr");
        put_bytes(scene.textures.back().file, hdr(lines));
    }
    for (int i = 0; i < 3; ++i) {
        scene.sky.emplace().texture = i;
        const SceneAssets assets = load_assets(scene);
        const std::string start =
            "test.json: /textures/" + std::to_string(i) + ": " + scene.textures[size_t(i)].file +
            ": its header says that its numbers were multiplied (EXPOSURE, COLORCORR): they are divided by ";
        EXPECT_EQ(assets.warnings, i == 0   ? std::vector<std::string>{}
                                   : i == 1 ? std::vector<std::string>{start + "16"}
                                            : std::vector<std::string>{start + "1, 2, 0.5"});
    }
}

}  // namespace
}  // namespace cistula
