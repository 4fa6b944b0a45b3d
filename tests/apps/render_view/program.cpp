// The built `render-view` from outside: PNGs, what it says, exit codes, files.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <limits>

#include "apps/render_view/options.h"
#include "base/error.h"
#include "image/exr/exr.h"
#include "testing/support/expect_error.h"
#include "testing/support/pictures/exr_parts.h"
#include "testing/support/pictures/png_pixels.h"
#include "testing/support/run_program.h"

namespace cistula {
namespace {

using Arguments = std::vector<std::string>;
using Pixel = std::array<int, 3>;

constexpr Pixel border{48, 48, 48};

/// 2 x 1 pixels: black and white, near and far, one and two.
LayeredPicture small_picture() {
    LayeredPicture picture;
    picture.width = picture.display_width = 2;
    picture.height = picture.display_height = 1;
    picture.channels = {{"R", true, {0, 1}},       {"G", true, {0, 1}},           {"B", true, {0, 1}},
                        {"Z", false, {3, 5}},      {"gloss.R", false, {0.5f, 0}}, {"gloss.G", false, {0, 0}},
                        {"gloss.B", false, {0, 0}}};
    return picture;
}

class RenderView : public testing::Test {
  protected:
    RenderView() { write_exr(file("a.exr"), small_picture()); }

    std::string file(const std::string& name) const { return folder_.file(name); }
    bool exists(const std::string& name) const { return std::filesystem::exists(file(name)); }

    ProgramResult run(const Arguments& arguments) const {
        return RunningProgram(CISTULA_BIN_DIR "/render-view", arguments, file("")).wait();
    }

    /// The standard output of a run that is done and says nothing on standard error.
    std::string expect_done(const Arguments& arguments) const {
        const ProgramResult result = run(arguments);
        EXPECT_EQ(result.code, 0) << result.error;
        EXPECT_EQ(result.error, "");
        return result.out;
    }

    void expect_refused(const Arguments& arguments, ExitCode code, const std::string& message) const {
        const std::vector<std::string> before = names();
        const ProgramResult result = run(arguments);
        EXPECT_EQ(result.code, static_cast<int>(code)) << result.error;
        EXPECT_EQ(result.error, "render-view: " + message + "\n");
        EXPECT_EQ(result.out, "");
        EXPECT_EQ(names(), before);
    }

    PngPixels png(const std::string& name) const { return png_pixels(bytes_of(file(name))); }

    std::vector<std::string> names() const {
        std::vector<std::string> names = folder_.names();
        std::sort(names.begin(), names.end());
        return names;
    }

    const ScratchDirectory folder_;
};

TEST_F(RenderView, PrintsWhatItIsAskedFor) {
    const std::string help = expect_done({"--help"});
    for (const char* part : {"--output", "--layer", "--all", "--list", "--columns", "--exposure", "--view", "--bloom",
                             "--quiet", "--version", "Examples:", "Exit codes: 0 done"})
        EXPECT_NE(help.find(part), std::string::npos) << part;
    EXPECT_EQ(expect_done({"--version"}), "render-view (Cistula) " CISTULA_VERSION "\n");
    EXPECT_EQ(expect_done({"a.exr", "--list"}),
              "layer  shown as             size         channels\n"
              "RGB    color                2x1          half R G B\n"
              "Z      depth                2x1          float Z\n"
              "gloss  color                2x1          float gloss.R gloss.G gloss.B\n");
    EXPECT_EQ(names(), std::vector<std::string>{"a.exr"});
}

TEST_F(RenderView, ShowsColorsBesideTheWorkingDirectorysFiles) {
    std::filesystem::create_directory(file("in"));
    std::filesystem::rename(file("a.exr"), file("in/a.exr"));
    EXPECT_EQ(expect_done({"in/a.exr"}), "a.view.png: 2x1\nRGB: color\n");
    EXPECT_EQ(png("a.view.png").bytes, (std::vector<uint8_t>{0, 0, 0, 255, 255, 255}));
    EXPECT_EQ(expect_done({"in/a.exr", "-q", "-o", "new/folder/b.png", "--exposure", "-2"}), "");
    EXPECT_EQ(png("new/folder/b.png").bytes, (std::vector<uint8_t>{0, 0, 0, 137, 137, 137}));
    expect_done({"in/a.exr", "-q", "--view", "filmic"});
    EXPECT_EQ(png("a.view.png").at(1, 0), (Pixel{208, 208, 208}));
}

TEST_F(RenderView, ShowsLayersSideBySide) {
    EXPECT_EQ(expect_done({"a.exr", "--layer", "Z,RGB", "--layer", "gloss", "--columns", "2", "-o", "s.png"}),
              "s.png: 12x10\n"
              "row 1, column 1: Z: depth, 3 bright to 5 dark\n"
              "row 1, column 2: RGB: color\n"
              "row 2, column 1: gloss: color\n");
    const PngPixels sheet = png("s.png");
    ASSERT_EQ(sheet.width, 12u);
    ASSERT_EQ(sheet.height, 10u);
    EXPECT_EQ(sheet.at(0, 0), (Pixel{255, 255, 255}));
    EXPECT_EQ(sheet.at(1, 0), (Pixel{32, 32, 32}));
    EXPECT_EQ(sheet.at(2, 0), border);
    EXPECT_EQ(sheet.at(9, 0), border);
    EXPECT_EQ(sheet.at(10, 0), (Pixel{0, 0, 0}));
    EXPECT_EQ(sheet.at(11, 0), (Pixel{255, 255, 255}));
    EXPECT_EQ(sheet.at(0, 1), border);
    EXPECT_EQ(sheet.at(0, 9), (Pixel{188, 0, 0}));
    EXPECT_EQ(sheet.at(11, 9), border);
    expect_done({"a.exr", "--all", "-o", "all.png"});
    EXPECT_EQ(png("all.png").width, 3 * 2u + 2 * 8u);
}

TEST_F(RenderView, ShowsPartsOfSeveralSizes) {
    test::write_parts(file("p.exr"),
                      {{"main", 2, 1, {{"Y", {0, 1}, {}}, {"id", {}, {0, 1u << 31}}}},
                       {"N", 1, 3, {{"N.X", {0, 0, 1}, {}}, {"N.Y", {0, 1, 0}, {}}, {"N.Z", {1, 0, 0}, {}}}, true}});
    EXPECT_EQ(expect_done({"p.exr", "--all", "-o", "p.png"}),
              "p.png: 22x3\nrow 1, column 1: main.Y: luminance\nrow 1, column 2: main.id: ids\nrow 1, column 3: N: "
              "normals\n");
    const PngPixels sheet = png("p.png");
    EXPECT_EQ(sheet.at(1, 0), (Pixel{255, 255, 255}));
    EXPECT_EQ(sheet.at(1, 1), border);
    EXPECT_EQ(sheet.at(10, 0), (Pixel{0, 0, 0}));
    EXPECT_NE(sheet.at(11, 0), (Pixel{0, 0, 0}));
    EXPECT_EQ(sheet.at(20, 0), (Pixel{128, 128, 255}));
    EXPECT_EQ(sheet.at(20, 2), (Pixel{255, 128, 128}));
}

TEST_F(RenderView, SaysHowManyPixelsAreNotFinite) {
    LayeredPicture picture = small_picture();
    picture.channels[0].values[0] = std::numeric_limits<float>::quiet_NaN();
    picture.channels[1].values[1] = std::numeric_limits<float>::infinity();
    write_exr(file("a.exr"), picture);
    EXPECT_EQ(expect_done({"a.exr", "--bloom", "1", "--view", "filmic"}),
              "a.view.png: 2x1\nRGB: color, 1 pixel is not a number (magenta), 1 pixel is infinite (cyan)\n");
    EXPECT_EQ(png("a.view.png").bytes, (std::vector<uint8_t>{255, 0, 255, 0, 255, 255}));
}

TEST_F(RenderView, RefusesWhatIsNotThere) {
    expect_refused({"a.exr", "--layer", "glos"}, ExitCode::usage,
                   "--layer glos: a.exr has no layer 'glos'; the layers are: gloss, RGB, Z");
    expect_refused({"b.exr"}, ExitCode::file, "b.exr: cannot read: No such file or directory; check the spelling");
    put_bytes(file("c.exr"), "no picture");
    const ProgramResult result = run({"c.exr"});
    EXPECT_EQ(result.code, 3);
    EXPECT_EQ(result.error.rfind("render-view: c.exr: cannot read: ", 0), 0u) << result.error;
    EXPECT_EQ(std::count(result.error.begin(), result.error.end(), '\n'), 1) << result.error;
    EXPECT_FALSE(exists("c.view.png"));
}

/// Views of configs come after our own, where there is a config.
TEST_F(RenderView, RefusesUnknownViews) {
    const ProgramResult result = run({"a.exr", "--view", "filmik"});
    EXPECT_EQ(result.code, 2);
    EXPECT_EQ(result.error.rfind("render-view: --view filmik: there is no such view; the views are: filmic, ", 0), 0u)
        << result.error;
    EXPECT_EQ(std::count(result.error.begin(), result.error.end(), '\n'), 1) << result.error;
}

/// A small file cannot ask for gigabytes by parts of unlike sizes.
TEST_F(RenderView, RefusesSheetsOfNothingButBorders) {
    const std::vector<float> line(20000);
    test::write_parts(file("u.exr"), {{"wide", 20000, 1, {{"Y", line, {}}}}, {"tall", 1, 20000, {{"Y", line, {}}}}});
    expect_refused({"u.exr", "--all"}, ExitCode::usage,
                   "2 layers would be a picture of 40008x20000 pixels: too large, or mostly borders; name fewer");
    expect_done({"u.exr", "--layer", "tall.Y"});
}

/// What was shown before stays where the next is not.
TEST_F(RenderView, APictureThatIsCutOffLeavesThePngAsItWas) {
    expect_done({"a.exr", "-q", "-o", "v.png"});
    const std::string before = bytes_of(file("v.png")), bytes = bytes_of(file("a.exr"));
    put_bytes(file("a.exr"), bytes.substr(0, bytes.size() - 3));
    EXPECT_EQ(run({"a.exr", "-o", "v.png"}).code, 3);
    EXPECT_EQ(bytes_of(file("v.png")), before);
    EXPECT_EQ(names(), (std::vector<std::string>{"a.exr", "v.png"}));
}

TEST_F(RenderView, ThePngIsTheResultWhateverBecomesOfStandardOutput) {
    const auto with_full_output = [&](const Arguments& arguments) {
        return RunningProgram(CISTULA_BIN_DIR "/render-view", arguments, file(""), "",
                              [] { dup2(open("/dev/full", O_WRONLY), STDOUT_FILENO); })
            .wait();
    };
    const std::string full = "standard output: cannot write: No space left on device";
    const ProgramResult shown = with_full_output({"a.exr", "-o", "a.png"}),
                        listed = with_full_output({"a.exr", "--list"});
    EXPECT_EQ(shown.code, 0);
    EXPECT_EQ(shown.error.rfind("render-view: warning: " + full, 0), 0u) << shown.error;
    EXPECT_EQ(png("a.png").width, 2u);
    EXPECT_EQ(listed.code, static_cast<int>(ExitCode::file));
    EXPECT_EQ(listed.error.rfind("render-view: " + full, 0), 0u) << listed.error;
}

TEST_F(RenderView, NeverWritesOverTheImage) {
    std::filesystem::create_symlink("a.exr", file("link.png"));
    expect_refused({"a.exr", "-o", "link.png"}, ExitCode::usage,
                   "link.png: would be both the image and -o; give each a file of its own");
    std::filesystem::create_hard_link(file("a.exr"), file("a.view.png"));
    expect_refused({"a.exr"}, ExitCode::usage,
                   "a.view.png: would be both the image and -o; give each a file of its own");
}

TEST(ViewOptions, AreChecked) {
    const auto parse = [](std::vector<const char*> arguments) {
        arguments.insert(arguments.begin(), "render-view");
        return parse_view_options(static_cast<int>(arguments.size()), arguments.data());
    };
    EXPECT_EQ(parse({"in/f.exr"}).output, "f.view.png");
    EXPECT_EQ(parse({"in/f.exr"}).columns, 4);
    EXPECT_FALSE(parse({"f.exr"}).exposed);
    EXPECT_TRUE(parse({"f.exr", "--exposure", "0"}).exposed);
    EXPECT_EQ(parse({"--layer", "a", "f.exr", "--layer", "b,c"}).layers, (std::vector<std::string>{"a", "b,c"}));
    const auto expect_refused = [&](const std::vector<const char*>& arguments, const std::string& message) {
        EXPECT_ERROR(parse(arguments), ExitCode::usage, message);
    };
    expect_refused({}, "no image is given: render-view FILE.exr; --help tells more");
    expect_refused({"a.exr", "b.exr"}, "b.exr: one image at a time, and a.exr is it already");
    expect_refused({"a.exr", "-o", "b.jpg"}, "-o b.jpg: what is seen is written as a PNG; name it *.png");
    expect_refused({"a.exr", "--columns", "0"}, "--columns 0: must be a whole number from 1 to 1000");
    expect_refused({"a.exr", "--all", "--layer", "Z"},
                   "--layer Z: has no place beside --all, which shows every layer; leave one out");
    expect_refused({"a.exr", "--list", "-o", "b.png"}, "-o b.png: --list writes no picture; leave it out");
    expect_refused({"a.exr", "--exposure", "x"},
                   "--exposure x: must be a number of stops from -64 to 64; each doubles the light");
    expect_refused({"a.exr", "--layr", "Z"}, "--layr: no such option; did you mean '--layer'?; --help lists them");
}

}  // namespace
}  // namespace cistula
