// Files as they stand, through OpenImageIO: every type keeps its values, files that are cut off are errors.
#include "image/reader/picture_reader.h"

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <limits>

#include "testing/support/expect_error.h"
#include "testing/support/scratch_directory.h"

namespace cistula {
namespace {

template <class Value>
void write_values(const std::string& path, int width, int height, const std::vector<Value>& values,
                  OIIO::TypeDesc type) {
    const int channels = static_cast<int>(values.size()) / (width * height);
    const auto output = OIIO::ImageOutput::create(path);
    ASSERT_TRUE(output) << OIIO::geterror();
    ASSERT_TRUE(output->open(path, OIIO::ImageSpec(width, height, channels, type))) << output->geterror();
    ASSERT_TRUE(output->write_image(type, values.data())) << output->geterror();
    ASSERT_TRUE(output->close()) << output->geterror();
}

TEST(StoredReader, EveryTypeKeepsItsValues) {
    const ScratchDirectory scratch;
    StoredReader reader;
    const auto check = [&](auto number, OIIO::TypeDesc oiio_type, StoredType type) {
        using Value = decltype(number);
        using Limits = std::numeric_limits<Value>;
        const std::vector<Value> values = {
            Limits::lowest(), Limits::max(), 0, 1, 2, static_cast<Value>(Limits::max() / 2)};
        write_values(scratch.file("a.tif"), 3, 2, values, oiio_type);
        const StoredFile file = reader.read(scratch.file("a.tif"));
        EXPECT_EQ(file.format, "tiff");
        ASSERT_EQ(file.pictures.size(), 1u);
        EXPECT_EQ(file.pictures[0].data, (PixelRect{0, 0, 3, 2}));
        EXPECT_EQ(file.pictures[0].display, (PixelRect{0, 0, 3, 2}));
        ASSERT_EQ(file.pictures[0].channels.size(), 1u);
        const StoredChannel& channel = file.pictures[0].channels[0];
        EXPECT_EQ(channel.type, type);
        std::visit(
            [&](const auto& read) {
                EXPECT_EQ(std::vector<Value>(read.begin(), read.end()), values) << type_name(type);
            },
            channel.values);
    };
    check(uint8_t{}, OIIO::TypeDesc::UINT8, StoredType::uint8);
    check(int8_t{}, OIIO::TypeDesc::INT8, StoredType::int8);
    check(uint16_t{}, OIIO::TypeDesc::UINT16, StoredType::uint16);
    check(int16_t{}, OIIO::TypeDesc::INT16, StoredType::int16);
    check(uint32_t{}, OIIO::TypeDesc::UINT32, StoredType::uint32);
    check(int32_t{}, OIIO::TypeDesc::INT32, StoredType::int32);
    check(float{}, OIIO::TypeDesc::FLOAT, StoredType::float_);
    check(double{}, OIIO::TypeDesc::DOUBLE, StoredType::double_);
}

TEST(StoredReader, ReadsEachLevel) {
    const ScratchDirectory scratch;
    const std::string path = scratch.file("a.tif");
    const auto output = OIIO::ImageOutput::create(path);
    OIIO::ImageSpec spec(32, 32, 1, OIIO::TypeDesc::UINT8);
    spec.tile_width = spec.tile_height = 16;
    spec.attribute("textureformat", "Plain Texture");  // whose pages are levels
    ASSERT_TRUE(output->open(path, spec)) << output->geterror();
    const std::vector<uint8_t> whole(32 * 32, 7), smaller(16 * 16, 9);
    ASSERT_TRUE(output->write_image(OIIO::TypeDesc::UINT8, whole.data()));
    spec.width = spec.height = spec.full_width = spec.full_height = 16;
    ASSERT_TRUE(output->open(path, spec, OIIO::ImageOutput::AppendSubimage)) << output->geterror();
    ASSERT_TRUE(output->write_image(OIIO::TypeDesc::UINT8, smaller.data()));
    ASSERT_TRUE(output->close());
    const StoredFile file = StoredReader().read(path);
    ASSERT_EQ(file.pictures.size(), 2u);
    const std::vector<uint32_t> expected[] = {{whole.begin(), whole.end()}, {smaller.begin(), smaller.end()}};
    for (const size_t i : {0u, 1u}) {
        EXPECT_EQ(file.pictures[i].x_level, static_cast<int>(i));
        EXPECT_EQ(std::get<std::vector<uint32_t>>(file.pictures[i].channels[0].values), expected[i]);
    }
}

TEST(StoredReader, FilesThatAreCutOffAreErrors) {
    const ScratchDirectory scratch;
    StoredReader reader;
    const std::vector<uint8_t> colors{10, 20, 30, 40, 50, 60, 70, 80, 90, 100, 110, 120};
    write_values(scratch.file("a.png"), 2, 2, colors, OIIO::TypeDesc::UINT8);
    const std::string bytes = bytes_of(scratch.file("a.png"));
    reader.read(scratch.file("a.png"));
    for (size_t size = 0; size + 12 < bytes.size(); size += 9) {  // 12: the empty chunk at the end
        put_bytes(scratch.file("b.png"), bytes.substr(0, size));
        try {
            reader.read(scratch.file("b.png"));
            ADD_FAILURE() << "no error at " << size;
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::file) << size;
        }
    }
}

TEST(StoredReader, AllFilesShareTheLimit) {
    const ScratchDirectory scratch;
    write_values(scratch.file("a.png"), 10, 10, std::vector<uint8_t>(300), OIIO::TypeDesc::UINT8);
    TextureLimits limits;
    limits.bytes = 2000;
    StoredReader reader(limits);
    reader.read(scratch.file("a.png"));  // 4 bytes a value
    EXPECT_ERROR(reader.read(scratch.file("a.png")), ExitCode::file,
                 scratch.file("a.png") +
                     ": cannot read: its size is 10x10, and its values take 1.2e-06 GB of memory; pictures may take "
                     "2e-06 GB, and others take 1.2e-06 GB; give a smaller one");
}

}  // namespace
}  // namespace cistula
