// OpenImageIO is a module: loaded when the first texture needs it, found where it lies, and missed with a clear error.
#include <algorithm>
#include <sstream>

#include "scene/image/picture_io.h"
#include "scene/image/srgb_codes.h"
#include "testing/support/expect_error.h"
#include "testing/support/render_program.h"

namespace cistula {
namespace {

const std::string module_path = CISTULA_OIIO_MODULE;
const std::string module_name = std::filesystem::path(module_path).filename().string();

/// The path of a library of this process whose name begins so; empty where there is none.
std::string loaded_library(const std::string& name) {
    std::istringstream maps(bytes_of("/proc/self/maps"));
    for (std::string line; std::getline(maps, line);)
        if (line.find('/' + name) != std::string::npos) return line.substr(line.find('/'));
    return "";
}

TEST(OiioModule, IsLoadedByTheFirstTextureThatNeedsIt) {
    EXPECT_EQ(loaded_library("libOpenImageIO"), "");
    EXPECT_EQ(loaded_library("libcistula_oiio"), "");
    const ScratchDirectory scratch;
    ColorPicture picture{2, 1, {glm::vec3(0), glm::vec3(linear_from_srgb8(77))}};
    write_preview(scratch.file("a.png"), picture);
    EXPECT_EQ(loaded_library("libcistula_oiio"), "") << "a PNG is written without it";
    EXPECT_EQ(read_texture(scratch.file("a.png")).texels, picture.texels);
    EXPECT_EQ(loaded_library("libcistula_oiio"), module_path);
    EXPECT_NE(loaded_library("libOpenImageIO"), "");
}

/// A copy of the program in bin/ of a folder of its own, where it knows of no module.
class MovedProgram : public RenderProgram {
  protected:
    MovedProgram() {
        std::filesystem::create_directories(prefix_.file("bin"));
        std::filesystem::create_directories(prefix_.file("lib/cistula"));
        std::filesystem::copy_file(program_, prefix_.file("bin/render"));
        write_preview(file("t.png"), ColorPicture{1, 1, {glm::vec3(1)}});
        put_bytes(file("t.json"), R"({
            "film": {"width": 8, "height": 6}, "textures": {"t": {"file": "t.png"}}, "materials": {"m": {"texture": "t"}},
            "objects": [{"quad": [[-1, 0, -1], [1, 0, -1], [1, 0, 1], [-1, 0, 1]], "material": "m"}]})");
    }

    ProgramResult render(const std::string& scene) const {
        return RunningProgram(prefix_.file("bin/render"), {scene, "-q", "-f", "0", "-o", "a.exr", "--preview", "p.png"},
                              file(""))
            .wait();
    }

    /// One line that names the texture, the module, where it was looked for, and what the loader said.
    void expect_failure(const std::string& loader_says) const {
        const ProgramResult result = render("t.json");
        EXPECT_EQ(result.code, static_cast<int>(ExitCode::file));
        EXPECT_EQ(result.error.rfind("render: t.png: cannot read: formats other than EXR and .data need the module " +
                                         module_name + ", which cannot be loaded from the library path, " +
                                         prefix_.file("bin") + ", " + prefix_.file("lib/cistula") + ", " +
                                         prefix_.file("lib") + ": ",
                                     0),
                  0u)
            << result.error;
        EXPECT_NE(result.error.find(loader_says), std::string::npos) << result.error;
        EXPECT_EQ(std::count(result.error.begin(), result.error.end(), '\n'), 1) << result.error;
        EXPECT_FALSE(exists("a.exr"));
    }

    const ScratchDirectory prefix_;
};

TEST_F(MovedProgram, SaysWhatItMisses) {
    expect_failure(": " + module_name + ": cannot open shared object file: No such file or directory\n");
}

TEST_F(MovedProgram, NeedsNoModuleForItsOwnFormats) {
    const ProgramResult result = render("s.json");
    EXPECT_EQ(result.code, 0) << result.error;
    EXPECT_TRUE(exists("a.exr"));
    EXPECT_EQ(bytes_of(file("p.png")).substr(1, 3), "PNG");
}

TEST_F(MovedProgram, FindsTheModuleBesideItself) {
    for (const char* directory : {"bin/", "lib/cistula/", "lib/"}) {
        const std::string copy = prefix_.file(directory + module_name);
        std::filesystem::copy_file(module_path, copy);
        const ProgramResult result = render("t.json");
        EXPECT_EQ(result.code, 0) << directory << ": " << result.error;
        ASSERT_TRUE(exists("a.exr")) << directory;
        std::filesystem::remove(file("a.exr"));
        std::filesystem::remove(copy);
    }
}

TEST_F(MovedProgram, SaysWhatIsWrongWithTheModule) {
    put_bytes(prefix_.file("lib/" + module_name), "no library");
    expect_failure(prefix_.file("lib/" + module_name) + ": file too short");
    // A library that is none of this version of Cistula.
    const std::string other = loaded_library("libz");
    ASSERT_NE(other, "");
    std::filesystem::copy_file(other, prefix_.file("bin/" + module_name));
    std::filesystem::remove(prefix_.file("lib/" + module_name));
    expect_failure("undefined symbol: cistula_oiio_module_2");
}

}  // namespace
}  // namespace cistula
