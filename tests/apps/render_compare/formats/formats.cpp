// Pictures that OpenImageIO reads, against each other and against EXRs: values as they stand in the files.
#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <cstring>

#include "apps/render_compare/fixture.h"

namespace cistula {
namespace {

class CompareFormats : public RenderCompare {
  protected:
    /// Writes values of a type, channels interleaved, as the format that the name says.
    template <class Value>
    void put_values(const std::string& name, int width, int height, const std::vector<Value>& values,
                    OIIO::TypeDesc type,
                    const std::vector<std::pair<std::string, std::string>>& attributes = {}) const {
        const int channels = static_cast<int>(values.size()) / (width * height);
        OIIO::ImageSpec spec(width, height, channels, type);
        for (const auto& [key, text] : attributes) spec.attribute(key, text);
        const auto output = OIIO::ImageOutput::create(file(name));
        ASSERT_TRUE(output) << OIIO::geterror();
        ASSERT_TRUE(output->open(file(name), spec)) << output->geterror();
        ASSERT_TRUE(output->write_image(type, values.data())) << output->geterror();
        ASSERT_TRUE(output->close()) << output->geterror();
    }

    nlohmann::json result_of(int code, Arguments arguments) const {
        arguments.insert(arguments.end(), {"--json", "r.json"});
        expect_code(code, arguments);
        return nlohmann::json::parse(bytes_of(file("r.json")));
    }
};

const std::vector<uint8_t> colors{10, 20, 30, 40, 50, 60, 70, 80, 90, 100, 110, 120};  // 2x2 RGB

TEST_F(CompareFormats, PngAgainstPngByCodes) {
    put_values("a.png", 2, 2, colors, OIIO::TypeDesc::UINT8);
    std::vector<uint8_t> other = colors;
    other[10] += 3;
    put_values("b.png", 2, 2, other, OIIO::TypeDesc::UINT8);
    EXPECT_TRUE(contains(expect_code(0, {"a.png", "a.png"}), "equal: every bit of 12 values and of the header\n"));
    const std::string text = expect_code(1, {"a.png", "b.png"});
    EXPECT_TRUE(contains(text, "uint8: compared as integers\n")) << text;
    EXPECT_TRUE(contains(text, "(1, 1): 110 / 113\n")) << text;
    const auto g = result_of(1, {"a.png", "b.png", "--fail", "2"}).at("channels")[1];
    EXPECT_EQ(g.at("name"), "G");
    EXPECT_EQ(g.at("max"), 3);
    EXPECT_NEAR(g.at("psnr").get<double>(), 20 * std::log10(255 / 1.5), 1e-12);
    EXPECT_NEAR(g.at("relative_mse").get<double>(), 9.0 / 255 / 255 / (110.0 * 110 / 255 / 255 + 0.01) / 4, 1e-15);
    expect_code(0, {"a.png", "b.png", "--fail", "3", "--diff", "d.exr"});
    EXPECT_EQ(read_exr(file("d.exr")).channels[1].values, (std::vector<float>{0, 0, 0, 3}));
    expect_code(0, {"a.png", "b.png", "--crop", "0,0,2,1"});
}

TEST_F(CompareFormats, CodesOfOtherTypesAreFractions) {
    put_values("a.png", 2, 2, colors, OIIO::TypeDesc::UINT8);
    std::vector<uint16_t> wide;
    for (const uint8_t code : colors) wide.push_back(static_cast<uint16_t>(code * 257));
    put_values("b.png", 2, 2, wide, OIIO::TypeDesc::UINT16);
    expect_code(0, {"a.png", "b.png", "--fail", "0"});
    const std::string text = expect_code(1, {"a.png", "b.png"});
    EXPECT_TRUE(contains(text, "header: channel R: uint8 / uint16\n")) << text;
    EXPECT_TRUE(contains(
        text, "uint8 / uint16: compared as numbers, uint8 as fractions of 255, uint16 as fractions of 65535\n"))
        << text;
    ++wide[0];
    put_values("b.png", 2, 2, wide, OIIO::TypeDesc::UINT16);
    const auto r = result_of(1, {"a.png", "b.png", "--fail", "0"}).at("channels")[0];
    EXPECT_EQ(r.at("unit"), "fraction");
    EXPECT_NEAR(r.at("max").get<double>(), 1.0 / 65535, 1e-12);
    // 16 bits against 16 bits in another format: integers again.
    put_values("c.tif", 2, 2, wide, OIIO::TypeDesc::UINT16);
    const std::string formats = expect_code(0, {"b.png", "c.tif"});
    EXPECT_TRUE(contains(formats, "not compared: attributes, which png and tiff do not have in common\n")) << formats;
    EXPECT_TRUE(contains(formats, "uint16: compared as integers\n")) << formats;
    EXPECT_TRUE(contains(formats, "\nequal: every bit of 12 values\n")) << formats;
}

TEST_F(CompareFormats, PngAgainstExrIsNotColorConverted) {
    put_values("a.png", 2, 2, colors, OIIO::TypeDesc::UINT8);
    LayeredPicture picture;
    picture.width = picture.height = picture.display_width = picture.display_height = 2;
    for (const size_t c : {2u, 1u, 0u}) {
        Channel channel{std::string(1, "RGB"[c]), false, {}};
        for (size_t i = 0; i < 4; ++i) channel.values.push_back(static_cast<float>(colors[3 * i + c] / 255.0));
        picture.channels.push_back(channel);
    }
    put("b.exr", picture);
    expect_code(1, {"a.png", "b.exr"});
    expect_code(0, {"a.png", "b.exr", "--fail", "1e-7"});
    const std::string text = expect_code(1, {"b.exr", "a.png", "--fail", "0"});
    EXPECT_TRUE(contains(text, "float / uint8: compared as numbers, float as it is, uint8 as fractions of 255\n"));
    picture.channels[0].values[3] = 1;
    put("b.exr", picture);
    EXPECT_NEAR(result_of(1, {"a.png", "b.exr", "--fail", "0.1"}).at("max").get<double>(), 1 - 120 / 255.0, 1e-12);
}

TEST_F(CompareFormats, AlphaDoesNotTouchColors) {
    const std::vector<uint8_t> clear{200, 100, 50, 0, 10, 20, 30, 128};
    std::vector<uint8_t> other = clear;
    other[0] = 201;  // under an alpha of 0
    put_values("a.png", 2, 1, clear, OIIO::TypeDesc::UINT8, {{"oiio:UnassociatedAlpha", "1"}});
    put_values("b.png", 2, 1, other, OIIO::TypeDesc::UINT8, {{"oiio:UnassociatedAlpha", "1"}});
    const auto result = result_of(1, {"a.png", "b.png"});
    ASSERT_EQ(result.at("channels").size(), 4u);
    EXPECT_EQ(result.at("channels")[3].at("name"), "A");
}

TEST_F(CompareFormats, AttributesCountInOneFormat) {
    put_values("a.png", 2, 2, colors, OIIO::TypeDesc::UINT8, {{"Artist", "me"}});
    put_values("b.png", 2, 2, colors, OIIO::TypeDesc::UINT8, {{"Artist", "you"}});
    EXPECT_TRUE(contains(expect_code(1, {"a.png", "b.png"}), "header: Artist: me / you\n"));
    expect_code(0, {"a.png", "b.png", "--fail", "0"});
    put_values("a.tif", 2, 2, colors, OIIO::TypeDesc::UINT8, {{"compression", "zip"}});
    put_values("b.tif", 2, 2, colors, OIIO::TypeDesc::UINT8, {{"compression", "lzw"}});
    EXPECT_TRUE(contains(expect_code(0, {"a.tif", "b.tif"}), "not compared: compression: zip / lzw\n"));
}

/// Two pages, the second with this color.
void write_pages(const std::string& path, uint8_t second) {
    const std::vector<OIIO::ImageSpec> specs(2, OIIO::ImageSpec(2, 1, 3, OIIO::TypeDesc::UINT8));
    const auto output = OIIO::ImageOutput::create(path);
    ASSERT_TRUE(output->open(path, 2, specs.data())) << output->geterror();
    const std::vector<uint8_t> first(6, 7), last(6, second);
    ASSERT_TRUE(output->write_image(OIIO::TypeDesc::UINT8, first.data()));
    ASSERT_TRUE(output->open(path, specs[1], OIIO::ImageOutput::AppendSubimage)) << output->geterror();
    ASSERT_TRUE(output->write_image(OIIO::TypeDesc::UINT8, last.data()));
    ASSERT_TRUE(output->close());
}

TEST_F(CompareFormats, EveryPageCounts) {
    write_pages(file("a.tif"), 9);
    write_pages(file("b.tif"), 12);
    expect_code(0, {"a.tif", "a.tif"});
    const auto result = result_of(1, {"a.tif", "b.tif"});
    ASSERT_EQ(result.at("channels").size(), 6u);
    EXPECT_EQ(result.at("channels")[0].at("max"), 0);
    EXPECT_EQ(result.at("channels")[3].at("name"), "2.R");
    EXPECT_EQ(result.at("channels")[3].at("max"), 3);
    put_values("c.tif", 2, 1, std::vector<uint8_t>(6, 7), OIIO::TypeDesc::UINT8);
    EXPECT_TRUE(contains(expect_code(1, {"a.tif", "c.tif"}), "part 2: only in the first\n"));
}

TEST_F(CompareFormats, AMaskMayBeOfAnyFormat) {
    put_values("a.png", 2, 2, colors, OIIO::TypeDesc::UINT8);
    std::vector<uint8_t> other = colors;
    other[4] = 0;
    put_values("b.png", 2, 2, other, OIIO::TypeDesc::UINT8);
    put_values("mask.png", 2, 2, std::vector<uint8_t>{255, 0, 1, 255}, OIIO::TypeDesc::UINT8);
    EXPECT_TRUE(contains(expect_code(0, {"a.png", "b.png", "--mask", "mask.png"}), "every bit of 9 values"));
}

TEST_F(CompareFormats, BadFilesAreOneLine) {
    put_values("a.png", 2, 2, colors, OIIO::TypeDesc::UINT8);
    put_bytes(file("b.png"), "");
    expect_refused({"a.png", "b.png"}, ExitCode::file, "b.png: cannot read: it is empty; give a picture");
    put_bytes(file("b.txt"), "no picture");
    expect_refused({"b.txt", "a.png"}, ExitCode::file, "b.txt: cannot read: ");
    expect_refused({"a.png", "none.png"}, ExitCode::file, "none.png: cannot read: No such file or directory");
    // An EXR by any name is one.
    put("c.exr", picture_of({first_r}));
    std::filesystem::rename(file("c.exr"), file("c.png"));
    expect_code(0, {"c.png", "c.png"});
}

TEST_F(CompareFormats, SsimOfCodes) {
    std::vector<uint8_t> first(12 * 12), second;
    for (size_t i = 0; i < first.size(); ++i) first[i] = static_cast<uint8_t>(i * 53);
    second = first;
    second[70] = static_cast<uint8_t>(second[70] + 90);
    put_values("a.png", 12, 12, first, OIIO::TypeDesc::UINT8);
    put_values("b.png", 12, 12, second, OIIO::TypeDesc::UINT8);
    const double ssim = result_of(1, {"a.png", "b.png", "--metrics", "ssim"}).at("channels")[0].at("ssim");
    EXPECT_LT(ssim, 1);
    EXPECT_GT(ssim, 0.8);
    EXPECT_EQ(result_of(0, {"a.png", "a.png", "--metrics", "ssim"}).at("channels")[0].at("ssim"), 1);
}

}  // namespace
}  // namespace cistula
