// render-verify: options, exit codes, records; what cases judge; and that docs/cases names every case.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <functional>
#include <new>
#include <nlohmann/json.hpp>
#include <set>

#include "apps/common/command_line.h"
#include "apps/render_verify/program.h"
#include "testing/support/gpu.h"
#include "testing/support/run_program.h"
#include "verify/case.h"
#include "verify/cases/scenes.h"

namespace cistula::verify {
namespace {

using Arguments = std::vector<std::string>;

// ---- cases made for these tests

/// Calls what a test puts here.
std::function<void(uint64_t i, Tally&)> each_ray;
uint64_t ray_count = 10;

struct EachRay {
    template <class Real, class Tracer>
    void operator()(const Setup<Real>&, const Tracer&, uint64_t i, Tally& tally) const {
        each_ray(i, tally);
    }
};
/// One ray differs when it is asked of for the third time: by the tree of our own, after the plain loop and Embree.
struct Word {
    static inline std::atomic<int> asked = 0;
    template <class Real, class Tracer>
    uint64_t fingerprint(const Setup<Real>&, const Tracer&, uint64_t i) const {
        return i == 7 && ++asked == 4 ? 1 : 0;
    }
};

template <class Functor>
void add_cube(Plan& plan) {
    SceneDescription scene = empty_scene();
    add_object(scene, solid_object(PlatonicSolid::cube));
    plan.add("a cube", scene, Functor{}, {}, ray_count);
}
template <class Functor = EachRay>
Case of_rays(const char* name, const Bound& bound, void (*plan)(Plan&) = add_cube<Functor>) {
    Cases cases;
    cases.rays<Functor, false>(name, "what the test says", bound, plan);
    return cases.all[0];
}
Case of_images(const char* name, const char* exact, void (*render)(Stage&, Tally&)) {
    Cases cases;
    cases.images(name, exact, no_failures("pixels"), render);
    return cases.all[0];
}

const Case counts = of_rays("made/counts", no_failures("rays")), broken = of_rays("made/broken", must_fail(3, "rays")),
           measures = of_rays("made/measures", at_most(2, "ulps")),
           witnessed = of_rays("made/witnessed", no_failures("rays", needs_witness)),
           compared = of_rays<Word>("made/compared", no_failures("rays"));
/// A cube beside one that is 2^-20 of its size, and a cube alone.
bool with_tiny = true, with_alone = true;
const Case warns = of_rays("made/warns", no_failures("rays", float_warns), [](Plan& plan) {
    if (with_alone) add_cube<EachRay>(plan);
    SceneDescription scene = empty_scene();
    add_object(scene, solid_object(PlatonicSolid::cube));
    add_object(scene, solid_object(PlatonicSolid::cube, {3, 0, 0}, with_tiny ? 0x1p-20 : 1));
    plan.add("two cubes", scene, EachRay{}, {}, ray_count);
});
const Case images = of_images("made/images", "a cube covers the middle of the picture", [](Stage& stage, Tally& tally) {
    SceneDescription scene = empty_scene();
    add_object(scene, solid_object(PlatonicSolid::cube));
    const Film film = stage.render(scene, 9, 9);
    tally.expect(film.flags == 0 && film.pixels[40].hits == 1 && film.pixels[0].hits == 0);
});
/// Memory runs out while a case of images runs, and while one of rays is planned.
const Case starved = of_images("made/starved", "nothing", [](Stage&, Tally&) { throw std::bad_alloc(); });
const Case starved_plan = of_rays("made/starved-plan", no_failures("rays"), [](Plan&) { throw std::bad_alloc(); });

/// The exit code of a run over one case, and its record.
int code_of(const Case& one, nlohmann::json* record = nullptr, Arguments more = {}) {
    const ScratchDirectory folder;
    const std::string file = folder.file("record.json");
    more.insert(more.begin(), {"render-verify", "--json", file});
    std::vector<const char*> argv;
    for (const std::string& argument : more) argv.push_back(argument.c_str());
    const std::vector<Case> table{one};
    const int code = run_program("render-verify", "allow it more",
                                 [&] { return verify_program(int(argv.size()), argv.data(), &table); });
    if (record) *record = nlohmann::json::parse(bytes_of(file));
    return code;
}

// ---- the library

/// A case measures the draws of its rays.
struct Drawn {
    template <class Real, class Tracer>
    void operator()(const Setup<Real>& setup, const Tracer&, uint64_t i, Tally& tally) const {
        tally.measure(setup.draw(i).template unit<double>());
    }
};
void add_drawn(Plan& plan) {
    SceneDescription scene = empty_scene();
    add_object(scene, solid_object(PlatonicSolid::cube));
    plan.add("a cube", scene, Drawn{}, {}, plan.rays(10, 10));
}

/// Options for a table of cases, on one intersector in one precision.
Options options_of(const std::vector<Case>& table) {
    Options options;
    options.table = &table;
    options.intersectors = {IntersectorKind::bvh};
    options.precisions = {Precision::double_};
    return options;
}

TEST(Verify, AFunctionTellsRowsAndEvents) {
    each_ray = [](uint64_t i, Tally& tally) { tally.expect(i != 3); };
    const std::vector<Case> table{counts, measures, broken};
    Options options = options_of(table);
    options.cases = {"made/counts", "made/b*"};
    std::vector<std::string> begun, finished;
    options.begun = [&](const std::string& name) { begun.push_back(name); };
    options.finished = [&](const Row& row) { finished.push_back(row.complaint); };
    RenderProgress progress;
    const std::vector<Row> rows = run(options, progress);
    EXPECT_EQ(begun, (std::vector<std::string>{"made/counts", "made/broken"}));
    EXPECT_EQ(finished, (std::vector<std::string>{"1 of 10 failed; first: a cube, ray 3",
                                                  "what is broken on purpose is not caught"}));
    ASSERT_EQ(rows.size(), 2u);
    EXPECT_EQ(rows[0].name, "made/counts");
    EXPECT_EQ(rows[0].group, "made");
    EXPECT_EQ(rows[0].exact, "what the test says");
    EXPECT_EQ(rows[0].intersector, IntersectorKind::bvh);
    EXPECT_EQ(rows[0].precision, Precision::double_);
    EXPECT_EQ(rows[0].measured, 1);
    EXPECT_EQ(rows[0].bound, 0);
    EXPECT_FALSE(rows[0].holds());
    EXPECT_TRUE(rows[1].must_fail);
    EXPECT_EQ(rows[1].bound, 3);
}

TEST(Verify, ASeedChangesTheDrawsAndAScaleTheirNumber) {
    const std::vector<Case> table{of_rays<Drawn>("made/drawn", at_most(1, "draws"), add_drawn)};
    const auto row_with = [&](uint64_t seed, uint32_t scale) {
        Options options = options_of(table);
        options.seed = seed;
        options.scale = scale;
        RenderProgress progress;
        return run(options, progress).at(0);
    };
    EXPECT_EQ(row_with(0, 1).measured, row_with(0, 1).measured);
    EXPECT_NE(row_with(0, 1).measured, row_with(1, 1).measured);
    EXPECT_EQ(row_with(0, 1).tried, 10u);
    EXPECT_EQ(row_with(0, 3).tried, 30u);
}

TEST(Verify, AStopEndsTheRunAmongTheRaysOfACase) {
    RenderProgress progress;
    each_ray = [&](uint64_t i, Tally& tally) {
        tally.expect(true);
        if (i == 3) progress.stop = true;
    };
    const std::vector<Case> table{counts, broken};
    Options options = options_of(table);
    options.finished = [](const Row&) { ADD_FAILURE() << "a row of a case that was stopped"; };
    try {
        run(options, progress);
        ADD_FAILURE() << "not stopped";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::interrupted);
    }
}

TEST(Verify, MemoryThatRunsOutEndsTheProgramAndFailsNoCase) {
    for (const Case* one : {&starved, &starved_plan}) {
        testing::internal::CaptureStderr();
        EXPECT_EQ(code_of(*one), 1);
        EXPECT_EQ(testing::internal::GetCapturedStderr(), "render-verify: out of memory; allow it more\n");
    }
}

TEST(Verify, AFailingRayIsExitCode1AndNamed) {
    each_ray = [](uint64_t, Tally& tally) { tally.expect(true); };
    EXPECT_EQ(code_of(counts), 0);
    each_ray = [](uint64_t i, Tally& tally) { tally.expect(i < 6); };
    nlohmann::json record;
    EXPECT_EQ(code_of(counts, &record), 1);
    ASSERT_EQ(record["cases"].size(), 8u);  // four intersectors, two precisions
    for (const auto& one : record["cases"]) {
        EXPECT_EQ(one["case"], "made/counts");
        EXPECT_EQ(one["holds"], false);
        EXPECT_EQ(one["worst"], 4);
        EXPECT_EQ(one["bound"], 0);
        EXPECT_EQ(one["tried"], 10);
        EXPECT_EQ(one["unit"], "rays");
        EXPECT_EQ(one["worst_at"], "a cube, ray 6");
    }
    EXPECT_EQ(record["cases"][0]["intersector"], "embree");
    EXPECT_EQ(record["cases"][0]["precision"], "float");
    for (const char* key : {"cpu", "compiler", "flags", "commit"}) EXPECT_TRUE(record["context"].contains(key)) << key;
}

TEST(Verify, NothingTriedAndThrownErrorsDoNotHold) {
    each_ray = [](uint64_t, Tally&) {};
    EXPECT_EQ(code_of(counts), 1);
    each_ray = [](uint64_t i, Tally& tally) {
        tally.expect(true);
        if (i == 3) throw std::runtime_error("broken <case>");
    };
    nlohmann::json record;
    EXPECT_EQ(code_of(counts, &record), 1);
    EXPECT_EQ(record["cases"][0]["complaint"], "broken <case>");
}

TEST(Verify, FloatWarnsOfScenesWithPartsTooSmallForItAndHoldsInOthers) {
    each_ray = [](uint64_t, Tally& tally) { tally.expect(true); };
    nlohmann::json record;
    EXPECT_EQ(code_of(warns, &record), 0);
    for (const auto& one : record["cases"]) {
        const bool in_float = one["precision"] == "float";
        EXPECT_EQ(one["tried"], in_float ? 10 : 20);
        EXPECT_EQ(one.value("scenes_warned_of", 0), in_float ? 1 : 0);
    }
    each_ray = [](uint64_t i, Tally& tally) { tally.expect(i != 3); };
    EXPECT_EQ(code_of(warns, nullptr, {"--precision", "float"}), 1);  // the cube alone must hold
    with_alone = false;
    EXPECT_EQ(code_of(warns, nullptr, {"--precision", "float"}), 0);
    EXPECT_EQ(code_of(warns, nullptr, {"--precision", "double"}), 1);
    with_tiny = false;
    each_ray = [](uint64_t, Tally& tally) { tally.expect(true); };
    EXPECT_EQ(code_of(warns, &record, {"--precision", "float"}), 1);
    EXPECT_EQ(record["cases"][0]["complaint"], "float does not warn");
    with_tiny = with_alone = true;
}

TEST(Verify, WhatIsBrokenOnPurposeMustFail) {
    each_ray = [](uint64_t i, Tally& tally) { tally.expect(i >= 3); };
    EXPECT_EQ(code_of(broken), 0);
    each_ray = [](uint64_t i, Tally& tally) { tally.expect(i >= 2); };
    EXPECT_EQ(code_of(broken), 1);
}

TEST(Verify, MeasuredDeviationsStandAgainstTheBound) {
    each_ray = [](uint64_t i, Tally& tally) { tally.measure(i == 4 ? 2 : 0.5); };
    nlohmann::json record;
    EXPECT_EQ(code_of(measures, &record), 0);
    EXPECT_EQ(record["cases"][0]["worst"], 2);
    each_ray = [](uint64_t i, Tally& tally) { tally.measure(i == 4 ? 2.0000001 : 0.5); };
    EXPECT_EQ(code_of(measures), 1);
    each_ray = [](uint64_t i, Tally& tally) { tally.measure(i == 4 ? NAN : 0.5); };
    EXPECT_EQ(code_of(measures, &record), 1);
    EXPECT_EQ(record["cases"][0]["worst"], "inf");
    each_ray = [](uint64_t i, Tally& tally) { i == 4 ? tally.expect(false) : tally.measure(0); };
    EXPECT_EQ(code_of(measures), 1);
}

TEST(Verify, AHazardThatIsNeverMetProvesNothing) {
    each_ray = [](uint64_t i, Tally& tally) { tally.expect(true), tally.witness(i == 9); };
    EXPECT_EQ(code_of(witnessed), 0);
    each_ray = [](uint64_t, Tally& tally) { tally.expect(true), tally.witness(false); };
    EXPECT_EQ(code_of(witnessed), 1);
}

TEST(Verify, IntersectorsThatDifferAreFound) {
    nlohmann::json record;
    EXPECT_EQ(code_of(compared, &record, {"--precision", "double"}), 1);
    ASSERT_EQ(record["cases"].size(), 4u);
    for (const auto& one : record["cases"]) EXPECT_EQ(one["failures"], one["intersector"] == "bvh" ? 1 : 0);
    EXPECT_EQ(record["cases"][2]["worst_at"], "a cube, ray 7");
}

TEST(Verify, ImagesComeFromEveryIntersector) {
    nlohmann::json record;
    EXPECT_EQ(code_of(images, &record), 0);
    ASSERT_EQ(record["cases"].size(), 8u);
}

TEST(Verify, TalliesDoNotDependOnTheOrder) {
    const auto tally = [](uint64_t place, double deviation) {
        Tally t;
        t.place = place;
        t.measure(deviation);
        return t;
    };
    const Tally parts[] = {tally(5, 1), tally(3, 2), tally(2, 2), tally(9, 0.5)};
    std::vector<int> order{0, 1, 2, 3};
    do {
        Tally all;
        for (const int i : order) all.merge(parts[i]);
        EXPECT_EQ(all.tried, 4u);
        EXPECT_EQ(all.worst, 2);
        EXPECT_EQ(all.worst_at, 2u);
    } while (std::next_permutation(order.begin(), order.end()));
}

// ---- the built program

class RenderVerify : public testing::Test {
  protected:
    std::string file(const std::string& name) const { return folder_.file(name); }
    ProgramResult run(const Arguments& arguments) const {
        return RunningProgram(CISTULA_BIN_DIR "/render-verify", arguments, file("")).wait();
    }
    void expect_refused(const Arguments& arguments, ExitCode code, const std::string& part) const {
        const ProgramResult result = run(arguments);
        EXPECT_EQ(result.code, static_cast<int>(code)) << result.error;
        EXPECT_EQ(result.error.rfind("render-verify: ", 0), 0u) << result.error;
        EXPECT_EQ(std::count(result.error.begin(), result.error.end(), '\n'), 1) << result.error;
        EXPECT_NE(result.error.find(part), std::string::npos) << result.error;
        EXPECT_EQ(result.out, "");
    }

    const ScratchDirectory folder_;
};

TEST_F(RenderVerify, RefusesWhatItDoesNotKnow) {
    expect_refused({"--case", "geometry/fanz"}, ExitCode::usage, "did you mean 'geometry/fans'?");
    expect_refused({"--case", "*nothing*"}, ExitCode::usage, "no such case");
    expect_refused({"--backend", "embre"}, ExitCode::usage, "did you mean 'embree'?");
    expect_refused({"--precision", "half"}, ExitCode::usage, "must be float or double or both");
    expect_refused({"--lanes", "17"}, ExitCode::usage, "--lanes");
    expect_refused({"--quik"}, ExitCode::usage, "did you mean '--quick'?");
    expect_refused({"geometry/fans"}, ExitCode::usage, "--case");
    expect_refused({"--json", "a", "--html", "./a"}, ExitCode::usage, "both --json and --html");
    expect_refused({"--quick", "--case", "geometry/fans", "--json", "no/such/folder/a.json"}, ExitCode::file, "a.json");
}

TEST_F(RenderVerify, ABackendThatIsNotThereIsAnError) {
    if (test::missing_gpu().empty()) GTEST_SKIP() << "this machine has a GPU";
    for (const char* backend : {"cuda", "all"})
        expect_refused({"--backend", backend, "--quick", "--case", "geometry/fans"}, ExitCode::device, "");
}

TEST_F(RenderVerify, AnInterruptedRunSaysSoAndWritesNothing) {
    RunningProgram running(CISTULA_BIN_DIR "/render-verify", {"--case", "mirrors/*", "--json", "a.json"}, file(""));
    ASSERT_TRUE(running.wait_until([&] { return !running.output_so_far().empty(); }, 60));
    running.send(SIGINT);
    const ProgramResult result = running.wait();
    EXPECT_EQ(result.code, 130) << result.error;
    EXPECT_EQ(result.error, "render-verify: interrupted; nothing was written\n");
    EXPECT_FALSE(std::filesystem::exists(file("a.json")));
}

TEST_F(RenderVerify, HelpShowsEveryOptionAsItIsWritten) {
    const ProgramResult help = run({"--help"});
    EXPECT_EQ(help.code, 0) << help.error;
    EXPECT_NE(help.out.find("--precision NAME"), std::string::npos) << help.out;
    EXPECT_EQ(help.out.find_first_of("{}"), std::string::npos) << help.out;
}

TEST_F(RenderVerify, LanesAreJudgedWhereThereAreAny) {
    const Arguments arguments{"--quick", "--case", "geometry/axis-parallel"};
    const auto with = [&](const char* lanes) {
        Arguments more = arguments;
        more.insert(more.end(), {"--lanes", lanes});
        return run(more).out;
    };
    EXPECT_NE(with("8").find(" lanes "), std::string::npos);
    EXPECT_EQ(with("1").find(" lanes "), std::string::npos);
}

TEST_F(RenderVerify, WritesATableARecordAndAPage) {
    const ProgramResult result = run({"--quick", "--case", "geometry/axis-parallel", "--case", "geometry/broken/*",
                                      "--precision", "double", "--json", "a.json", "--html", "a.html"});
    EXPECT_EQ(result.code, 0) << result.out << result.error;
    EXPECT_NE(result.out.find("geometry/axis-parallel"), std::string::npos);
    EXPECT_NE(result.out.find("all 7 hold"), std::string::npos) << result.out;
    const auto record = nlohmann::json::parse(bytes_of(file("a.json")));
    EXPECT_EQ(record["context"]["quick"], true);
    ASSERT_EQ(record["cases"].size(), 7u);
    for (const auto& one : record["cases"]) {
        EXPECT_EQ(one["holds"], true);
        EXPECT_EQ(one["precision"], "double");
    }
    const std::string page = bytes_of(file("a.html"));
    EXPECT_NE(page.find("geometry/axis-parallel"), std::string::npos);
    EXPECT_NE(page.find("prefers-color-scheme: dark"), std::string::npos);
    for (const char* loaded : {"http", "<script", "src=", "url(", "@import", "<link"})
        EXPECT_EQ(page.find(loaded), std::string::npos) << loaded;
}

/// The hard cases, on the host's intersectors, in both precisions.
TEST_F(RenderVerify, TheQuickRunHoldsAndWarnsInFloatAlone) {
    const ProgramResult result = run({"--quick", "--json", "all.json"});
    std::printf("%s", result.out.c_str());
    const auto record = nlohmann::json::parse(bytes_of(file("all.json")));
    std::set<std::string> cases, warned;
    for (const auto& one : record["cases"]) {
        cases.insert(one["case"].get<std::string>());
        EXPECT_EQ(one["holds"], true) << one.dump();
        if (!one.contains("scenes_warned_of")) continue;
        warned.insert(one["case"].get<std::string>());
        EXPECT_EQ(one["precision"], "float");
    }
    EXPECT_EQ(cases.size(), all_cases().size());
    EXPECT_GE(warned.size(), 4u);
    EXPECT_EQ(result.code, 0);
}

TEST_F(RenderVerify, RunsGiveTheSameNumbersAgain) {
    const Arguments arguments{"--quick", "--case", "geometry/broken/", "--json"};
    const auto numbers = [&](const std::string& name) {
        Arguments more = arguments;
        more.push_back(name);
        EXPECT_EQ(run(more).code, 0);
        auto record = nlohmann::json::parse(bytes_of(file(name)));
        for (auto& one : record["cases"]) one.erase("seconds");
        return record["cases"];
    };
    EXPECT_EQ(numbers("a.json"), numbers("b.json"));
}

TEST_F(RenderVerify, ListsItsCases) {
    const ProgramResult result = run({"--list"});
    EXPECT_EQ(result.code, 0);
    EXPECT_EQ(size_t(std::count(result.out.begin(), result.out.end(), '\n')), all_cases().size());
}

// ---- docs/cases

/// The pages of hazards, one after the other.
std::string hazard_pages() {
    std::string text;
    for (const auto& entry : std::filesystem::directory_iterator(CISTULA_SOURCE_DIR "/docs/cases"))
        text += bytes_of(entry.path().string());
    return text;
}

/// Names of cases in the fourth column of the pages' tables.
std::multiset<std::string> documented_cases() {
    std::multiset<std::string> names;
    std::istringstream text(hazard_pages());
    for (std::string line; std::getline(text, line);) {
        if (line.rfind("| ", 0) != 0) continue;
        std::vector<std::string> cells;
        for (size_t begin = 1; begin < line.size();) {
            const size_t end = std::min(line.find('|', begin), line.size());
            cells.push_back(line.substr(begin, end - begin));
            begin = end + 1;
        }
        if (cells.size() < 5 || cells[3].find('`') == std::string::npos) continue;
        EXPECT_EQ(cells.size(), 5u) << line;
        for (size_t open = cells[3].find('`'); open != std::string::npos; open = cells[3].find('`', open)) {
            const size_t close = cells[3].find('`', open + 1);
            names.insert(cells[3].substr(open + 1, close - open - 1));
            open = close + 1;
        }
        // What a row says lives somewhere does live there.
        for (size_t open = cells[2].find('`'); open != std::string::npos; open = cells[2].find('`', open)) {
            const size_t close = cells[2].find('`', open + 1);
            const std::string path = cells[2].substr(open + 1, close - open - 1);
            const std::string root = CISTULA_SOURCE_DIR "/";
            EXPECT_TRUE(std::filesystem::exists(root + path) || std::filesystem::exists(root + "libcore/" + path))
                << path;
            open = close + 1;
        }
    }
    return names;
}

TEST(HazardPages, NamesEveryCaseAndNoOther) {
    const std::multiset<std::string> documented = documented_cases();
    std::set<std::string> existing;
    for (const Case& one : all_cases()) {
        EXPECT_TRUE(existing.insert(one.name).second) << one.name << " exists twice";
        EXPECT_GE(documented.count(one.name), 1u) << one.name << " is not in docs/cases";
        EXPECT_EQ(one.plan == nullptr, one.render != nullptr) << one.name;
    }
    for (const std::string& name : documented)
        EXPECT_TRUE(existing.count(name) != 0) << name << " in docs/cases is no case of render-verify";
    EXPECT_GE(existing.size(), 20u);
}

}  // namespace
}  // namespace cistula::verify
