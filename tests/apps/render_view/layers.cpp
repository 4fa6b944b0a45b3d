// Channels in groups: which layers a file has, and how each is shown.
#include "apps/render_view/layers.h"

#include <gtest/gtest.h>

#include <set>

#include "apps/render_view/id_colors.h"
#include "apps/render_view/layer_choice.h"
#include "image/color/srgb_codes.h"
#include "testing/support/expect_error.h"

namespace cistula {
namespace {

using Type = ExrChannel::Type;

/// A part of float channels, but for those whose names begin with #, which are whole numbers.
ExrPart part_of(const std::vector<std::string>& channels, const std::string& name = "") {
    ExrPart part;
    part.name = name;
    part.width = part.height = 1;
    for (const std::string& channel : channels)
        part.channels.push_back(channel[0] == '#' ? ExrChannel{channel.substr(1), Type::uint, 1, 1, {}, {}}
                                                  : ExrChannel{channel, Type::float_, 1, 1, {}, {}});
    return part;
}

/// Each layer as "NAME KIND CHANNELS".
std::vector<std::string> layers_as_text(const std::vector<ExrPart>& parts) {
    std::vector<std::string> lines;
    for (const Layer& layer : layers_of(parts)) {
        std::string line = layer.name + " " + std::string(kind_name(layer.kind));
        for (const size_t channel : layer.channels) line += " " + parts[layer.part].channels[channel].name;
        lines.push_back(line);
    }
    return lines;
}

using Lines = std::vector<std::string>;

TEST(Layers, ChannelsBelongToWhatIsBeforeTheirLastDot) {
    EXPECT_EQ(
        layers_as_text({part_of({"A",       "B",       "G",       "N.X",   "N.Y",         "N.Z",   "P.X",  "P.Y",
                                 "P.Z",     "R",       "Z",       "a.b.B", "a.b.G",       "a.b.R", "cost", "depth_ray",
                                 "error.B", "error.G", "error.R", "id",    "material_id", "uv.U",  "uv.V"})}),
        (Lines{"RGB color R G B", "A scalar A", "Z depth Z", "cost scalar cost", "depth_ray depth depth_ray",
               "id ids id", "material_id ids material_id", "N normals N.X N.Y N.Z", "P vectors P.X P.Y P.Z",
               "a.b color a.b.R a.b.G a.b.B", "error color error.R error.G error.B",
               "uv texture coordinates uv.U uv.V"}));
}

TEST(Layers, NamesOfOtherProgramsAreKnown) {
    EXPECT_EQ(layers_as_text(
                  {part_of({"CryptoObject00.a", "CryptoObject00.b", "CryptoObject00.g", "CryptoObject00.r",
                            "View.Combined.A", "View.Combined.B", "View.Combined.G", "View.Combined.R", "View.Depth.Z",
                            "View.Normal.X", "View.Normal.Y", "View.Normal.Z", "View.Vec.X", "View.Vec.Y", "left.Y",
                            "objectId", "uCryptoAsset01.B", "uCryptoAsset01.G", "uCryptoAsset01.R"})}),
              (Lines{"objectId ids objectId",
                     "CryptoObject00 mattes CryptoObject00.r CryptoObject00.g CryptoObject00.b CryptoObject00.a",
                     "View.Combined color View.Combined.R View.Combined.G View.Combined.B",
                     "View.Combined.A scalar View.Combined.A", "View.Depth depth View.Depth.Z",
                     "View.Normal normals View.Normal.X View.Normal.Y View.Normal.Z",
                     "View.Vec vectors View.Vec.X View.Vec.Y", "left luminance left.Y",
                     "uCryptoAsset01 color uCryptoAsset01.R uCryptoAsset01.G uCryptoAsset01.B"}));
}

TEST(Layers, WholeNumbersAreIdsAndWhatIsNoSetStandsAlone) {
    EXPECT_EQ(layers_as_text({part_of({"#count", "R", "G", "s.a", "s.b", "v.X", "width"})}),
              (Lines{"count ids count", "R scalar R", "G scalar G", "width scalar width", "s.a scalar s.a",
                     "s.b scalar s.b", "v scalar v.X"}));
    EXPECT_EQ(layers_as_text({part_of({".R", "x."})}), (Lines{".R scalar .R", "x scalar x."}));
    EXPECT_TRUE(layers_of({}).empty());
    EXPECT_TRUE(layers_of({part_of({})}).empty());
}

TEST(Layers, PartsStandBeforeTheirLayers) {
    const std::vector<ExrPart> parts{part_of({"B", "G", "R"}, "left"), part_of({"Z", "left.Z"}, "depth"),
                                     part_of({"gloss.B", "gloss.G", "gloss.R", "gloss.x.Y"}, "gloss")};
    EXPECT_EQ(layers_as_text(parts), (Lines{"left.RGB color R G B", "depth.Z depth Z", "depth.left depth left.Z",
                                            "gloss color gloss.R gloss.G gloss.B", "gloss.x luminance gloss.x.Y"}));
    EXPECT_EQ(layers_of(parts)[1].part, 1u);
    // Whatever names there are, each is of one layer.
    EXPECT_EQ(layers_as_text({part_of({"b.c.Y"}, "a"), part_of({"c.Y"}, "a.b"), part_of({"depth", "depth.Z"}, "d")}),
              (Lines{"a.b.c luminance b.c.Y", "a.b.c (2) luminance c.Y", "d.depth depth depth",
                     "d.depth (2) depth depth.Z"}));
}

TEST(Layers, TheFirstOfColorsIsShownElseTheFirst) {
    const auto shown = [](const std::vector<std::string>& channels) {
        const std::vector<ExrPart> parts{part_of(channels)};
        return default_layer(layers_of(parts)).name;
    };
    EXPECT_EQ(shown({"A", "B", "G", "R", "a.B", "a.G", "a.R"}), "RGB");
    EXPECT_EQ(shown({"A", "Y", "a.B", "a.G", "a.R"}), "a");
    EXPECT_EQ(shown({"A", "Y"}), "Y");
    EXPECT_EQ(shown({"A", "Z"}), "A");
}

TEST(Layers, AreChosenByNameEachOnce) {
    const std::vector<ExrPart> parts{part_of({"A", "Z", "a,b", "id"})};
    const std::vector<Layer> layers = layers_of(parts);
    const auto chosen = [&](const std::vector<std::string>& texts) {
        std::string names;
        for (const Layer& layer : chosen_layers(parts, layers, texts, "f.exr")) names += layer.name + " ";
        return names;
    };
    EXPECT_EQ(chosen({}), "A ");
    EXPECT_EQ(chosen({"Z,A", "id", "A"}), "Z A id ");
    EXPECT_EQ(chosen({"a,b"}), "a,b ");
    EXPECT_ERROR(chosen({"A,z"}), ExitCode::usage,
                 "--layer A,z: f.exr has no layer 'z'; the layers are: Z, A, a,b, id");
    EXPECT_ERROR(chosen({"A,"}), ExitCode::usage, "--layer A,: f.exr has no layer ''; the layers are: A, Z, a,b, id");
}

TEST(Layers, OfAChannelOrOfACryptomatteAreChosenByItsName) {
    const std::vector<ExrPart> parts{
        part_of({"d.B", "d.G", "d.R", "m00.a", "m00.b", "m00.g", "m00.r", "cryptom00.a", "cryptom00.b", "cryptom00.g",
                 "cryptom00.r", "cryptom01.a", "cryptom01.b", "cryptom01.g", "cryptom01.r"})};
    const std::vector<Layer> layers = layers_of(parts);
    const std::vector<Layer> one = chosen_layers(parts, layers, {"d.G"}, "f.exr");
    ASSERT_EQ(one.size(), 1u);
    EXPECT_EQ(one[0].name, "d.G");
    EXPECT_EQ(one[0].kind, LayerKind::scalar);
    EXPECT_EQ(parts[0].channels[one[0].channels.at(0)].name, "d.G");
    const std::vector<Layer> mattes = chosen_layers(parts, layers, {"cryptom", "cryptom01"}, "f.exr");
    ASSERT_EQ(mattes.size(), 2u);
    EXPECT_EQ(mattes[0].name, "cryptom00");
    EXPECT_EQ(mattes[1].name, "cryptom01");
}

TEST(IdColors, TellIdsApart) {
    EXPECT_EQ(id_color(0), glm::vec3(0));
    const auto code = [](uint32_t id, int c) { return static_cast<int>(srgb8_from_linear(id_color(id)[c])); };
    const auto far = [&](uint32_t a, uint32_t b) {
        int most = 0;
        for (int c = 0; c < 3; ++c) most = std::max(most, std::abs(code(a, c) - code(b, c)));
        return most;
    };
    for (uint32_t a = 0; a < 40; ++a)
        for (uint32_t b = 0; b < a; ++b) EXPECT_GE(far(a, b), 16) << a << " and " << b;
    for (uint32_t id = 1; id < 5000; ++id) EXPECT_GE(far(id, 0), 100) << id;  // none looks like nothing
    std::set<std::string> colors;
    for (uint32_t id = 1; id <= 200; ++id)
        colors.insert(std::to_string(code(id, 0)) + " " + std::to_string(code(id, 1)) + " " +
                      std::to_string(code(id, 2)));
    EXPECT_EQ(colors.size(), 200u);
}

TEST(IdColors, FloatsAreTheirWholeNumbersOrTheirBits) {
    EXPECT_EQ(id_of(0), 0u);
    EXPECT_EQ(id_of(7), 7u);
    EXPECT_EQ(id_of(4294967040.0f), 4294967040u);
    EXPECT_EQ(id_of(0.5f), 0x3f000000u);
    EXPECT_EQ(id_of(-1), 0xbf800000u);
    EXPECT_EQ(id_of(1e30f), 0x7149f2cau);
}

}  // namespace
}  // namespace cistula
