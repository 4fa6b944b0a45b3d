// Parts of EXR files and their channels, read as they are wanted.
#include "image/exr/exr_file.h"

#include <OpenEXR/ImfOutputFile.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "image/exr/exr.h"
#include "testing/support/expect_error.h"
#include "testing/support/pictures/exr_parts.h"
#include "testing/support/scratch_directory.h"

namespace cistula {
namespace {

using Type = ExrChannel::Type;

const std::vector<test::Part> two_parts = {
    {"beauty", 3, 2, {{"R", {1, 2, 3, 4, 5, 6}, {}}, {"id", {}, {0, 1, 1u << 24, (1u << 24) + 1, 7, 0xffffffff}}}},
    {"depth", 2, 5, {{"Z", {9, 8, 7, 6, 5, 4, 3, 2, 1, 0}, {}}}, true}};

TEST(ExrFile, ReadsScanLineAndTiledParts) {
    const ScratchDirectory scratch;
    test::write_parts(scratch.file("a.exr"), two_parts);
    const ExrFile file(scratch.file("a.exr"));
    ASSERT_EQ(file.parts().size(), 2u);
    for (size_t i = 0; i < 2; ++i) {
        EXPECT_EQ(file.parts()[i].name, two_parts[i].name);
        EXPECT_EQ(file.parts()[i].width, two_parts[i].width);
        EXPECT_EQ(file.parts()[i].height, two_parts[i].height);
        EXPECT_EQ(file.parts()[i].display.height, 10);
    }
    ASSERT_EQ(file.parts()[0].channels.size(), 2u);
    EXPECT_EQ(file.parts()[0].channels[0].type, Type::float_);
    EXPECT_EQ(file.parts()[0].channels[1].type, Type::uint);
    EXPECT_TRUE(file.parts()[0].channels[0].values.empty());
    EXPECT_EQ(file.read(0, {0})[0].values, two_parts[0].channels[0].values);
    EXPECT_EQ(file.read(1, {0})[0].values, two_parts[1].channels[0].values);
    EXPECT_TRUE(file.read(1, {}).empty());
}

TEST(ExrFile, KeepsWholeNumbersExact) {
    const ScratchDirectory scratch;
    test::write_parts(scratch.file("a.exr"), two_parts);
    const std::vector<ExrChannel> read = ExrFile(scratch.file("a.exr")).read(0, {1, 0});
    ASSERT_EQ(read.size(), 2u);
    EXPECT_EQ(read[0].name, "id");
    EXPECT_EQ(read[0].numbers, two_parts[0].channels[1].numbers);
    EXPECT_EQ(read[0].values, (std::vector<float>{0, 1, 0x1p24f, 0x1p24f, 7, 0x1p32f}));
    EXPECT_EQ(read[1].name, "R");
    EXPECT_TRUE(read[1].numbers.empty());
}

TEST(ExrFile, HasTheAttributesOfItsParts) {
    const ScratchDirectory scratch;
    LayeredPicture picture;
    picture.width = picture.height = 1;
    picture.display_width = 20;
    picture.display_height = 10;
    picture.channels = {{"h", true, {0.5f}}};
    picture.attributes = {{"cistula:zFar", 100.0}, {"owner", std::string("me")}};
    write_exr(scratch.file("a.exr"), picture);
    const ExrFile file(scratch.file("a.exr"));
    ASSERT_EQ(file.parts().size(), 1u);
    for (const auto& [name, value] : picture.attributes) EXPECT_EQ(file.parts()[0].attributes.at(name), value) << name;
    EXPECT_EQ(file.parts()[0].display.height, 10);
    EXPECT_EQ(file.parts()[0].channels[0].type, Type::half);
    EXPECT_EQ(file.read(0, {0})[0].values, std::vector<float>{0.5f});
}

/// Wherever a file is cut, that is an error, be it of the header or of the pixels.
TEST(ExrFile, PartsThatAreCutOffAreErrors) {
    const ScratchDirectory scratch;
    test::write_parts(scratch.file("a.exr"), two_parts);
    const std::string whole = bytes_of(scratch.file("a.exr"));
    const auto read_all = [&] {
        const ExrFile file(scratch.file("b.exr"));
        file.read(0, {0, 1});
        file.read(1, {0});
    };
    put_bytes(scratch.file("b.exr"), whole);
    read_all();
    for (size_t size = 0; size < whole.size(); size += size < 64 ? 1 : 7) {
        put_bytes(scratch.file("b.exr"), whole.substr(0, size));
        try {
            read_all();
            ADD_FAILURE() << "no error at " << size;
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::file) << size;
        }
    }
}

TEST(ExrFile, OnlyWhatIsReadMustHaveAValueForEachPixel) {
    const ScratchDirectory scratch;
    Imf::Header header(4, 2);
    header.channels().insert("Y", Imf::Channel(Imf::FLOAT));
    header.channels().insert("RY", Imf::Channel(Imf::FLOAT, 2, 2));
    std::vector<float> full(8, 3), quarter{1, 2};
    {
        Imf::FrameBuffer buffer;
        buffer.insert("Y", Imf::Slice::Make(Imf::FLOAT, full.data(), header.dataWindow()));
        buffer.insert("RY", Imf::Slice::Make(Imf::FLOAT, quarter.data(), header.dataWindow(), 4, 8, 2, 2));
        Imf::OutputFile file(scratch.file("yc.exr").c_str(), header);
        file.setFrameBuffer(buffer);
        file.writePixels(2);
    }
    const ExrFile file(scratch.file("yc.exr"));
    EXPECT_EQ(file.read(0, {1})[0].values, full);
    EXPECT_TRUE(file.parts()[0].channels[0].is_halved());
    EXPECT_EQ(file.read(0, {0})[0].values, (std::vector<float>{1, 1, 2, 2, 1, 1, 2, 2}));
}

TEST(ExrFile, WhatIsNoFileIsAnError) {
    const ScratchDirectory scratch;
    EXPECT_THROW(ExrFile(scratch.file("none.exr")), Error);
    EXPECT_THROW(ExrFile(scratch.file("")), Error);
    ASSERT_EQ(mkfifo(scratch.file("pipe.exr").c_str(), 0600), 0);
    EXPECT_THROW(ExrFile(scratch.file("pipe.exr")), Error);  // and is not waited for
    for (const auto read :
         {+[](const std::string& path) { read_exr(path); }, +[](const std::string& path) { read_exr_parts(path); },
          +[](const std::string& path) { read_exr_texture(path); }})
        EXPECT_ERROR(read(scratch.file("pipe.exr")), ExitCode::file,
                     scratch.file("pipe.exr") + ": cannot read: it is a pipe, a socket or a device; give a file");
}

}  // namespace
}  // namespace cistula
