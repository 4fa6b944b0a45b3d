// OpenImageIO is a module of the program that reads pictures: never in this process; both are found where they lie, and
// missed with a clear error.
#include <sys/resource.h>

#include <sstream>

#include "image/picture/picture_io.h"
#include "image/reader/oiio_module.h"
#include "testing/support/expect_error.h"
#include "testing/support/pictures/srgb_codes.h"
#include "testing/support/render_program.h"

namespace cistula {
namespace {

const std::string module_path = CISTULA_OIIO_MODULE, reader_path = CISTULA_READ_PICTURE;
const std::string module_name = std::filesystem::path(module_path).filename().string(),
                  reader_name = std::filesystem::path(reader_path).filename().string();

/// The path of a library of this process whose name begins so; empty where there is none.
std::string loaded_library(const std::string& name) {
    std::istringstream maps(bytes_of("/proc/self/maps"));
    for (std::string line; std::getline(maps, line);)
        if (line.find('/' + name) != std::string::npos) return line.substr(line.find('/'));
    return "";
}

TEST(OiioModule, IsNotLoadedHere) {
    const ScratchDirectory scratch;
    ColorPicture picture{2, 1, {glm::vec3(0), glm::vec3(linear_from_srgb8(77))}};
    write_preview(scratch.file("a.png"), picture);
    EXPECT_EQ(read_texture(scratch.file("a.png")).texels, picture.texels);
    EXPECT_EQ(loaded_library("libOpenImageIO"), "");
    EXPECT_EQ(loaded_library("libcistula_oiio"), "");
}

/// A copy of the program in bin/ of a folder of its own, where it knows of no program that reads pictures.
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

    /// Copies the program that reads pictures, and the module, or only one of them, into a directory of the prefix.
    void install(const std::string& directory, bool reader = true, bool module = true) const {
        if (reader) std::filesystem::copy_file(reader_path, prefix_.file(directory + reader_name));
        if (module) std::filesystem::copy_file(module_path, prefix_.file(directory + module_name));
    }

    /// One line that names the texture and its place in the scene.
    void expect_failure(const std::string& reason) const {
        const ProgramResult result = render("t.json");
        EXPECT_EQ(result.code, static_cast<int>(ExitCode::file));
        EXPECT_EQ(result.error, "render: t.json: /textures/t: t.png: cannot read: " + reason + "\n");
        EXPECT_FALSE(exists("a.exr"));
    }

    const ScratchDirectory prefix_;
};

TEST_F(MovedProgram, SaysWhatItMisses) {
    const std::string missing = "textures other than .data need the program " + reader_name +
                                ", which is not found on the library path, " + prefix_.file("bin") + ", " +
                                prefix_.file("lib/cistula") + ", " + prefix_.file("lib") +
                                "; install it with Cistula, or put it into one of them";
    expect_failure(missing);
    install("bin/", false, true);
    expect_failure(missing);
    put_bytes(prefix_.file("lib/" + reader_name), "not executable");
    expect_failure(missing);
}

TEST_F(MovedProgram, SaysThatTheModuleIsMissing) {
    install("lib/", true, false);
    expect_failure("formats other than EXR and .data need the module " + module_name + ", which is not in " +
                   prefix_.file("lib") + "; builds with OpenImageIO have it: `make build` installs and uses that");
}

TEST_F(MovedProgram, AnyLimitOnMemoryIsToldInOneLine) {
    if (needs_all_memory) GTEST_SKIP() << "the sanitizer needs memory for itself";
    install("lib/");
    int failed = 0, rendered = 0;
    for (rlim_t mebibytes = 360; rendered < 3 && mebibytes < 4000; mebibytes += 24) {
        const rlimit limit{mebibytes << 20, mebibytes << 20};
        const ProgramResult result =
            RunningProgram(prefix_.file("bin/render"), {"t.json", "-q", "-f", "0", "--threads", "1", "-o", "a.exr"},
                           file(""), "",
                           [&] {
                               alarm(60);  // ends what hangs
                               setrlimit(RLIMIT_AS, &limit);
                           })
                .wait();
        ++(result.code == 0 ? rendered : failed);
        if (result.code == 0) continue;
        EXPECT_EQ(result.code, 1) << mebibytes << " MiB: " << result.error;
        EXPECT_EQ(result.error.rfind("render: out of memory; ", 0), 0u) << mebibytes << " MiB: " << result.error;
        EXPECT_EQ(std::count(result.error.begin(), result.error.end(), '\n'), 1) << result.error;
    }
    EXPECT_GT(failed, 2);
    EXPECT_EQ(rendered, 3);
}

TEST_F(MovedProgram, NeedsNothingForItsOwnFormats) {
    const ProgramResult result = render("s.json");
    EXPECT_EQ(result.code, 0) << result.error;
    EXPECT_TRUE(exists("a.exr"));
    EXPECT_EQ(bytes_of(file("p.png")).substr(1, 3), "PNG");
}

TEST_F(MovedProgram, FindsTheReaderBesideItself) {
    for (const char* directory : {"bin/", "lib/cistula/", "lib/"}) {
        install(directory);
        const ProgramResult result = render("t.json");
        EXPECT_EQ(result.code, 0) << directory << ": " << result.error;
        ASSERT_TRUE(exists("a.exr")) << directory;
        std::filesystem::remove(file("a.exr"));
        std::filesystem::remove(prefix_.file(directory + module_name));
        std::filesystem::remove(prefix_.file(directory + reader_name));
    }
}

TEST_F(MovedProgram, SaysWhatIsWrongWithTheModule) {
    install("lib/", true, false);
    const std::string start = "formats other than EXR and .data need the module " + module_name +
                              ", which cannot be loaded from " + prefix_.file("lib") + ": ";
    put_bytes(prefix_.file("lib/" + module_name), "no library");
    expect_failure(start + prefix_.file("lib/" + module_name) + ": file too short");
    // A library that is none of this version of Cistula.
    const std::string other = loaded_library("libz");
    ASSERT_NE(other, "");
    std::filesystem::remove(prefix_.file("lib/" + module_name));
    std::filesystem::copy_file(other, prefix_.file("lib/" + module_name));
    expect_failure(start + prefix_.file("lib/" + module_name) + ": undefined symbol: " + oiio_module_entry);
}

TEST_F(MovedProgram, SaysWhatIsWrongWithTheReader) {
    const std::string reader = prefix_.file("lib/" + reader_name);
    const auto put_reader = [&](const std::string& text) {
        put_bytes(reader, text);
        std::filesystem::permissions(reader, std::filesystem::perms::owner_all);
    };
    put_reader("#!/bin/sh\necho one; echo two >&2; exit 64\n");
    expect_failure(reader + " belongs to another version of Cistula");
    put_reader("#!/bin/sh\nexit 127\n");
    expect_failure(reader + " cannot be started; are the libraries that it needs installed?");
    put_reader("#!/bin/sh\nexit 7\n");
    expect_failure("its decoder ended with exit code 7; the file is damaged");
    put_reader("#!/bin/sh\nexit 65\n");
    const ProgramResult result = render("t.json");
    EXPECT_EQ(result.code, 1);
    EXPECT_EQ(result.error.rfind("render: out of memory; ", 0), 0u) << result.error;
    put_reader("#!/bin/sh\nkill -ABRT $$\n");
    expect_failure("its decoder was ended by signal 6 (Aborted); the file is damaged");
    put_reader("#!/bin/sh\nhead -c 100000 /dev/zero >&3; cat <&3 >/dev/null\n");  // a request not read is an error of
                                                                                  // the socket
    expect_failure("its decoder gave an answer that makes no sense; the file is damaged, give another");
}

}  // namespace
}  // namespace cistula
