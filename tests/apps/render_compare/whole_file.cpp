// All of an EXR is compared, whatever program wrote it: parts, levels, whole numbers, subsampled channels, attributes
// of any type; deep data is refused.
#include <OpenEXR/ImfDeepFrameBuffer.h>
#include <OpenEXR/ImfDeepScanLineOutputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfTiledOutputFile.h>
#include <OpenEXR/ImfTimeCodeAttribute.h>
#include <OpenEXR/ImfVecAttribute.h>
#include <gtest/gtest.h>

#include <array>
#include <functional>

#include "apps/render_compare/fixture.h"
#include "testing/support/pictures/exr_parts.h"

namespace cistula {
namespace {

using test::Part;

class CompareWholeFile : public RenderCompare {
  protected:
    void put_parts(const std::string& name, const std::vector<Part>& parts) const {
        test::write_parts(file(name), parts);
    }

    /// Writes a scan line file of one value everywhere, after `change` to its header.
    void put_plain(const std::string& name, const std::function<void(Imf::Header&)>& change) const {
        Imf::Header header(4, 2);
        header.channels().insert("Z", Imf::Channel(Imf::FLOAT));
        change(header);
        const std::vector<float> values(8, 0.5f);
        Imf::FrameBuffer buffer;
        buffer.insert("Z", Imf::Slice::Make(Imf::FLOAT, values.data(), header.dataWindow()));
        Imf::OutputFile output(file(name).c_str(), header);
        output.setFrameBuffer(buffer);
        output.writePixels(2);
    }
};

const std::vector<float> six{1, 2, 3, 4, 5, 6};

std::vector<Part> two_parts() {
    return {{"beauty", 3, 2, {{"R", six, {}}}}, {"depth", 3, 2, {{"Z", six, {}}, {"id", {}, {1, 2, 3, 4, 5, 6}}}}};
}

TEST_F(CompareWholeFile, EveryPartCounts) {
    std::vector<Part> other = two_parts();
    put_parts("a.exr", other);
    put_parts("b.exr", other);
    EXPECT_TRUE(contains(expect_code(0, {"a.exr", "b.exr"}), "equal: every bit of 18 values and of the header"));
    other[1].channels[0].values[4] = 5.5f;
    put_parts("b.exr", other);
    const std::string text = expect_code(1, {"a.exr", "b.exr", "--json", "r.json", "--diff", "d.exr"});
    EXPECT_TRUE(contains(text, "(4, -1): 5 / 5.5\n")) << text;
    EXPECT_TRUE(contains(text, "\ndiffer: 1 of 18 values differ\n")) << text;
    const auto result = nlohmann::json::parse(bytes_of(file("r.json")));
    EXPECT_EQ(result.at("pixels"), 6);  // the parts have one window
    EXPECT_EQ(result.at("channels")[0].at("name"), "beauty.R");
    EXPECT_EQ(result.at("channels")[1].at("name"), "depth.Z");
    EXPECT_EQ(result.at("channels")[1].at("max"), 0.5);
    const std::vector<PicturePart> differences = read_exr_parts(file("d.exr"));
    ASSERT_EQ(differences.size(), 2u);
    EXPECT_EQ(differences[1].name, "depth");
    EXPECT_EQ(differences[1].picture.channels[0].values, (std::vector<float>{0, 0, 0, 0, 0.5f, 0}));
    EXPECT_EQ(differences[1].picture.x, 3);
    EXPECT_EQ(differences[1].picture.y, -2);
}

TEST_F(CompareWholeFile, PartsAreMatchedByName) {
    std::vector<Part> parts = two_parts();
    put_parts("a.exr", parts);
    std::swap(parts[0], parts[1]);
    put_parts("b.exr", parts);
    const std::string text = expect_code(0, {"a.exr", "b.exr"});
    EXPECT_TRUE(contains(text, "not compared: the order of parts\n")) << text;
    parts[1].name = "colors";
    put_parts("b.exr", parts);
    for (const Arguments& more : {Arguments{}, Arguments{"--fail", "100", "--layers", "*"}}) {
        Arguments arguments{"a.exr", "b.exr"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const std::string unmatched = expect_code(1, arguments);
        EXPECT_TRUE(contains(unmatched, "part beauty: only in the first\n")) << unmatched;
        EXPECT_TRUE(contains(unmatched, "part colors: only in the second\n")) << unmatched;
    }
    put_parts("c.exr", {parts[0]});
    const std::string fewer = expect_code(1, {"a.exr", "c.exr"});
    EXPECT_TRUE(contains(fewer, "part 2: only in the first\n")) << fewer;  // c.exr's only part has no name
}

/// A pixel fails once, whether its channels lie in one part or in several.
TEST_F(CompareWholeFile, PixelsOfPartsWithOneWindowAreCountedOnce) {
    std::vector<Part> other = two_parts();
    put_parts("a.exr", other);
    for (const size_t part : {0u, 1u}) other[part].channels[0].values[5] = 9;
    put_parts("b.exr", other);
    const std::string text = expect_code(0, {"a.exr", "b.exr", "--fail", "1", "--failpercent", "17"});
    EXPECT_TRUE(contains(text, "1 of 6 pixels (16.67 %) over --fail 1")) << text;
}

TEST_F(CompareWholeFile, WholeNumbersAreComparedExactly) {
    std::vector<Part> parts = two_parts();
    parts[1].channels[1].numbers[2] = 1u << 24;
    put_parts("a.exr", parts);
    ++parts[1].channels[1].numbers[2];
    parts[1].channels[1].numbers[5] = 0xffffffff;
    put_parts("b.exr", parts);
    const std::string text = expect_code(1, {"a.exr", "b.exr", "--json", "r.json", "--layers", "id"});
    EXPECT_TRUE(contains(text, "uint: compared as integers\n")) << text;
    EXPECT_TRUE(contains(text, "(5, -1): 6 / 4294967295\n")) << text;
    EXPECT_TRUE(contains(text, "differ: 2 of 6 values differ\n")) << text;
    const auto id = nlohmann::json::parse(bytes_of(file("r.json"))).at("channels")[0];
    EXPECT_EQ(id.at("max"), 4294967289.0);
    EXPECT_EQ(id.at("types"), nlohmann::json({"uint", "uint"}));
    EXPECT_EQ(id.at("unit"), "integer");
    expect_code(1, {"a.exr", "b.exr", "--layers", "id", "--hardfail", "4294967288"});
    expect_code(0, {"a.exr", "b.exr", "--layers", "id", "--hardfail", "4294967289"});
}

TEST_F(CompareWholeFile, DeepDataIsRefusedByName) {
    Imf::Header header(2, 1);
    header.channels().insert("Z", Imf::Channel(Imf::FLOAT));
    header.setType(Imf::DEEPSCANLINE);
    header.compression() = Imf::ZIPS_COMPRESSION;
    std::array<unsigned int, 2> counts{1, 1};
    std::array<float, 2> samples{1, 2};
    std::array<float*, 2> pointers{&samples[0], &samples[1]};
    {
        Imf::DeepScanLineOutputFile output(file("deep.exr").c_str(), header);
        Imf::DeepFrameBuffer buffer;
        buffer.insertSampleCountSlice(
            Imf::Slice(Imf::UINT, reinterpret_cast<char*>(counts.data()), sizeof(unsigned int), 2 * sizeof(unsigned)));
        buffer.insert("Z", Imf::DeepSlice(Imf::FLOAT, reinterpret_cast<char*>(pointers.data()), sizeof(float*),
                                          2 * sizeof(float*), sizeof(float)));
        output.setFrameBuffer(buffer);
        output.writePixels(1);
    }
    put("a.exr", picture_of({first_r}));
    expect_refused({"a.exr", "deep.exr"}, ExitCode::file,
                   "deep.exr: cannot read: it is deep, with several samples in a pixel; flatten it first");
}

TEST_F(CompareWholeFile, AttributesOfAnyTypeCount) {
    const auto differs = [&](const std::function<void(Imf::Header&)>& first,
                             const std::function<void(Imf::Header&)>& second, const std::string& line) {
        put_plain("a.exr", first);
        put_plain("b.exr", second);
        const std::string text = expect_code(1, {"a.exr", "b.exr"});
        EXPECT_TRUE(contains(text, "header: " + line + "\n")) << text;
        expect_code(0, {"a.exr", "b.exr", "--fail", "0"});
        put_plain("b.exr", first);
        expect_code(0, {"a.exr", "b.exr"});
    };
    const auto nothing = [](Imf::Header&) {};
    differs(
        [](Imf::Header& header) {
            header.insert("v", Imf::V2fAttribute({1, 2}));
        },
        [](Imf::Header& header) {
            header.insert("v", Imf::V2fAttribute({1, 2.5f}));
        },
        "v: 1 2 / 1 2.5");
    differs([](Imf::Header& header) { header.insert("time", Imf::TimeCodeAttribute(Imf::TimeCode(1, 2, 3, 4))); },
            nothing, "time: 8 bytes: 04 03 02 01 00 00 00 00 / (none)");
    differs([](Imf::Header& header) { header.pixelAspectRatio() = 2; }, nothing, "pixelAspectRatio: 2 / 1");
    differs(
        [](Imf::Header& header) {
            header.screenWindowCenter() = {0, 3};
        },
        nothing, "screenWindowCenter: 0 3 / 0 0");
    // What is long is shown where it differs.
    const auto long_text = [](char last) {
        return [last](Imf::Header& header) {
            header.insert("text", Imf::StringAttribute(std::string(5000, 'x') + last + std::string(5000, 'y')));
        };
    };
    const auto shown = [](char last) { return "..." + std::string(20, 'x') + last + std::string(99, 'y') + "..."; };
    differs(long_text('1'), long_text('2'), "text: " + shown('1') + " / " + shown('2'));
}

TEST_F(CompareWholeFile, AttributesOfUnknownTypesCount) {
    const auto put_own = [&](const std::string& name, const std::string& value) {
        put_plain(name, [&](Imf::Header& header) { header.insert("own", Imf::StringAttribute(value)); });
        std::string bytes = bytes_of(file(name));
        bytes.replace(bytes.find("own") + 4, 6, "scream");
        put_bytes(file(name), bytes);
    };
    put_own("a.exr", "abcd");
    put_own("b.exr", "abce");
    expect_code(0, {"a.exr", "a.exr"});
    const std::string text = expect_code(1, {"a.exr", "b.exr"});
    EXPECT_TRUE(contains(text, "header: own: 4 bytes: 61 62 63 64 / 4 bytes: 61 62 63 65\n")) << text;
    put_plain("c.exr", [&](Imf::Header& header) { header.insert("own", Imf::StringAttribute("abcd")); });
    const std::string types = expect_code(1, {"a.exr", "c.exr"});
    EXPECT_TRUE(contains(types, "own: 4 bytes: 61 62 63 64 (scream) / abcd (string)\n")) << types;
}

TEST_F(CompareWholeFile, HowPixelsArePackedDoesNotCountAndIsSaid) {
    std::vector<Part> parts{{"", 3, 2, {{"Z", six, {}}}}};
    put_parts("a.exr", parts);
    parts[0].tiled = true;
    put_parts("b.exr", parts);
    const std::string text = expect_code(0, {"a.exr", "b.exr"});
    EXPECT_TRUE(contains(text, "not compared: tiles: none / 2x2\n")) << text;
    put_plain("c.exr", [](Imf::Header& header) { header.compression() = Imf::PIZ_COMPRESSION; });
    put_plain("d.exr", [](Imf::Header& header) { header.lineOrder() = Imf::DECREASING_Y; });
    const std::string packed = expect_code(0, {"c.exr", "d.exr"});
    EXPECT_TRUE(contains(packed, "not compared: compression: piz / zip\n")) << packed;
    EXPECT_TRUE(contains(packed, "not compared: order of lines: downward / upward\n")) << packed;
}

/// 4x4 pixels of 1, with levels of 2x2 and 1x1.
void write_levels(const std::string& path, Imf::LevelMode mode, float last) {
    Imf::Header header(4, 4);
    header.channels().insert("Z", Imf::Channel(Imf::FLOAT));
    header.setTileDescription(Imf::TileDescription(2, 2, mode));
    Imf::TiledOutputFile output(path.c_str(), header);
    for (int y = 0; y < output.numYLevels(); ++y)
        for (int x = 0; x < output.numXLevels(); ++x) {
            if (!output.isValidLevel(x, y)) continue;
            std::vector<float> values(16, x == output.numXLevels() - 1 ? last : 1.0f);
            Imf::FrameBuffer buffer;
            buffer.insert("Z", Imf::Slice::Make(Imf::FLOAT, values.data(), output.dataWindowForLevel(x, y)));
            output.setFrameBuffer(buffer);
            output.writeTiles(0, output.numXTiles(x) - 1, 0, output.numYTiles(y) - 1, x, y);
        }
}

TEST_F(CompareWholeFile, LevelsCount) {
    write_levels(file("a.exr"), Imf::MIPMAP_LEVELS, 1);
    write_levels(file("b.exr"), Imf::MIPMAP_LEVELS, 3);
    EXPECT_TRUE(contains(expect_code(0, {"a.exr", "a.exr"}), "equal: every bit of 21 floats"));
    const std::string text = expect_code(1, {"a.exr", "b.exr"});
    EXPECT_TRUE(contains(text, "\nZ (level 2,2) ")) << text;
    EXPECT_TRUE(contains(text, "differ: 1 of 21 floats differ\n")) << text;
    write_levels(file("rip.exr"), Imf::RIPMAP_LEVELS, 1);
    const std::string rip = expect_code(1, {"a.exr", "rip.exr"});
    EXPECT_TRUE(contains(rip, "level 1,0: only in the second\n")) << rip;
    const std::string crop = expect_code(0, {"a.exr", "b.exr", "--crop", "0,0,2,2"});
    EXPECT_TRUE(contains(crop, "not compared: level 2,2: a level of lower resolution, since pixels are chosen\n"));
}

TEST_F(CompareWholeFile, SubsampledChannelsAreComparedValueByValue) {
    const auto write = [&](const std::string& name, int step, std::vector<float> values) {
        Imf::Header header(4, 2);
        header.channels().insert("RY", Imf::Channel(Imf::FLOAT, step, 2));
        Imf::FrameBuffer buffer;
        const auto width = static_cast<size_t>(4 / step);
        buffer.insert("RY", Imf::Slice::Make(Imf::FLOAT, values.data(), header.dataWindow(), sizeof(float),
                                             width * sizeof(float), step, 2));
        Imf::OutputFile output(file(name).c_str(), header);
        output.setFrameBuffer(buffer);
        output.writePixels(2);
    };
    write("a.exr", 2, {1, 2});
    write("b.exr", 2, {1, 4});
    const std::string text = expect_code(1, {"a.exr", "b.exr", "--json", "r.json"});
    EXPECT_TRUE(contains(text, "(2, 0): 2 / 4\n")) << text;
    EXPECT_TRUE(contains(text, "differ: 1 of 2 floats differ\n")) << text;
    EXPECT_EQ(nlohmann::json::parse(bytes_of(file("r.json"))).at("channels")[0].at("mean"), 1);
    EXPECT_TRUE(contains(expect_code(1, {"a.exr", "b.exr", "--fail", "1"}), "4 of 8 pixels (50 %)"));
    write("c.exr", 4, {1});
    const std::string types = expect_code(1, {"a.exr", "c.exr"});
    EXPECT_TRUE(contains(types, "header: channel RY: float, a value for 2x2 pixels / float, a value for 4x2 pixels\n"))
        << types;
}

TEST_F(CompareWholeFile, HalvesAndFloatsAreComparedAsNumbers) {
    put("a.exr", picture_of({{"R", true, std::vector<float>(8, 0.5f)}}));
    put("b.exr", picture_of({{"R", false, std::vector<float>(8, 0.5f)}}));
    EXPECT_TRUE(contains(expect_code(1, {"a.exr", "b.exr"}), "header: channel R: half / float\n"));
    expect_code(0, {"a.exr", "b.exr", "--fail", "0"});
}

}  // namespace
}  // namespace cistula
