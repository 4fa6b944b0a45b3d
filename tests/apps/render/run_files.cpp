// Files that are read and written: which names are one file, by whatever path, and what is refused.
#include "sequence/run_files.h"

#include <fcntl.h>
#include <unistd.h>

#include "image/exr/exr.h"
#include "testing/support/expect_error.h"
#include "testing/support/render_program.h"

namespace cistula {
namespace {

namespace fs = std::filesystem;

class RunFilesTest : public testing::Test {
  protected:
    std::string file(const std::string& name) const { return scratch_.file(name); }
    void expect_one(const std::string& first, const std::string& second) const {
        RunFiles files;
        files.reads(first, "the first");
        EXPECT_ERROR(files.writes(second, "the second"), ExitCode::usage,
                     second + ": would be both the first and the second; give each a file of its own");
        RunFiles written;
        written.writes(first, "an image");
        EXPECT_ERROR(written.writes(second, "an image"), ExitCode::usage,
                     second + ": would be both an image and an image, " + first + "; give each a file of its own");
    }

    const ScratchDirectory scratch_;
};

TEST_F(RunFilesTest, OneFileIsKnownByAnyOfItsNames) {
    put_bytes(file("a"), "");
    fs::create_hard_link(file("a"), file("hard"));
    fs::create_symlink("a", file("soft"));
    fs::create_symlink("soft", file("softer"));
    fs::create_directory(file("d"));
    fs::create_symlink("d", file("link"));
    put_bytes(file("d/b"), "");
    for (const char* name : {"a", "hard", "soft", "softer", "d/../a", "./a", "link/../a"})
        expect_one(file("a"), file(name));
    expect_one(file("d/b"), file("link/b"));
    // Neither exists yet, nor do their folders.
    for (const char* name : {"d/x", "link/x", "d//x", "none/../d/x"}) expect_one(file("d/x"), file(name));
    for (const char* name : {"none/y/x", "link/../none/./y/x"}) expect_one(file("none/y/x"), file(name));
    expect_one("x", fs::current_path().string() + "/x");
}

TEST_F(RunFilesTest, OthersAreNot) {
    put_bytes(file("a"), "");
    put_bytes(file("b"), "");
    fs::create_directory(file("d"));
    RunFiles files;
    files.reads("-", "the scene");
    files.reads(file("a"), "the scene");
    files.reads(file("a"), "the scene again");
    for (const char* name : {"b", "x", "d/a", "d/x", "none/a", "none/x", "none/d/x"}) files.writes(file(name), name);
    files.writes("", "nothing");
    files.writes("", "nothing");
    EXPECT_ERROR(files.writes(file("a"), "an image"), ExitCode::usage,
                 file("a") + ": would be both the scene and an image; give each a file of its own");
}

/// A scene with every kind of file that one can name.
class SceneFiles : public RenderProgram {
  protected:
    SceneFiles() {
        LayeredPicture picture;
        picture.width = picture.height = picture.display_width = picture.display_height = 1;
        for (const char* name : {"R", "G", "B"}) picture.channels.push_back({name, false, {0.5f}});
        write_exr(file("texture.1.exr"), picture);
        put_bytes(file("unused.exr"), "");
        put_bytes(file("mesh.ply"),
                  "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
                  "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
                  "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
        put_bytes(file("mesh.obj"), "mtllib m.mtl\nusemtl m\nv 0 0 1\nv 1 0 1\nv 0 1 1\nf 1 2 3\n");
        put_bytes(file("m.mtl"), "newmtl m\nKd 1 1 1\nmap_Kd -s 2 2 map.png\nmap_Bump gone.exr\n");
        put_bytes(file("map.png"), "no picture");
        put_bytes(file("names.json"), R"({
            "film": {"width": 8, "height": 6, "frames": 3},
            "textures": {"t": {"file": "texture.1.exr"}, "u": {"file": "unused.exr"}},
            "materials": {"m": {"texture": "t"}, "plain": {}},
            "objects": [{"mesh": "mesh.ply", "material": "plain"}, {"mesh": "mesh.obj"},
                        {"quad": [[-4, -4, 0], [4, -4, 0], [4, 4, 0], [-4, 4, 0]], "material": "m"}],
            "lights": [{"position": [-4, 4, 5]}]})");
    }
};

TEST_F(SceneFiles, AreNeverWritten) {
    const char* names[] = {"names.json", "texture.1.exr", "unused.exr", "mesh.ply", "mesh.obj", "m.mtl", "map.png"};
    std::vector<std::string> before;
    for (const char* name : names) before.push_back(bytes_of(file(name)));
    for (const char* name : names) {
        const std::string by_what = std::string(name) == "names.json"
                                        ? ": would be both the scene and "
                                        : ": would be both " + std::string(name) + ", which the scene names, and ";
        fs::create_hard_link(file(name), file("hard.exr"));
        fs::create_symlink(name, file("soft.2.png"));
        expect_refused({"names.json", "-q", "-o", "o.exr", "--stats", name}, ExitCode::usage,
                       name + by_what + "--stats");
        expect_refused({"names.json", "-q", "-o", "hard.exr"}, ExitCode::usage, "hard.exr" + by_what + "an image");
        expect_refused({"names.json", "-q", "-o", "hard.exr", "--resume"}, ExitCode::usage, by_what);
        expect_refused({"names.json", "-q", "-o", "o.#.exr", "--preview", "soft.#.png"}, ExitCode::usage,
                       "soft.2.png" + by_what + "a preview");
        expect_refused({"names.json", "-q", "--pixel", "1,1", "--json", name}, ExitCode::usage,
                       name + by_what + "--json");
        fs::remove(file("hard.exr"));
        fs::remove(file("soft.2.png"));
    }
    expect_refused({"names.json", "-q", "-o", "texture.#.exr"}, ExitCode::usage, "texture.1.exr: would be both");
    expect_refused({"names.json", "-q", "-o", "gone.exr"}, ExitCode::usage, "gone.exr, which the scene names,");
    for (size_t i = 0; i < before.size(); ++i) EXPECT_EQ(bytes_of(file(names[i])), before[i]) << names[i];
    for (const char* name : {"o.exr", "o.0.exr", "texture.0.exr"}) EXPECT_FALSE(exists(name)) << name;
    expect_done({"names.json", "-q", "-o", "texture.#.exr", "-f", "0,2", "--stats", "s.stats"});
}

TEST_F(SceneFiles, OfAMeshThatNamesThousandsAreToldApartAtOnce) {
    std::string text;
    for (int i = 0; i < 20'000; ++i) text += "mtllib l" + std::to_string(i) + ".mtl\n";
    put_bytes(file("mesh.obj"), text + bytes_of(file("mesh.obj")));
    const auto start = std::chrono::steady_clock::now();
    expect_done({"names.json", "-q", "-f", "0", "-o", "o.exr"});
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(20));  // minutes where each is compared
}

TEST_F(SceneFiles, RedirectedStreamsAreFilesToo) {
    const auto redirect = [&](int stream, const char* name, int flags) {
        dup2(open(file(name).c_str(), flags | O_CREAT, 0600), stream);
    };
    put_bytes(file("in.exr"), scene_text);
    const ProgramResult in = RunningProgram(program_, {"-", "-q", "-o", "in.exr"}, file(""), "", [&] {
                                 redirect(STDIN_FILENO, "in.exr", O_RDONLY);
                             }).wait();
    EXPECT_EQ(in.code, 2);
    EXPECT_EQ(in.error, "render: in.exr: would be both the scene and an image; give each a file of its own\n");
    EXPECT_EQ(bytes_of(file("in.exr")), scene_text);
    const ProgramResult out =
        RunningProgram(program_, {"s.json", "-q", "--pixel", "1,1", "--json", "p.json"}, file(""), "", [&] {
            redirect(STDOUT_FILENO, "p.json", O_WRONLY);
        }).wait();
    EXPECT_EQ(out.code, 2);
    EXPECT_EQ(out.error, "render: p.json: would be both standard output and --json; give each a file of its own\n");
    RunningProgram(program_, {"s.json", "-o", "o.exr", "--stats", "log"}, file(""), "", [&] {
        redirect(STDERR_FILENO, "log", O_WRONLY);
    }).wait();
    EXPECT_EQ(bytes_of(file("log")),
              "render: log: would be both standard error and --stats; give each a file of its own\n");
}

TEST_F(SceneFiles, SoIsTheConfigOfColors) {
    put_bytes(file("c.ocio"), "mine");
    const ProgramResult result =
        RunningProgram(program_, {"s.json", "-o", "o.exr", "--stats", "c.ocio"}, file(""), "", [&] {
            setenv("OCIO", file("c.ocio").c_str(), 1);
        }).wait();
    EXPECT_EQ(result.code, 2);
    EXPECT_NE(result.error.find("c.ocio: would be both the config that $OCIO names and --stats"), std::string::npos);
    EXPECT_EQ(bytes_of(file("c.ocio")), "mine");
}

TEST_F(SceneFiles, FramesAreFilesOfTheirOwn) {
    expect_done({"s.json", "-q", "-o", "a.#.exr"});
    fs::remove(file("a.2.exr"));
    fs::create_symlink("a.0.exr", file("a.2.exr"));
    const std::string first = bytes_of(file("a.0.exr"));
    expect_refused({"s.json", "-q", "-o", "a.#.exr"}, ExitCode::usage,
                   "a.2.exr: would be both an image and an image, a.0.exr; give each a file of its own");
    expect_refused({"s.json", "-q", "-o", "a.#.exr", "--resume"}, ExitCode::usage, "a.2.exr: would be both");
    EXPECT_EQ(bytes_of(file("a.0.exr")), first);
}

}  // namespace
}  // namespace cistula
