// EXRs that are not pictures of floats in one part are refused by name: they would compare equal where they are not.
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfDeepFrameBuffer.h>
#include <OpenEXR/ImfDeepScanLineOutputFile.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfPartType.h>
#include <gtest/gtest.h>

#include <array>

#include "image/exr/exr.h"
#include "image/exr/exr_file.h"
#include "testing/support/expect_error.h"
#include "testing/support/pictures/exr_parts.h"
#include "testing/support/scratch_directory.h"

namespace cistula {
namespace {

constexpr int width = 4, height = 2;

Imf::Header header_with(const char* channel, Imf::PixelType type) {
    Imf::Header header(width, height);
    header.channels().insert(channel, Imf::Channel(type));
    return header;
}

TEST(ExrKinds, FilesOfSeveralPartsAreRefused) {
    const ScratchDirectory scratch;
    const std::string path = scratch.file("parts.exr");
    const std::vector<float> values(width * height, 0.5f);
    test::write_parts(path,
                      {{"left", width, height, {{"Z", values, {}}}}, {"right", width, height, {{"Z", values, {}}}}});
    EXPECT_ERROR(read_exr(path), ExitCode::file, path + ": cannot read: it has 2 parts; give a file of one part");
    // As a texture it is its first part.
    EXPECT_EQ(read_exr_texture(path).texels, std::vector<glm::vec3>(width * height, glm::vec3(0.5f)));
}

TEST(ExrKinds, DeepFilesAreRefused) {
    const ScratchDirectory scratch;
    const std::string path = scratch.file("deep.exr");
    Imf::Header header = header_with("Z", Imf::FLOAT);
    header.setType(Imf::DEEPSCANLINE);
    header.compression() = Imf::ZIPS_COMPRESSION;
    std::array<unsigned int, width * height> counts;
    std::array<std::array<float, 2>, width * height> samples{};
    std::array<float*, width * height> pointers;
    for (size_t i = 0; i < counts.size(); ++i) counts[i] = 2, pointers[i] = samples[i].data();
    {
        Imf::DeepScanLineOutputFile file(path.c_str(), header);
        Imf::DeepFrameBuffer buffer;
        buffer.insertSampleCountSlice(Imf::Slice(Imf::UINT, reinterpret_cast<char*>(counts.data()),
                                                 sizeof(unsigned int), sizeof(unsigned int) * width));
        buffer.insert("Z", Imf::DeepSlice(Imf::FLOAT, reinterpret_cast<char*>(pointers.data()), sizeof(float*),
                                          sizeof(float*) * width, sizeof(float)));
        file.setFrameBuffer(buffer);
        file.writePixels(height);
    }
    EXPECT_ERROR(read_exr(path), ExitCode::file,
                 path + ": cannot read: it is deep, with several samples in a pixel; flatten it first");
    EXPECT_ERROR(ExrFile{path}, ExitCode::file,
                 path + ": cannot read: it is deep, with several samples in a pixel; flatten it first");
    EXPECT_ERROR(read_exr_texture(path), ExitCode::file,
                 path + ": cannot read: it is deep, with several samples in a pixel; flatten it first");
}

TEST(ExrKinds, WholeNumbersAreReadWhereFloatsTellThemApart) {
    const ScratchDirectory scratch;
    const std::string path = scratch.file("ids.exr");
    const auto write = [&](uint32_t last) {
        const Imf::Header header = header_with("id", Imf::UINT);
        std::array<uint32_t, width * height> values{};
        values.back() = last;
        Imf::FrameBuffer buffer;
        buffer.insert("id", Imf::Slice::Make(Imf::UINT, values.data(), header.dataWindow()));
        Imf::OutputFile file(path.c_str(), header);
        file.setFrameBuffer(buffer);
        file.writePixels(height);
    };
    write((1u << 24) - 1);
    EXPECT_EQ(read_exr(path).channels[0].values.back(), 16777215.0f);
    for (const uint32_t large : {1u << 24, (1u << 24) + 1, 0xffffffffu}) {
        write(large);
        EXPECT_ERROR(
            read_exr(path), ExitCode::file,
            path + ": cannot read: channel id has whole numbers of 2^24 or more, which are not told apart here");
    }
}

}  // namespace
}  // namespace cistula
