// What `render` tells other programs while it renders: records of its progress, and snapshots when SIGUSR1 asks.
#include <gtest/gtest.h>

#include <sstream>

#include <nlohmann/json.hpp>

#include "apps/common/progress_record.h"
#include "image/exr/exr.h"
#include "testing/support/render_program.h"

namespace cistula {
namespace {

using Json = nlohmann::json;

std::vector<Json> records_in(const std::string& text) {
    std::vector<Json> records;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) records.push_back(Json::parse(line));
    return records;
}

std::string first_word(const std::string& line) {
    return line.substr(0, line.find(' '));
}

TEST(ProgressRecord, TellsTheShareOfTheFilmAndWhatIsLeft) {
    const ProgressState state{12, 1, 4, 0.5, 3, 2e6};
    const Json json = Json::parse(state_record(ProgressStyle::json, state));
    EXPECT_EQ(json, Json::parse(R"({"event": "progress", "frame": 12, "fraction": 0.5, "film_fraction": 0.375,
                                    "rays_per_second": 2e6, "eta": 5.0})"));
    EXPECT_EQ(state_record(ProgressStyle::openjd, state),
              "openjd_progress: 37.50\nopenjd_status: frame 12 (2/4): 50 %, 2.0 Mrays/s, ETA 0:05");
    EXPECT_TRUE(Json::parse(state_record(ProgressStyle::json, ProgressState())).at("eta").is_null());
    EXPECT_EQ(state_record(ProgressStyle::plain, state), "");
}

TEST(ProgressRecord, IsOneLineWhateverTheNames) {
    const std::string json = event_record(ProgressStyle::json, {"written", 3, "a\n\xff\"b.exr"}, ProgressState());
    EXPECT_EQ(json.find('\n'), std::string::npos);
    EXPECT_EQ(Json::parse(json).at("file"), "a\n\xef\xbf\xbd\"b.exr");
    EXPECT_EQ(failure_record(ProgressStyle::openjd, "a\nb", ExitCode::file), "openjd_fail: a\\nb");
    EXPECT_EQ(first_word(failure_record(ProgressStyle::openjd, "missed", ExitCode::target)), "openjd_status:");
}

TEST_F(RenderProgram, TellsAFilmInJson) {
    for (const bool quiet : {false, true}) {
        Arguments arguments{"s.json", "-o", "f.#.exr", "-f", "0-2", "--progress", "json"};
        if (quiet) arguments.push_back("-q");
        const ProgramResult result = run(arguments);
        ASSERT_EQ(result.code, 0) << result.error;
        EXPECT_EQ(result.error.empty(), quiet);
        std::vector<std::string> written;
        std::vector<int> begun;
        double fraction = 0;
        const std::vector<Json> records = records_in(result.out);
        for (const Json& record : records) {
            if (record.at("event") == "written") written.push_back(record.at("file"));
            if (record.at("event") == "frame") begun.push_back(record.at("frame"));
            if (record.at("event") != "progress") continue;
            EXPECT_GE(record.at("film_fraction"), fraction);
            fraction = record.at("film_fraction");
        }
        EXPECT_EQ(records.front(), Json::parse(R"({"event": "read", "files": []})"));
        EXPECT_EQ(records[1], Json::parse(R"({"event": "begin", "frames": 3})"));
        EXPECT_EQ(records.back().at("event"), "end");
        EXPECT_EQ(written, (std::vector<std::string>{"f.0.exr", "f.1.exr", "f.2.exr"}));
        EXPECT_EQ(begun, (std::vector<int>{0, 1, 2}));
        EXPECT_EQ(fraction, 1);
    }
    const ProgramResult again = run({"s.json", "-o", "f.#.exr", "-f", "0-3", "--resume", "--progress", "json"});
    std::vector<int> kept;
    for (const Json& record : records_in(again.out))
        if (record.at("event") == "kept") kept.push_back(record.at("frame"));
    EXPECT_EQ(kept, (std::vector<int>{0, 1, 2}));
}

TEST_F(RenderProgram, TellsAFilmInTheMessagesOfOpenJobDescription) {
    const ProgramResult result = run({"s.json", "-o", "f.#.exr", "-f", "0-1", "--progress", "openjd"});
    ASSERT_EQ(result.code, 0) << result.error;
    std::istringstream lines(result.out);
    std::string last;
    for (std::string line; std::getline(lines, line); last = line) {
        const std::string word = first_word(line);
        EXPECT_TRUE(word == "openjd_progress:" || word == "openjd_status:") << line;
        if (word == "openjd_progress:") {
            const double percent = std::stod(line.substr(word.size()));
            EXPECT_TRUE(percent >= 0 && percent <= 100) << line;
        }
    }
    EXPECT_EQ(last, "openjd_status: 2 of 2 frames written");
}

TEST_F(RenderProgram, TellsProgramsOfErrors) {
    const ProgramResult json = run({"none.json", "--progress", "json"});
    EXPECT_EQ(json.code, 3);
    EXPECT_EQ(records_in(json.out).at(0).at("exit_code"), 3);
    const std::vector<Arguments> wrong = {{"--layers", "foo"}, {"--depth", "0"}, {"-f", "x"},  {"--nope"},
                                          {"--json", "-"},     {"more.json"},    {"--explain"}};
    for (const Arguments& more : wrong) {
        Arguments words = {"s.json", "--progress", "json"};
        words.insert(words.end(), more.begin(), more.end());
        const auto record = nlohmann::json::parse(run(words).out);
        EXPECT_EQ(record.at("event"), "error");
        EXPECT_EQ(record.at("exit_code"), 2);
        words.insert(words.begin(), "--progress=openjd");
        words.erase(words.begin() + 2, words.begin() + 4);
        EXPECT_EQ(run(words).out.rfind("openjd_fail: ", 0), 0u);
    }
    const ProgramResult openjd = run({"none.json", "--progress", "openjd"});
    EXPECT_EQ("render: " + openjd.out.substr(openjd.out.find(' ') + 1), openjd.error);
}

TEST_F(RenderProgram, ProgressThatNobodyReadsChangesNothing) {
    const ProgramResult result =
        RunningProgram(program_, {"s.json", "-o", "f.exr", "--progress", "json"}, file(""), "", [] {
            int ends[2];
            if (pipe(ends) != 0 || close(ends[0]) != 0 || dup2(ends[1], 1) < 0) _exit(9);
        }).wait();
    EXPECT_EQ(result.code, 0) << result.error;
    EXPECT_TRUE(exists("f.exr"));
}

TEST_F(RenderProgram, SnapshotsShowWhatIsDoneAndLeaveTheFrameAsItIs) {
    Arguments frame{"s.json",        "-v", "-o", "f.exr", "--res", "320x192", "--layers", "Z,id,cryptomatte,path",
                    "--supersample", ""};
    // Frames of ever more samples, until one takes long enough to be asked for a snapshot.
    ProgramResult result;
    for (int samples = 5; samples <= 160 && !exists("f.snapshot.exr"); samples *= 2) {
        frame.back() = std::to_string(samples);
        RunningProgram running(program_, frame, file(""));
        const auto said = [&](const char* what) { return running.error_so_far().find(what) != std::string::npos; };
        ASSERT_TRUE(running.wait_until([&] { return said("scene hash"); }, 60));
        running.wait_until(
            [&] {
                running.send(SIGUSR1);
                return said("snapshot of frame 0 at ");
            },
            60);
        result = running.wait();
        ASSERT_EQ(result.code, 0) << result.error;
    }
    EXPECT_NE(result.error.find("render: snapshot of frame 0 at "), std::string::npos) << result.error;
    EXPECT_NE(result.error.find(" %: f.snapshot.exr\n"), std::string::npos) << result.error;

    LayeredPicture snapshot = read_exr(file("f.snapshot.exr"));
    const LayeredPicture whole = read_exr(file("f.exr"));
    const double fraction = std::get<double>(snapshot.attributes.at("cistula:snapshot"));
    EXPECT_TRUE(fraction > 0 && fraction < 1) << fraction;
    snapshot.attributes.erase("cistula:snapshot");
    EXPECT_TRUE(snapshot.attributes == whole.attributes);
    const std::vector<float>* alpha = nullptr;
    for (const auto& channel : snapshot.channels)
        if (channel.name == "A") alpha = &channel.values;
    size_t done = 0;
    for (const float a : *alpha) done += a == 1;
    EXPECT_EQ(static_cast<double>(done) / static_cast<double>(alpha->size()), fraction);
    ASSERT_EQ(snapshot.channels.size(), whole.channels.size());
    for (size_t c = 0; c < whole.channels.size(); ++c)
        for (size_t i = 0; i < alpha->size(); ++i)
            ASSERT_EQ(snapshot.channels[c].values[i], (*alpha)[i] == 1 ? whole.channels[c].values[i] : 0)
                << whole.channels[c].name << " of pixel " << i;

    Arguments undisturbed = frame;
    undisturbed[3] = "g.exr";
    expect_done(undisturbed);
    EXPECT_EQ(bytes_of(file("f.exr")), bytes_of(file("g.exr")));
}

TEST_F(RenderProgram, SaysWhyThereIsNoSnapshot) {
    put_bytes(file("room.json"), test::room_of_mirrors_text);
    RunningProgram running(program_, {"room.json", "-v", "-o", "room.exr", "--depth", "256"}, file(""));
    ASSERT_TRUE(running.wait_until([&] { return running.error_so_far().find("scene hash") != std::string::npos; }, 60));
    EXPECT_TRUE(running.wait_until(
        [&] {
            running.send(SIGUSR1);
            std::this_thread::sleep_for(std::chrono::milliseconds(100));
            return running.error_so_far().find("no snapshot") != std::string::npos;
        },
        60));
    running.send(SIGTERM);
    EXPECT_EQ(running.wait().code, 130);
    EXPECT_FALSE(exists("room.exr"));
    expect_refused({"s.json", "-o", "f.exr", "--stats", "f.snapshot.exr"}, ExitCode::usage, "and a snapshot");
}

}  // namespace
}  // namespace cistula
