// `render --tile` and `render-merge` from outside: the whole from its tiles is the whole of one job, byte for byte.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "image/exr/exr.h"
#include "render/picture_size.h"
#include "sequence/merge.h"
#include "testing/support/render_program.h"

namespace cistula {
namespace {

class RenderMerge : public RenderProgram {
  protected:
    ProgramResult merge(const Arguments& arguments) const {
        return RunningProgram(CISTULA_BIN_DIR "/render-merge", arguments, file("")).wait();
    }
    void expect_merged(const Arguments& arguments) const {
        const ProgramResult result = merge(arguments);
        EXPECT_EQ(result.code, 0) << result.error;
    }
    void expect_no_merge(const Arguments& arguments, ExitCode code, const std::string& part) const {
        const ProgramResult result = merge(arguments);
        EXPECT_EQ(result.code, static_cast<int>(code)) << result.error;
        EXPECT_EQ(result.error.rfind("render-merge: ", 0), 0u) << result.error;
        EXPECT_EQ(std::count(result.error.begin(), result.error.end(), '\n'), 1) << result.error;
        EXPECT_NE(result.error.find(part), std::string::npos) << result.error;
    }
    /// Renders tiles to `output`, of a grid with so many.
    void render_tiles(const std::string& output, const std::string& grid, int count, Arguments more) const {
        more.insert(more.begin(), {"s.json", "-q", "-o", output, "--tiles", grid, "--tile", ""});
        for (int i = 0; i < count; ++i) {
            more[7] = std::to_string(i);
            expect_done(more);
        }
    }
    /// Renders the whole and tiles with these options and compares.
    void expect_equal_whole(const Arguments& options) const {
        Arguments whole = options;
        whole.insert(whole.begin(), {"s.json", "-q", "-o", "whole.exr"});
        expect_done(whole);
        render_tiles("t.exr", "3x2", 6, options);
        expect_merged({"--tiles", "3x2", "-o", "t.exr", "-q"});
        EXPECT_EQ(bytes_of(file("whole.exr")), bytes_of(file("t.exr"))) << fmt::format("{}", fmt::join(options, " "));
    }
};

TEST(Tiles, CoverEveryPixelOnce) {
    for (const PixelRect whole : {PixelRect{0, 0, 40, 24}, PixelRect{7, 3, 11, 5}, PixelRect{0, 0, 65536, 3}})
        for (const TileGrid grid : {TileGrid{1, 1}, TileGrid{3, 2}, TileGrid{11, 3}}) {
            std::vector<PixelRect> tiles;
            int64_t pixels = 0;
            for (int i = 0; i < grid.count(); ++i) {
                tiles.push_back(tile_rect(whole, grid, i));
                pixels += int64_t{tiles.back().width} * tiles.back().height;
                EXPECT_EQ(intersection(tiles.back(), whole), tiles.back());
            }
            EXPECT_EQ(pixels, int64_t{whole.width} * whole.height);
            EXPECT_TRUE(uncovered(whole, tiles).empty());
        }
    EXPECT_EQ(tile_name({4, 3}, 7), "tile07");
    EXPECT_EQ(tile_name({3, 3}, 7), "tile7");
    EXPECT_THROW(tile_rect({0, 0, 2, 9}, {3, 1}, 0), Error);
    for (const char* wrong : {"", "4", "0x2", "2x0", "-1x2", "4x3x2", "200x200", "4 x3", "axb"})
        EXPECT_THROW(parse_tiles(wrong), Error) << wrong;
}

TEST(Uncovered, FindsWhatIsLeft) {
    const PixelRect window{10, 20, 8, 6};
    EXPECT_EQ(uncovered(window, {}), std::vector<PixelRect>{window});
    EXPECT_EQ(uncovered(window, {{0, 0, 12, 100}}), (std::vector<PixelRect>{{12, 20, 6, 6}}));
    const std::vector<PixelRect> ring = uncovered(window, {{12, 22, 3, 2}});
    int pixels = 0;
    for (const PixelRect& rect : ring) pixels += rect.width * rect.height;
    EXPECT_EQ(pixels, 8 * 6 - 3 * 2);
    EXPECT_TRUE(intersection({0, 0, 4, 4}, {4, 0, 4, 4}).is_empty());
}

TEST_F(RenderMerge, TilesMakeTheWholeByteForByte) {
    expect_equal_whole({});
    expect_equal_whole({"--layers", "path,data,light,cryptomatte", "--supersample", "3"});
    expect_equal_whole({"--layers", "path,N,Z", "--bits", "half", "--background", "transparent", "--z-far", "inf"});
    expect_equal_whole({"--layers", "path,cryptomatte", "--split", "parts", "--compression", "piz"});
    expect_equal_whole({"--bits", "half", "--colorspace", "lin_ap0_scene", "--compression", "none"});
    expect_equal_whole({"--precision", "double", "--compression", "rle", "--depth", "2"});
}

/// A pixel's samples are its own, so neighbors in other tiles count for nothing; what was checked is counted together.
TEST_F(RenderMerge, AdaptiveTilesMakeTheWhole) {
    for (const char* target : {"0.05", "0.004"})
        expect_equal_whole({"--target-error", target, "--layers", "samples,error,diffuse", "--depth", "64"});
}

TEST_F(RenderMerge, FilesOfLayersAreMergedToo) {
    const Arguments options{"-f", "1-2", "--layers", "diffuse,Z,N,cryptomatte", "--split", "files"};
    Arguments whole = options;
    whole.insert(whole.begin(), {"s.json", "-q", "-o", "whole.#.exr"});
    expect_done(whole);
    render_tiles("t.#.exr", "2x2", 4, options);
    expect_merged({"--tiles", "2x2", "-o", "t.#.exr", "-f", "1-2", "-q"});
    for (const char* layer : {"", "diffuse.", "N.", "CryptoObject.", "CryptoMaterial."})
        for (const int frame : {1, 2})
            EXPECT_EQ(bytes_of(file(fmt::format("whole.{}{}.exr", layer, frame))),
                      bytes_of(file(fmt::format("t.{}{}.exr", layer, frame))))
                << layer << frame;
    std::filesystem::remove(file("t.tile3.N.2.exr"));
    expect_no_merge({"--tiles", "2x2", "-o", "t.#.exr", "-f", "2"}, ExitCode::file,
                    "t.N.2.exr: 1 of its 4 tiles is missing: t.tile3.N.2.exr; render --tiles 2x2 --tile 3 -f 2");
}

TEST_F(RenderMerge, FilesOfOtherRendersBesideAreRefusedOrLeftAlone) {
    // Layers of another render are refused before anything is written.
    render_tiles("t.exr", "2x1", 2, {"--layers", "reflection", "--split", "files", "--depth", "2"});
    render_tiles("t.exr", "2x1", 2, {"--layers", "diffuse", "--split", "files"});
    expect_no_merge({"--tiles", "2x1", "-o", "t.exr"}, ExitCode::failed,
                    "t.tile0.reflection.exr: cistula:depth is 2, and 6 in t.tile0.exr");
    EXPECT_FALSE(exists("t.exr") || exists("t.diffuse.exr") || exists("t.reflection.exr"));
    // The tiles of a film, and files that are no layers, are none of a still's.
    render_tiles("a.exr", "2x1", 2, {"--layers", "diffuse", "--split", "files"});
    render_tiles("a.####.exr", "2x1", 2, {"-f", "0-1"});
    for (const char* name : {"a.0000.exr", "a.tile0.notes.exr", "a.tile0.snapshot.exr"}) put_bytes(file(name), "mine");
    std::filesystem::remove(file("a.tile1.0001.exr"));
    expect_merged({"--tiles", "2x1", "-o", "a.exr", "-q"});
    EXPECT_TRUE(exists("a.exr") && exists("a.diffuse.exr"));
    EXPECT_EQ(bytes_of(file("a.0000.exr")), "mine");
    EXPECT_FALSE(exists("a.0001.exr") || exists("a.notes.exr"));
}

/// What a header claims is checked before there is memory for it.
TEST_F(RenderMerge, ClaimsOfHeadersCostNothing) {
    if (needs_all_memory) GTEST_SKIP() << "the sanitizer needs memory for itself";
    render_tiles("t.exr", "2x1", 1, {});
    std::vector<PicturePart> parts = read_exr_parts(file("t.tile0.exr"));
    parts[0].picture.display_width = parts[0].picture.display_height = 65536;
    write_exr(file("t.tile0.exr"), parts);
    const ProgramResult result =
        RunningProgram("/bin/sh",
                       {"-c", "ulimit -v 2000000; exec " CISTULA_BIN_DIR "/render-merge t.tile0.exr -o o.exr"},
                       file(""))
            .wait();
    EXPECT_EQ(result.code, 1);
    EXPECT_NE(result.error.find("of 4294967296 pixels are in no tile"), std::string::npos) << result.error;
}

TEST_F(RenderMerge, CropsAndPreviews) {
    const Arguments crop{"--crop", "23x17+9+4"};
    expect_done({"s.json", "-q", "-o", "w.exr", "--crop", "23x17+9+4"});
    render_tiles("t.exr", "2x3", 6, crop);
    expect_merged({"--tiles", "2x3", "-o", "t.exr", "--crop", "23x17+9+4", "-q"});
    EXPECT_EQ(bytes_of(file("w.exr")), bytes_of(file("t.exr")));
    expect_no_merge({"--tiles", "2x3", "-o", "t.exr"}, ExitCode::failed, "569 of 960 pixels are in no tile: 40x4+0+0");
    expect_no_merge({"--tiles", "2x3", "-o", "t.exr", "--crop", "41x2+0+0"}, ExitCode::usage, "leaves the frame");

    expect_done({"s.json", "-q", "-o", "w.exr", "--preview", "w.png", "--view", "filmic", "--bloom", "2"});
    render_tiles("p.exr", "2x1", 2, {});
    expect_merged(
        {"p.tile1.exr", "p.tile0.exr", "-o", "p.exr", "--preview", "p.png", "--view", "filmic", "--bloom", "2", "-q"});
    EXPECT_EQ(bytes_of(file("w.png")), bytes_of(file("p.png")));
    render_tiles("q.exr", "2x1", 2, {"--background", "transparent"});
    expect_no_merge({"--tiles", "2x1", "-o", "q.exr", "--preview", "q.png"}, ExitCode::usage,
                    "background was left out");
}

TEST_F(RenderMerge, GapsAndOverlapsAreToldByTheirPixels) {
    render_tiles("t.exr", "2x2", 4, {});
    expect_no_merge({"t.tile0.exr", "t.tile3.exr", "-o", "o.exr"}, ExitCode::failed,
                    "480 of 960 pixels are in no tile: 20x12+20+0, 20x12+0+12");
    expect_done({"s.json", "-q", "-o", "c.exr", "--crop", "8x6+18+9"});
    expect_no_merge({"t.tile0.exr", "c.exr", "-o", "o.exr"}, ExitCode::failed,
                    "c.exr: its pixels 2x3+18+9 are also in t.tile0.exr");
    EXPECT_FALSE(exists("o.exr"));
}

TEST_F(RenderMerge, TilesOfOtherRendersAreRefused) {
    render_tiles("t.exr", "2x1", 2, {});
    const auto refused = [&](const std::string& part) {
        expect_no_merge({"t.tile0.exr", "t.tile1.exr", "-o", "o.exr"}, ExitCode::failed, part);
    };
    const auto right = [&](Arguments more) {
        more.insert(more.begin(), {"s.json", "-q", "-o", "t.exr", "--tiles", "2x1", "--tile", "1"});
        expect_done(more);
    };
    right({"--depth", "3"});
    refused("t.tile1.exr: cistula:depth is 3, and 6 in t.tile0.exr");
    right({"-f", "1"});
    refused("cistula:cameraHash");
    right({"--bits", "half"});
    refused("its channels are A (half) B (half)");
    right({"--compression", "piz"});
    refused("is compressed otherwise");
    right({"--layers", "Z", "--split", "parts"});
    refused("has 2 parts");
    right({"--res", "60x24"});
    refused("its frame is 60x24, and 40x24 in t.tile0.exr");
    right({});
    std::vector<PicturePart> parts = read_exr_parts(file("t.tile1.exr"));
    parts[0].picture.attributes["cistula:version"] = std::string("0.0.9");
    write_exr(file("t.tile1.exr"), parts);
    refused("t.tile1.exr: cistula:version is '0.0.9', and '" CISTULA_VERSION "' in t.tile0.exr");
    parts[0].picture.attributes["cistula:snapshot"] = 0.5;
    write_exr(file("t.tile1.exr"), parts);
    refused("is a snapshot of a frame in work");
    parts[0].picture.attributes = {};
    write_exr(file("t.tile1.exr"), parts);
    expect_no_merge({"t.tile1.exr", "-o", "o.exr"}, ExitCode::failed, "is no tile that render wrote");
    put_bytes(file("t.tile1.exr"), "no EXR");
    expect_no_merge({"t.tile0.exr", "t.tile1.exr", "-o", "o.exr"}, ExitCode::file, "t.tile1.exr");
    EXPECT_FALSE(exists("o.exr"));
}

TEST_F(RenderMerge, RefusesInOneLine) {
    expect_no_merge({}, ExitCode::usage, "no output is given");
    expect_no_merge({"-o", "a.exr"}, ExitCode::usage, "no tiles are given");
    expect_no_merge({"t.exr", "-o", "a.png"}, ExitCode::usage, "name it *.exr");
    expect_no_merge({"t.exr", "-o", "a.#.exr"}, ExitCode::usage, "of one frame");
    expect_no_merge({"--tiles", "2x2", "-o", "a.#.exr"}, ExitCode::usage, "--frames LIST says which");
    expect_no_merge({"t.exr", "--tiles", "2x2", "-o", "a.exr"}, ExitCode::usage, "leave one out");
    expect_no_merge({"t.exr", "-o", "a.exr", "--bloom", "1"}, ExitCode::usage, "--bloom 1: is for --preview");
    expect_no_merge({"s.json", "-o", "s.json.exr"}, ExitCode::file, "s.json");
    render_tiles("t.exr", "1x1", 1, {});
    expect_no_merge({"t.tile0.exr", "-o", "t.tile0.exr"}, ExitCode::usage, "would be both a tile and the whole frame");
    EXPECT_EQ(merge({"--version"}).out, "render-merge (Cistula) " CISTULA_VERSION "\n");
    EXPECT_NE(merge({"--help"}).out.find("Examples:"), std::string::npos);
}

TEST_F(RenderMerge, RenderRefusesWhatATileCannotBe) {
    const auto refused = [&](Arguments more, const std::string& part) {
        more.insert(more.begin(), {"s.json", "-o", "a.exr", "--tiles", "2x2", "--tile", "1"});
        expect_refused(more, ExitCode::usage, part);
    };
    refused({"--preview", "p.png"}, "--tile 1: --preview has no place here: it is of whole frames; render-merge");
    refused({"--compression", "dwab"}, "--compression dwab has no place here");
    refused({"--pixel", "1,1"}, "--pixel 1,1:");
    refused({"--explain"}, "--explain has no place here");
    expect_refused({"s.json", "-o", "a.out", "--tiles", "2x2", "--tile", "1"}, ExitCode::usage, "--tile needs an .exr");
    expect_refused({"s.json", "--tile", "1"}, ExitCode::usage, "--tile 1: is for --tiles");
    expect_refused({"s.json", "--tiles", "2x2"}, ExitCode::usage, "is for --tile N");
    expect_refused({"s.json", "--tiles", "2x2", "--tile", "4"}, ExitCode::usage, "a whole number from 0 to 3");
    expect_refused({"s.json", "--tiles", "41x1", "--tile", "4"}, ExitCode::usage, "more than there are pixels, 40x24");
}

}  // namespace
}  // namespace cistula
