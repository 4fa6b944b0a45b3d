// Pictures that are meant to do harm, and pictures that are cut off: each is an error of one line, soon, and takes no
// more memory than is allowed.
#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <chrono>

#include "base/error.h"
#include "bombs.h"
#include "image/reader/picture_reader.h"
#include "testing/support/scratch_directory.h"

namespace cistula {
namespace {

/// What reading `bytes` under this name says; "" if it is read.
std::string outcome(TextureReader& reader, const std::string& name, const std::string& bytes) {
    const ScratchDirectory scratch;
    const std::string path = scratch.file(name), start = path + ": cannot read: ";
    put_bytes(path, bytes);
    const auto begin = std::chrono::steady_clock::now();
    std::string reason;
    try {
        ClampedTexels clamped;
        reader.read(path, &clamped);
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::file);
        const std::string what = error.what();
        EXPECT_EQ(what.substr(0, start.size()), start);
        for (const char c : what) EXPECT_GE(static_cast<unsigned char>(c), 0x20) << what;
        reason = what.substr(std::min(start.size(), what.size()));
        EXPECT_FALSE(reason.empty());
    }
    EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::minutes(5)) << name;
    return reason;
}

std::string outcome(const std::string& name, const std::string& bytes,
                    const TextureLimits& limits = {100'000'000, 20}) {
    TextureReader reader(limits);
    return outcome(reader, name, bytes);
}

constexpr const char* too_large =
    "its size is 60000x60000, which takes 43.2 GB of memory; textures may take 0.1 GB; give a smaller one, or raise "
    "the "
    "limit (`max_texture_gb` of render)";

TEST(HostilePictures, SizesThatHeadersClaim) {
    TextureReader reader({100'000'000, 20});
    EXPECT_EQ(outcome(reader, "a.png", bombs::png(60000, 60000, bombs::zeros(1000))), too_large);
    EXPECT_EQ(outcome(reader, "a.bmp", bombs::bmp(60000, 60000)), too_large);
    EXPECT_EQ(outcome(reader, "a.tga", bombs::tga(60000, 60000, 2)), too_large);
    EXPECT_EQ(outcome(reader, "b.tga", bombs::tga(60000, 60000, 10)), too_large);
    EXPECT_EQ(outcome(reader, "a.hdr", bombs::hdr(60000, 60000)), too_large);
    EXPECT_EQ(outcome(reader, "a.jpg", bombs::jpeg(60000, 60000)), too_large);
    EXPECT_EQ(outcome(reader, "a.dds", bombs::dds(60000, 60000)), too_large);
}

TEST(HostilePictures, ZerosThatUnfoldToGigabytes) {
    const uint32_t width = 60000, height = 33000;
    const std::string bytes = bombs::png(width, height, bombs::zeros((3ull * width + 1) * height));  // 5.9 GB
    EXPECT_LT(bytes.size(), 7'000'000u);
    EXPECT_EQ(outcome("a.png", bytes).substr(0, 47), "its size is 60000x33000, which takes 23.76 GB o");
    // A text chunk unfolds, too.
    const std::string text = bombs::png_chunk("zTXt", std::string("name\0\0", 6) + bombs::zeros(1ull << 31));
    const std::string inner = bombs::png(8, 8, bombs::zeros(25 * 8), text);
    outcome("b.png", inner);  // read, or refused; but soon, and in memory that is allowed
}

TEST(HostilePictures, DdsWithoutAnEnd) {
    TextureReader reader({1'000'000'000, 20});
    const auto expect_cut = [&](const std::string& bytes, const std::string& needed) {
        EXPECT_EQ(outcome(reader, "a.dds", bytes),
                  "it is cut off: it has " + std::to_string(bytes.size()) + " bytes, and its header says " + needed);
    };
    expect_cut(bombs::dds(8000, 8000), "192000128");
    expect_cut(bombs::dds(8000, 8000, "DXT1"), "32000128");
    expect_cut(bombs::dds(8000, 8000, "DXT5"), "64000128");
    const std::string whole = bombs::dds(2, 2) + std::string(12, '\x40');
    EXPECT_EQ(outcome(reader, "a.dds", whole), "");
    expect_cut(whole.substr(0, whole.size() - 1), "140");
    EXPECT_EQ(outcome(reader, "a.dds", bombs::dds(5, 4, "DXT1") + std::string(16, '\0')), "");
    expect_cut(bombs::dds(5, 4, "DXT1") + std::string(15, '\0'), "144");
    // OpenImageIO 2.4 looks for the first bit of a mask without end.
    EXPECT_EQ(outcome(reader, "a.dds", bombs::dds(4, 4, "", 0) + std::string(48, '\x81')),
              "its header gives a channel no bits: a mask is 0");
    // It goes over as many levels as the header says.
    std::string levels = bombs::dds(4, 4, "DXT1") + std::string(8, '\0');
    levels[10] |= 2;  // it has levels
    levels.replace(28, 4, "\xff\xff\xff\x7f");
    EXPECT_EQ(outcome(reader, "a.dds", levels), "its header says that it has 2147483647 levels of a mip map");
}

TEST(HostilePictures, FilesThatAreCutOff) {
    const ScratchDirectory scratch;
    std::vector<uint8_t> samples(40 * 30 * 3);
    for (size_t i = 0; i < samples.size(); ++i) samples[i] = static_cast<uint8_t>(i * i * 2654435761u >> 13);
    TextureReader reader({100'000'000, 20});
    for (const char* extension : {"png", "jpg", "bmp", "tga", "hdr", "exr", "tif", "gif", "ppm", "webp"}) {
        const std::string name = std::string("a.") + extension, path = scratch.file(name);
        const auto output = OIIO::ImageOutput::create(path);
        ASSERT_TRUE(output) << name;
        ASSERT_TRUE(output->open(path, OIIO::ImageSpec(40, 30, 3, OIIO::TypeDesc::UINT8))) << output->geterror();
        ASSERT_TRUE(output->write_image(OIIO::TypeDesc::UINT8, samples.data())) << output->geterror();
        ASSERT_TRUE(output->close());
        const std::string bytes = bytes_of(path);
        EXPECT_EQ(outcome(reader, name, bytes), "") << name;
        for (const double share : {0.002, 0.02, 0.3, 0.6, 0.85})  // a footer, at the end of some, is no loss
            EXPECT_NE(outcome(reader, name,
                              bytes.substr(0, static_cast<size_t>(share * static_cast<double>(bytes.size())) + 1)),
                      "")
                << name << ", " << share;
    }
}

TEST(HostilePictures, AJpegEndsWithItsMarkerNotThatOfAPictureInside) {
    const std::string inner = "\xff\xd8\xff\xd9", thumbnail = std::string("\xff\xe1\x00\x06", 4) + inner;
    const std::string bytes = bombs::jpeg(16, 16);
    const std::string cut = bytes.substr(0, 2) + thumbnail + bytes.substr(2);
    EXPECT_EQ(outcome("a.jpg", cut), "it is cut off: a JPEG file ends with a marker, and this one does not");
    EXPECT_EQ(outcome("a.jpg", cut + "\xff\xd9"), "");
    EXPECT_EQ(outcome("a.jpg", cut + "\xff\xd9 and more"), "");
}

TEST(HostilePictures, NonsenseUnderEveryName) {
    TextureReader reader({100'000'000, 20});
    std::string nonsense;
    for (uint32_t i = 0; i < 3000; ++i) nonsense += static_cast<char>((i + 7) * (i + 3) * 2654435761u >> 17);
    for (const char* extension :
         {"png", "jpg", "bmp", "tga", "hdr", "exr", "tif", "gif", "ppm",  "webp", "dds",    "psd",
          "sgi", "iff", "ico", "rla", "dpx", "cin", "jp2", "pic", "fits", "mp4",  "nothing"})
        EXPECT_NE(outcome(reader, std::string("a.") + extension, nonsense), "") << extension;
}

}  // namespace
}  // namespace cistula
