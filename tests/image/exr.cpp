// OpenEXR files come back bit for bit, equal pictures are equal files, and damaged files are errors, never crashes.
#include "image/exr/exr.h"

#include <Imath/half.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfThreading.h>
#include <OpenEXR/ImfTiledOutputFile.h>
#include <gtest/gtest.h>
#include <tbb/task_arena.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstring>
#include <random>
#include <thread>

#include "cistula/numerics/portable.h"
#include "image/exr/exr_file.h"
#include "testing/support/expect_error.h"
#include "testing/support/file_size_limit.h"
#include "testing/support/scratch_directory.h"
#include "testing/support/special_values.h"

namespace cistula {
namespace {

using test::infinity;
using test::nan;

/// Noise in every bit: NaN, infinities and subnormals among the floats; halves hold values that halves can hold.
LayeredPicture noise(int width, int height, uint32_t seed) {
    LayeredPicture picture;
    picture.width = width;
    picture.height = height;
    picture.display_width = width;
    picture.display_height = height;
    std::mt19937 random(seed);
    for (const char* name : {"A", "B", "G", "N.X", "R", "Z", "error.R", "id"}) {
        LayeredPicture::Channel channel{name, std::string(name).size() == 1 && name[0] != 'Z', {}};
        for (int i = 0; i < width * height; ++i) {
            if (channel.half) {
                half value;
                value.setBits(static_cast<uint16_t>(random()));
                channel.values.push_back(value.isNan() ? 1.0f : static_cast<float>(value));
            } else {
                channel.values.push_back(bits_as<float>(static_cast<uint32_t>(random())));
            }
        }
        picture.channels.push_back(channel);
    }
    return picture;
}

/// A smooth picture, which compresses as renders do.
LayeredPicture gradient(int width, int height) {
    LayeredPicture picture = noise(width, height, 1);
    for (auto& channel : picture.channels)
        for (int i = 0; i < width * height; ++i)
            channel.values[static_cast<size_t>(i)] = static_cast<float>(i % width + i / width) / 64.0f;
    return picture;
}

void expect_same_pixels(const LayeredPicture& a, const LayeredPicture& b) {
    ASSERT_EQ(a.channels.size(), b.channels.size());
    for (size_t c = 0; c < a.channels.size(); ++c) {
        EXPECT_EQ(a.channels[c].name, b.channels[c].name);
        EXPECT_EQ(a.channels[c].half, b.channels[c].half);
        ASSERT_EQ(a.channels[c].values.size(), b.channels[c].values.size());
        EXPECT_EQ(std::memcmp(a.channels[c].values.data(), b.channels[c].values.data(),
                              a.channels[c].values.size() * sizeof(float)),
                  0)
            << a.channels[c].name;
    }
}

TEST(Exr, RoundTripKeepsEveryBit) {
    const ScratchDirectory scratch;
    for (const int height : {1, 15, 16, 17, 50}) {
        const LayeredPicture picture = noise(37, height, static_cast<uint32_t>(height));
        write_exr(scratch.file("a.exr"), picture);
        const LayeredPicture back = read_exr(scratch.file("a.exr"));
        EXPECT_EQ(back.width, 37);
        EXPECT_EQ(back.height, height);
        expect_same_pixels(picture, back);
    }
    EXPECT_EQ(scratch.names(), std::vector<std::string>{"a.exr"});
}

TEST(Exr, SpecialValues) {
    const ScratchDirectory scratch;
    LayeredPicture picture;
    picture.width = picture.display_width = 5;
    picture.height = picture.display_height = 1;
    const std::vector<float> values = {infinity, -infinity, 0x1p-149f, -0.0f, nan};
    picture.channels = {{"h", true, {1 + 0x1p-11f, 65519, 65520, 0x1p-24f, nan}}, {"x", false, values}};
    write_exr(scratch.file("a.exr"), picture);
    const LayeredPicture back = read_exr(scratch.file("a.exr"));
    EXPECT_EQ(std::memcmp(back.channels[1].values.data(), values.data(), 20), 0);
    // Halves round to nearest, ties to even; past the largest to infinity.
    const std::vector<float>& halves = back.channels[0].values;
    EXPECT_EQ(std::vector<float>(halves.begin(), halves.end() - 1), (std::vector<float>{1, 65504, infinity, 0x1p-24f}));
    EXPECT_NE(halves[4], halves[4]);
}

TEST(Exr, ChannelsAreFoundByNameWhateverTheirOrder) {
    const ScratchDirectory scratch;
    LayeredPicture picture = noise(9, 9, 3);
    write_exr(scratch.file("a.exr"), picture);
    std::reverse(picture.channels.begin(), picture.channels.end());
    write_exr(scratch.file("b.exr"), picture);
    EXPECT_EQ(bytes_of(scratch.file("a.exr")), bytes_of(scratch.file("b.exr")));
}

TEST(Exr, CropWindows) {
    const ScratchDirectory scratch;
    LayeredPicture picture = noise(20, 10, 5);
    picture.x = 33;
    picture.y = 44;
    picture.display_width = 640;
    picture.display_height = 480;
    write_exr(scratch.file("a.exr"), picture);
    const LayeredPicture back = read_exr(scratch.file("a.exr"));
    EXPECT_EQ(back.x, 33);
    EXPECT_EQ(back.y, 44);
    EXPECT_EQ(back.width, 20);
    EXPECT_EQ(back.height, 10);
    EXPECT_EQ(back.display_width, 640);
    EXPECT_EQ(back.display_height, 480);
    expect_same_pixels(picture, back);
    const Imf::InputFile file(scratch.file("a.exr").c_str());
    EXPECT_EQ(file.header().dataWindow(), Imath::Box2i(Imath::V2i(33, 44), Imath::V2i(52, 53)));
    EXPECT_EQ(file.header().displayWindow(), Imath::Box2i(Imath::V2i(0, 0), Imath::V2i(639, 479)));
    EXPECT_EQ(file.header().compression(), Imf::ZIP_COMPRESSION);
    EXPECT_FALSE(file.header().hasTileDescription());
    picture.x = picture.y = -5;  // overscan
    write_exr(scratch.file("a.exr"), picture);
    EXPECT_EQ(read_exr(scratch.file("a.exr")).x, -5);
}

TEST(Exr, Attributes) {
    const ScratchDirectory scratch;
    LayeredPicture picture = noise(4, 4, 6);
    std::vector<float> matrix(16);
    for (size_t i = 0; i < 16; ++i) matrix[i] = static_cast<float>(i) + 0.5f;
    picture.attributes["worldToCamera"] = matrix;
    picture.attributes["worldToNDC"] = std::vector<float>(16, 0.25f);
    picture.attributes["chromaticities"] = std::vector<float>{.64f, .33f, .3f, .6f, .15f, .06f, .3127f, .329f};
    picture.attributes["cistula:scene"] = std::string("0123abcd\nsecond line, \"quoted\"");
    picture.attributes["empty"] = std::string();
    picture.attributes["depth"] = -16;
    picture.attributes["cutoff"] = 0.1;
    picture.attributes["rate"] = Ratio{24000, 1001};
    picture.attributes["screenWindowWidth"] = 1.25;
    picture.attributes["bound"] = std::vector<float>{1, 2, 3};
    picture.attributes[std::string(100, 'n')] = 7;
    write_exr(scratch.file("a.exr"), picture);
    EXPECT_EQ(read_exr(scratch.file("a.exr")).attributes, picture.attributes);

    const Imf::InputFile file(scratch.file("a.exr").c_str());
    ASSERT_TRUE(Imf::hasWorldToCamera(file.header()));
    ASSERT_TRUE(Imf::hasWorldToNDC(file.header()));
    ASSERT_TRUE(Imf::hasChromaticities(file.header()));
    EXPECT_EQ(Imf::worldToCamera(file.header())[1][2], 6.5f);
    EXPECT_EQ(Imf::chromaticities(file.header()).white, Imath::V2f(.3127f, .329f));
}

TEST(Exr, APictureInMemoryIsAFileAsItWouldBeRead) {
    const ScratchDirectory scratch;
    LayeredPicture picture = gradient(21, 13);
    picture.attributes["owner"] = std::string("me");
    write_exr(scratch.file("a.exr"), picture);
    const StoredFile read = read_stored_exr(scratch.file("a.exr")), made = stored_file(picture);
    ASSERT_EQ(read.pictures.size(), 1u);
    ASSERT_EQ(made.pictures.size(), 1u);
    const StoredPicture &a = made.pictures[0], &b = read.pictures[0];
    EXPECT_EQ(a.data, b.data);
    EXPECT_EQ(a.display, b.display);
    ASSERT_EQ(a.channels.size(), b.channels.size());
    for (const StoredChannel& channel : a.channels) {
        ASSERT_NE(b.channel(channel.name), nullptr);
        EXPECT_EQ(channel.type, b.channel(channel.name)->type);
        if (channel.type == StoredType::float_) {
            EXPECT_EQ(channel.values, b.channel(channel.name)->values);
        }
    }
    EXPECT_EQ(a.attributes.at("owner").text, b.attributes.at("owner").text);
}

TEST(Exr, EqualPicturesAreEqualFiles) {
    const ScratchDirectory scratch;
    LayeredPicture picture = gradient(201, 133);
    picture.attributes["depth"] = 16;
    std::string first;
    for (const Compression compression : {Compression::piz, Compression::zips, Compression::zip}) {
        picture.compression = compression;
        first.clear();
        for (const int threads : {1, 4, 7}) {
            set_exr_threads(threads);
            EXPECT_EQ(Imf::globalThreadCount(), threads);
            const std::string name = scratch.file(std::to_string(threads) + ".exr");
            tbb::task_arena(threads).execute([&] { write_exr(name, picture, 5); });
            if (first.empty()) first = bytes_of(name);
            EXPECT_EQ(bytes_of(name), first) << threads << " threads";
        }
    }
    set_exr_threads(0);
    sleep(1);  // a date in the header would show
    write_exr(scratch.file("later.exr"), picture);
    EXPECT_EQ(bytes_of(scratch.file("later.exr")), first);
    picture.channels[7].values[201 * 100] += 1;
    write_exr(scratch.file("other.exr"), picture);
    EXPECT_NE(bytes_of(scratch.file("other.exr")), first);
}

TEST(Exr, RefusesInconsistentPictures) {
    const ScratchDirectory scratch;
    const LayeredPicture good = noise(4, 4, 7);
    const auto refused = [&](auto change) {
        LayeredPicture bad = good;
        change(bad);
        EXPECT_THROW(write_exr(scratch.file("a.exr"), bad), std::invalid_argument);
    };
    refused([](LayeredPicture& p) { p.channels[3].values.pop_back(); });
    refused([](LayeredPicture& p) { p.channels[3].name = "R"; });
    refused([](LayeredPicture& p) { p.channels.clear(); });
    refused([](LayeredPicture& p) { p.width = 0; });
    refused([](LayeredPicture& p) { p.attributes["version"] = std::string("1.0"); });
    refused([](LayeredPicture& p) { p.attributes["compression"] = 3; });
    EXPECT_TRUE(scratch.names().empty());
}

TEST(Exr, TruncatedFilesAreFound) {
    const ScratchDirectory scratch;
    const std::string whole = scratch.file("a.exr"), cut = scratch.file("cut.exr");
    write_exr(whole, gradient(64, 100));
    EXPECT_TRUE(exr_is_complete(whole));
    const std::string bytes = bytes_of(whole);
    ASSERT_GT(bytes.size(), 2000u);
    for (size_t length = 0; length < bytes.size(); length += length < 700 || length + 40 > bytes.size() ? 1 : 97) {
        put_bytes(cut, bytes.substr(0, length));
        ASSERT_FALSE(exr_is_complete(cut)) << length;
        for (const bool texture : {false, true}) {
            try {
                if (texture)
                    read_exr_texture(cut);
                else
                    read_exr(cut);
                FAIL() << "no error at " << length;
            } catch (const Error& error) {
                ASSERT_EQ(error.kind(), ErrorKind::file);
                const std::string message = error.what();
                ASSERT_EQ(message.rfind(cut + ": cannot read: ", 0), 0u) << message;
                ASSERT_EQ(message.find('\n'), std::string::npos) << message;
            }
        }
    }
    put_bytes(cut, bytes + "x");
    EXPECT_FALSE(exr_is_complete(cut)) << "and those with more";
    for (const Compression compression : {Compression::none, Compression::zips, Compression::piz}) {
        LayeredPicture picture = gradient(64, 100);
        picture.compression = compression;
        write_exr(whole, std::vector<PicturePart>{{"a", picture}, {"b", picture}});
        EXPECT_TRUE(exr_is_complete(whole));
        put_bytes(cut, bytes_of(whole) + '\0');
        EXPECT_FALSE(exr_is_complete(cut));
    }
    EXPECT_FALSE(exr_is_complete(scratch.file("none.exr")));
    EXPECT_FALSE(exr_is_complete(scratch.file("")));
}

TEST(Exr, MissingChunksAreFound) {
    const ScratchDirectory scratch;
    const std::string path = scratch.file("a.exr");
    Imf::Header header(8, 64);
    header.compression() = Imf::ZIP_COMPRESSION;
    header.channels().insert("Y", Imf::Channel(Imf::FLOAT));
    const std::vector<float> values(8 * 64, 0.5f);
    {
        Imf::FrameBuffer buffer;
        buffer.insert("Y", Imf::Slice::Make(Imf::FLOAT, values.data(), header.dataWindow()));
        Imf::OutputFile file(path.c_str(), header);
        file.setFrameBuffer(buffer);
        file.writePixels(32);  // half of them
    }
    EXPECT_FALSE(exr_is_complete(path));
    EXPECT_THROW(read_exr(path), Error);
    EXPECT_THROW(read_exr_texture(path), Error);
}

TEST(Exr, DamagedFilesDoNotCrash) {
    const ScratchDirectory scratch;
    write_exr(scratch.file("a.exr"), gradient(64, 100));
    const std::string bytes = bytes_of(scratch.file("a.exr"));
    std::mt19937 random(11);
    int errors = 0;
    for (int i = 0; i < 600; ++i) {
        std::string damaged = bytes;
        const size_t range = i % 3 == 0 ? bytes.size() : 700;  // the header and the table, mostly
        for (int k = 0; k < 1 + i % 4; ++k) damaged[random() % range] = static_cast<char>(random());
        put_bytes(scratch.file("b.exr"), damaged);
        try {
            read_exr(scratch.file("b.exr"));
        } catch (const Error& error) {
            ASSERT_EQ(error.kind(), ErrorKind::file);
            ++errors;
        }
        exr_is_complete(scratch.file("b.exr"));
    }
    EXPECT_GT(errors, 200);
}

TEST(Exr, Errors) {
    const ScratchDirectory scratch;
    const LayeredPicture picture = noise(4, 4, 8);
    const std::string missing = scratch.file("no/x.exr");
    EXPECT_ERROR(write_exr(missing, picture), ExitCode::file,
                 missing + ": cannot write: No such file or directory; create the directory " + scratch.file("no") +
                     " first, or give another");
    EXPECT_ERROR(read_exr(scratch.file("x.exr")), ExitCode::file,
                 scratch.file("x.exr") + ": cannot read: No such file or directory; check the spelling");
    EXPECT_ERROR(read_exr_texture(scratch.file("x.exr")), ExitCode::file,
                 scratch.file("x.exr") + ": cannot read: No such file or directory; check the spelling");
    put_bytes(scratch.file("text.exr"), "this is no picture at all");
    EXPECT_ERROR(read_exr(scratch.file("text.exr")), ExitCode::file,
                 scratch.file("text.exr") + ": cannot read: Cannot read image file \"" + scratch.file("text.exr") +
                     "\". File is not an image file");
}

TEST(Exr, FullDiskLeavesTheOldFile) {
    const ScratchDirectory scratch;
    const std::string path = scratch.file("a.exr");
    const LayeredPicture picture = noise(100, 100, 9);
    write_exr(path, picture);
    const std::string old = bytes_of(path);
    for (const size_t most : {size_t(0), size_t(10), size_t(5000), old.size() / 2, old.size() - 1}) {
        {
            const FileSizeLimit limit(most);
            EXPECT_ERROR(write_exr(path, picture), ExitCode::file,
                         path +
                             ": cannot write: File too large; raise the limit on file sizes (ulimit -f), or give a "
                             "place on another disk");
        }
        EXPECT_EQ(bytes_of(path), old) << most;
        EXPECT_EQ(scratch.names(), std::vector<std::string>{"a.exr"}) << most;
    }
    const FileSizeLimit limit(old.size());
    write_exr(path, picture);
}

TEST(ExrTexture, ColorsGrayAndHalves) {
    const ScratchDirectory scratch;
    const std::string path = scratch.file("a.exr");
    LayeredPicture picture;
    picture.width = picture.display_width = 2;
    picture.height = picture.display_height = 2;
    picture.channels = {{"R", true, {1, 2, 3, 4}},
                        {"G", false, {.1f, .2f, .3f, .4f}},
                        {"B", false, {5, 6, 7, 8}},
                        {"A", false, {0, 0, 0, 0}},
                        {"Y", false, {9, 9, 9, 9}}};
    write_exr(path, picture);
    ColorPicture texture = read_exr_texture(path);
    EXPECT_EQ(texture.width, 2u);
    EXPECT_EQ(texture.height, 2u);
    EXPECT_EQ(texture.texels, (std::vector<glm::vec3>{{1, .1f, 5}, {2, .2f, 6}, {3, .3f, 7}, {4, .4f, 8}}));

    picture.channels = {{"Y", true, {1, 2, 3, .5f}}};
    write_exr(path, picture);
    texture = read_exr_texture(path);
    EXPECT_EQ(texture.texels, (std::vector<glm::vec3>{{1, 1, 1}, {2, 2, 2}, {3, 3, 3}, {.5f, .5f, .5f}}));
}

TEST(ExrTexture, TilesIntegersAndOtherCompressions) {
    const ScratchDirectory scratch;
    const std::string path = scratch.file("a.exr");
    std::vector<uint32_t> whole(70 * 50);
    for (size_t i = 0; i < whole.size(); ++i) whole[i] = static_cast<uint32_t>(i);
    const auto check = [&] {
        EXPECT_TRUE(exr_is_complete(path));
        const ColorPicture texture = read_exr_texture(path);
        ASSERT_EQ(texture.texels.size(), whole.size());
        for (size_t i = 0; i < whole.size(); ++i) ASSERT_EQ(texture.texels[i], glm::vec3(static_cast<float>(i)));
        const std::string bytes = bytes_of(path);
        put_bytes(path, bytes.substr(0, bytes.size() - 1));
        EXPECT_FALSE(exr_is_complete(path));
        EXPECT_THROW(read_exr_texture(path), Error);
    };
    Imf::FrameBuffer buffer;
    Imf::Header header(70, 50);
    buffer.insert("Y", Imf::Slice::Make(Imf::UINT, whole.data(), header.dataWindow()));
    header.channels().insert("Y", Imf::Channel(Imf::UINT));
    for (const auto compression :
         {Imf::NO_COMPRESSION, Imf::RLE_COMPRESSION, Imf::ZIPS_COMPRESSION, Imf::ZIP_COMPRESSION, Imf::PIZ_COMPRESSION,
          Imf::PXR24_COMPRESSION, Imf::DWAA_COMPRESSION, Imf::DWAB_COMPRESSION}) {
        SCOPED_TRACE(compression);
        header.compression() = compression;
        {
            Imf::OutputFile file(path.c_str(), header);
            file.setFrameBuffer(buffer);
            file.writePixels(50);
        }
        check();
    }
    header.compression() = Imf::ZIP_COMPRESSION;
    header.setTileDescription(Imf::TileDescription(16, 16, Imf::ONE_LEVEL));
    {
        Imf::TiledOutputFile file(path.c_str(), header);
        file.setFrameBuffer(buffer);
        file.writeTiles(0, file.numXTiles() - 1, 0, file.numYTiles() - 1);
    }
    check();
}

TEST(Exr, WritingEndsHalfASecondAfterAnInterruption) {
    const ScratchDirectory scratch;
    std::atomic<int> calls = 0;
    LayeredPicture picture;
    picture.width = picture.display_width = 64;
    picture.height = picture.display_height = 20000;
    picture.channels = {{"Y", false, {}, [&](size_t first, size_t last, float* to) {
                             ++calls;
                             std::this_thread::sleep_for(std::chrono::milliseconds(20));
                             std::fill_n(to, last - first, 1.f);
                         }}};
    std::atomic<bool> stop = true;
    for (const auto compression : {Compression::zip, Compression::rle}) {
        picture.compression = compression;
        calls = 0;
        EXPECT_ERROR(write_exr(scratch.file("a.exr"), picture, 1, stop), ExitCode::interrupted,
                     "interrupted; nothing was written");
        EXPECT_LT(calls, 1250);  // those of the whole picture
        EXPECT_TRUE(scratch.names().empty());
    }
    picture.height = picture.display_height = 64;  // what takes no longer is written
    write_exr(scratch.file("a.exr"), picture, 1, stop);
    EXPECT_TRUE(exr_is_complete(scratch.file("a.exr")));
}

}  // namespace
}  // namespace cistula
