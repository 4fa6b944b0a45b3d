// Films of the built `render` that are resumed, interrupted, or cannot be written.
#include <chrono>

#include "image/exr/exr.h"
#include "testing/support/render_program.h"

namespace cistula {
namespace {

using RenderFilm = RenderProgram;

TEST_F(RenderFilm, ResumeSkipsWhatIsCompleteAndTheSame) {
    const Arguments film{"s.json", "-o", "a.##.exr", "--resume"};
    expect_done(film);
    const std::string first = bytes_of(file("a.00.exr")), second = bytes_of(file("a.01.exr"));
    const auto time_of = [&](const char* name) { return std::filesystem::last_write_time(file(name)); };
    const auto old = std::filesystem::file_time_type::clock::now() - std::chrono::hours(1);
    for (const char* name : {"a.00.exr", "a.01.exr", "a.02.exr"}) std::filesystem::last_write_time(file(name), old);

    put_bytes(file("a.01.exr"), second.substr(0, second.size() / 2));  // cut short
    std::filesystem::remove(file("a.02.exr"));
    const ProgramResult result = run(film);
    EXPECT_EQ(result.code, 0) << result.error;
    EXPECT_NE(result.error.find("1 of 3 frames are complete"), std::string::npos) << result.error;
    EXPECT_EQ(time_of("a.00.exr"), old);
    EXPECT_EQ(bytes_of(file("a.01.exr")), second);
    EXPECT_TRUE(exists("a.02.exr"));

    const auto rendered_again = [&](const Arguments& more) {
        for (const char* name : {"a.00.exr", "a.01.exr", "a.02.exr"}) std::filesystem::last_write_time(file(name), old);
        Arguments arguments = film;
        arguments.insert(arguments.end(), more.begin(), more.end());
        expect_done(arguments);
        return time_of("a.00.exr") != old;
    };
    EXPECT_FALSE(rendered_again({"--threads", "1"}));
    EXPECT_TRUE(rendered_again({"--depth", "3"}));
    EXPECT_FALSE(rendered_again({"--depth", "3"}));
    EXPECT_TRUE(rendered_again({"--bits", "half"}));
    EXPECT_TRUE(rendered_again({"--layers", "Z"}));
    EXPECT_TRUE(rendered_again({"--crop", "20x10+0+0"}));
    EXPECT_TRUE(rendered_again({"--preview", "a.##.png"}));
    EXPECT_FALSE(rendered_again({"--preview", "a.##.png"}));
    put_bytes(file("s.json"), std::string(scene_text).replace(std::string(scene_text).find("0.5, 0.1]"), 3, "0.4"));
    EXPECT_TRUE(rendered_again({}));
    EXPECT_NE(bytes_of(file("a.00.exr")), first);
}

TEST_F(RenderFilm, ResumeRemovesWhatDeadProgramsLeftOfCompleteFrames) {
    const Arguments film{"s.json", "-q",      "-f",    "0",        "-o", "a.exr",   "--preview",
                         "a.png",  "--split", "files", "--layers", "N",  "--resume"};
    expect_done(film);
    EXPECT_FALSE(has_part_files());
    for (const char* name : {"a.exr", "a.png", "a.N.exr"}) {
        ASSERT_TRUE(exists(name));
        for (const char* number : {"0", "1", "5"})
            put_bytes(file(std::string(".") + name + "." + number + ".part"), "");
    }
    expect_done(film);
    EXPECT_FALSE(has_part_files());
}

TEST_F(RenderFilm, ResumeSeesACameraThatChangedByLessThanAFloat) {
    const Arguments film{"s.json", "-q", "-o", "a.##.exr", "--resume"};
    expect_done(film);
    const LayeredPicture before = read_exr(file("a.00.exr"));
    put_bytes(
        file("s.json"),
        std::string(scene_text).replace(std::string(scene_text).find("\"fov\": 60"), 9, "\"fov\": 60.0000000000001"));
    expect_done(film);
    const LayeredPicture after = read_exr(file("a.00.exr"));
    for (const char* same : {"worldToCamera", "cistula:sceneHash"})
        EXPECT_EQ(before.attributes.at(same), after.attributes.at(same)) << same;
    EXPECT_NE(before.attributes.at("cistula:cameraHash"), after.attributes.at("cistula:cameraHash"));
    EXPECT_EQ(std::get<std::string>(after.attributes.at("cistula:cameraHash")).size(), 32u);
    const std::string bytes = bytes_of(file("a.00.exr"));
    expect_done({"s.json", "-q", "-o", "fresh.exr", "-f", "0"});
    EXPECT_EQ(bytes_of(file("fresh.exr")), bytes);
}

TEST_F(RenderFilm, AFileThatCannotBeWrittenLeavesTheOldOneWhole) {
    expect_done({"s.json", "-q", "-o", "a.exr"});
    const std::string old = bytes_of(file("a.exr"));
    ProgramResult result =
        RunningProgram(program_, {"s.json", "-q", "-o", "a.exr", "--res", "200x100", "--layers", "N,Z,id"}, file(""),
                       "",
                       [] {
                           const rlimit limit{4096, 4096};
                           setrlimit(RLIMIT_FSIZE, &limit);
                       })
            .wait();
    EXPECT_EQ(result.code, 3) << result.error;
    EXPECT_EQ(result.error.rfind("render: a.exr: ", 0), 0u) << result.error;
    EXPECT_EQ(bytes_of(file("a.exr")), old);
    EXPECT_FALSE(has_part_files());
    // A film ends at the first failure.
    std::filesystem::create_directory(file("f.01.exr"));
    result = run({"s.json", "-q", "-o", "f.##.exr"});
    EXPECT_EQ(result.code, 3) << result.error;
    EXPECT_NE(result.error.find("f.01.exr"), std::string::npos) << result.error;
    EXPECT_TRUE(exists("f.00.exr"));
    EXPECT_FALSE(exists("f.02.exr"));
}

TEST_F(RenderFilm, AnInterruptedFilmIsWholeAndGoesOn) {
    // More frames than are rendered between the appearance of the first and the signal, however quick the machine.
    const auto film = [](const char* to, int last) {
        return Arguments{
            "s.json", "-o", to, "--res", "160x100", "--supersample", "8", "-f", "0-" + std::to_string(last)};
    };
    const auto image = [&](const char* name, int frame) { return file(name + std::to_string(frame) + ".exr"); };
    put_bytes(file("a.9999.exr"), "the old file");
    RunningProgram running(program_, film("a.#.exr", 9999), file(""));
    ASSERT_TRUE(running.wait_until([&] { return exists("a.0.exr"); }, 300));
    running.send(SIGINT);
    const ProgramResult result = running.wait();
    EXPECT_EQ(result.code, 130) << result.error;
    const std::string interrupted = "render: interrupted; ";
    const size_t place = result.error.find(interrupted);
    ASSERT_NE(place, std::string::npos) << result.error;
    const int written = std::stoi(result.error.substr(place + interrupted.size()));
    EXPECT_NE(result.error.find(" of 10000 frames written"), std::string::npos) << result.error;
    EXPECT_NE(result.error.find("--resume"), std::string::npos) << result.error;
    for (int frame = 0; frame < written; ++frame) EXPECT_TRUE(exr_is_complete(image("a.", frame)));
    EXPECT_FALSE(std::filesystem::exists(image("a.", written)));
    EXPECT_EQ(bytes_of(file("a.9999.exr")), "the old file");
    EXPECT_FALSE(has_part_files());

    const auto first = std::filesystem::last_write_time(image("a.", 0));
    Arguments resumed = film("a.#.exr", written);
    resumed.push_back("--resume");
    expect_done(resumed);
    EXPECT_EQ(std::filesystem::last_write_time(image("a.", 0)), first);
    expect_done(film("b.#.exr", written));
    for (int frame = 0; frame <= written; ++frame)
        EXPECT_EQ(bytes_of(image("a.", frame)), bytes_of(image("b.", frame)));
}

TEST_F(RenderFilm, WhatIsRefusedAtAFrameEndsItWithItsNumber) {
    // V is "bad" at one frame, else "good". The first two are found by reading, the next as all frames are placed, the
    // last as the frame is compiled.
    const struct {
        const char *scene, *bad, *good, *place;
        bool renders;
    } cases[] = {
        {R"("objects": [{"quad": [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, V]], "material": "m"}])", "1", "0",
         "/objects/0/quad: ", false},
        {R"("camera": {"position": V}, "objects": [])", "[0, 0, 0]", "[0, -5, 0]", "/camera/target: ", false},
        {R"("objects": [{"disk": {"center": [0, 0, 0], "radius": 1, "normal": V}, "material": "m"}])", "[0, 0, 0]",
         "[0, 0, 1]", "/objects/0/disk/normal: ", false},
        {R"("objects": [{"solid": "cube", "material": "m"},
                        {"solid": "cube", "center": [1e6, 0, 0], "radius": V, "material": "m"}])",
         "1e-20", "1", "/objects/1: ", false},
        {R"("objects": [{"solid": "sphere", "material": "m"}], "lights": [{"position": V}])", "[1, 0, 0]", "[9, 0, 0]",
         "/lights/0: ", true},
    };
    for (const auto& [scene, bad, good, place, renders] : cases)
        for (const int at : {0, 2, 4}) {
            const std::string number = std::to_string(at), output = number + place[1] + std::to_string(renders);
            std::string text = R"({"film": {"width": 8, "height": 6, "frames": 5}, "materials": {"m": {}}, )" +
                               std::string(scene) + "}";
            text.replace(text.find('V'), 1,
                         std::string(R"({"interpolation": "step", "keys": [)") +
                             (at > 0 ? std::string("[0, ") + good + "], " : "") + "[" + number + ", " + bad + "], [" +
                             std::to_string(at + 1) + ", " + good + "]]}");
            put_bytes(file("bad.json"), text);
            std::filesystem::remove_all(file("film"));
            Arguments film{"bad.json", "-q", "-o", "film/#.exr"};
            const std::string line = "frame " + number + ": bad.json: " + place;
            expect_refused(film, ExitCode::usage, line);
            for (int frame = 0; frame < 5; ++frame) {
                const std::string image = "film/" + std::to_string(frame) + ".exr";
                EXPECT_EQ(exists(image), renders && frame < at) << line << image;
                EXPECT_TRUE(!exists(image) || exr_is_complete(file(image))) << image;
            }
            film.push_back("--resume");
            expect_refused(film, ExitCode::usage, line);
        }
}

TEST_F(RenderFilm, SigtermStopsAStillAndTheOldFileStays) {
    put_bytes(file("a.exr"), "the old file");
    RunningProgram running(program_, {"s.json", "-v", "-o", "a.exr", "--res", "4000x3000", "--supersample", "8"},
                           file(""));
    ASSERT_TRUE(running.wait_until([&] { return running.error_so_far().find("scene hash") != std::string::npos; }, 60));
    running.send(SIGTERM);
    const ProgramResult result = running.wait();
    EXPECT_EQ(result.code, 130) << result.error;
    EXPECT_NE(result.error.find("render: interrupted"), std::string::npos) << result.error;
    EXPECT_EQ(bytes_of(file("a.exr")), "the old file");
    EXPECT_FALSE(has_part_files());
}

TEST_F(RenderFilm, TreesWithoutEndAreInterruptedToo) {
    expect_interrupted_within_a_pixel({});
}

}  // namespace
}  // namespace cistula
