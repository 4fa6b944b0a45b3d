// Textures of `render`: their limit, their warnings, and the one line that is said of a bad one.
#include <sys/stat.h>

#include "image/exr/exr.h"
#include "image/picture/raw_picture.h"
#include "testing/support/render_program.h"
#include "testing/support/special_values.h"

namespace cistula {
namespace {

class Textures : public RenderProgram {
  protected:
    /// Writes t.json, a quad with a texture whose JSON is this.
    void put_scene(const std::string& texture) const {
        put_bytes(file("t.json"), R"({"film": {"width": 8, "height": 6}, "textures": {"a/b": )" + texture + R"(},
            "materials": {"m": {"texture": "a/b"}},
            "objects": [{"quad": [[-1, 0, -1], [1, 0, -1], [1, 0, 1], [-1, 0, 1]], "material": "m"}]})");
    }

    void write_texture(const std::string& name, const std::vector<float>& row) const {
        LayeredPicture layers;
        layers.width = layers.display_width = static_cast<int>(row.size());
        layers.height = layers.display_height = 1;
        layers.channels = {{"Y", false, row}};
        write_exr(file(name), layers);
    }
};

TEST_F(Textures, ErrorsNameTheFileAndItsPlaceInTheScene) {
    put_scene(R"({"file": "t.exr"})");
    const Arguments arguments{"t.json", "-o", "a.exr"};
    const std::string start = "render: t.json: /textures/a~1b: t.exr: cannot read: ";
    expect_refused(arguments, ExitCode::file, start + "No such file or directory; check the spelling\n");
    ASSERT_EQ(mkfifo(file("t.exr").c_str(), 0600), 0);
    expect_refused(arguments, ExitCode::file, start + "it is a pipe, a socket or a device; give a file\n");
    std::filesystem::remove(file("t.exr"));
    put_bytes(file("t.exr"), "nonsense");
    expect_refused(arguments, ExitCode::file, start);
    EXPECT_FALSE(exists("a.exr"));
}

TEST_F(Textures, TheLimitIsAnOption) {
    put_scene(R"({"file": "t.data"})");
    write_raw_picture(file("t.data"), {100, 10, std::vector<glm::vec3>(1000, glm::vec3(1))});
    expect_done({"t.json", "-q", "-o", "a.exr", "--max-texture-gb", "0.000012"});
    expect_refused({"t.json", "-q", "-o", "b.exr", "--max-texture-gb", "1.1e-5"}, ExitCode::file,
                   "render: t.json: /textures/a~1b: t.data: cannot read: its size is 100x10, which takes 1.2e-05 GB of "
                   "memory; textures may take 1.1e-05 GB; give a smaller one, or raise the limit (--max-texture-gb of "
                   "render)\n");
    expect_refused({"t.json", "--pixel", "4,3", "--max-texture-gb", "1e-5"}, ExitCode::file,
                   "textures may take 1e-05 GB");
    for (const char* value : {"0", "-1", "x", "nan", "inf", "1e7", "1gb"})
        expect_refused({"t.json", "--max-texture-gb", value}, ExitCode::usage,
                       std::string("--max-texture-gb ") + value + ": must be a number above 0, to 1000000");
}

TEST_F(Textures, ClampedTexelsAreOneWarningOrAnError) {
    using test::infinity, test::nan;
    write_texture("t.exr", {1, -1, nan, infinity});
    put_scene(R"({"file": "t.exr"})");
    const ProgramResult result = run({"t.json", "-o", "a.exr", "--progress", "none"});
    EXPECT_EQ(result.code, 0);
    const std::string warning =
        "render: warning: t.json: /textures/a~1b: t.exr: values of its texels that are no radiance: 3 negative (taken "
        "as "
        "0), 3 not a number (taken as 0), 3 infinite (taken as 1), of 12; the first one is at (1, 0); \"strict\": true "
        "refuses them\n";
    EXPECT_EQ(result.error.substr(0, warning.size()), warning);
    EXPECT_EQ(result.error.find("warning", warning.size()), std::string::npos) << result.error;

    write_texture("t.exr", {1, 0, 0, 1});
    expect_done({"t.json", "-q", "-o", "b.exr", "--progress", "none"});
    EXPECT_EQ(run({"t.json", "-q", "-o", "b.exr"}).error, "");

    write_texture("t.exr", {1, -1, nan, infinity});
    put_scene(R"({"file": "t.exr", "strict": true})");
    expect_refused({"t.json", "-o", "c.exr"}, ExitCode::file,
                   "render: t.json: /textures/a~1b: t.exr: texel (1, 0) has R = -1, and so 9 of 12 values; texels are "
                   "finite and not negative\n");
}

}  // namespace
}  // namespace cistula
