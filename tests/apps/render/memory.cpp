// Renders whose memory runs out: one line and exit code 1, unless a library cannot bear it, and no file that is not
// whole.
#include <cmath>
#include <csignal>
#include <map>

#include "testing/support/render_program.h"

namespace cistula {
namespace {

class RenderMemory : public RenderProgram {
  protected:
    RenderMemory() {
        const Arguments film = {"s.json",    "-q",          "-o",       "whole.#.exr",
                                "--preview", "whole.#.png", "--layers", "error,id"};
        expect_done(film);
    }

    void SetUp() override {
        if (needs_all_memory) GTEST_SKIP() << "the sanitizer needs memory and malloc for itself";
    }

    ProgramResult run_with(const Arguments& arguments, const std::function<void()>& prepare) const {
        return RunningProgram(program_, arguments, file(""), "",
                              [&] {
                                  alarm(60);  // ends what hangs
                                  prepare();
                              })
            .wait();
    }

    enum class End { rendered, told, by_signal };

    /// How a film of three frames ends. What the film before it left goes first: a run that a signal ended leaves
    /// ".f.0.exr.0.part".
    End end_of_film(const std::function<void()>& prepare) const {
        for (const std::string& name : folder_.names())
            if (name.starts_with("f.") || name.starts_with(".f.")) std::filesystem::remove(file(name));
        const ProgramResult result = run_with({"s.json", "-q", "--threads", "4", "-o", "f.#.exr", "--preview",
                                               "f.#.png", "--layers", "error,id", "--stats", "f.json"},
                                              prepare);
        const bool is_done = result.code == 0, is_told = result.code == 1;
        const bool by_signal = result.code == 1000 + SIGABRT || result.code == 1000 + SIGSEGV;
        EXPECT_TRUE(is_done || is_told || by_signal) << result.code << " " << result.error;
        // A thread of a library may end the process while the main thread tells why it ends it, too.
        if (!by_signal && result.error.find("terminate called") == std::string::npos) {
            EXPECT_EQ(std::count(result.error.begin(), result.error.end(), '\n'), is_done ? 0 : 1) << result.error;
            EXPECT_EQ(result.error.find("bad_alloc"), std::string::npos) << result.error;
            EXPECT_FALSE(has_part_files());
        }
        for (const char* number : {"0", "1", "2"})
            for (const char* kind : {".exr", ".png"}) {
                const std::string name = std::string("f.") + number + kind;
                EXPECT_TRUE(exists(name) || !is_done) << name;
                if (exists(name)) {
                    EXPECT_EQ(bytes_of(file(name)), bytes_of(file(std::string("whole.") + number + kind))) << name;
                }
            }
        return is_done ? End::rendered : is_told ? End::told : End::by_signal;
    }
};

TEST_F(RenderMemory, AnyLimitLeavesFilesWhole) {
    const auto limit_to = [](rlim_t size) {
        return [size] {
            const rlimit limit{size, size};
            setrlimit(RLIMIT_AS, &limit);
        };
    };
    constexpr rlim_t step = 3 << 20;
    rlim_t least = 16 * step;  // with which the libraries load
    while (run_with({"--version"}, limit_to(least)).code != 0 && least < 400 * step) least += step;
    std::map<End, int> ends;
    for (rlim_t size = least; ends[End::rendered] < 3 && size < least + 150 * step; size += step)
        ++ends[end_of_film(limit_to(size))];
    EXPECT_GT(ends[End::told], 3);
    EXPECT_EQ(ends[End::rendered], 3);
}

TEST_F(RenderMemory, AnyAllocationThatFailsLeavesFilesWhole) {
    std::map<End, int> ends;
    for (double number = 1; number < 1e5; number = std::ceil(1.25 * number))
        ++ends[end_of_film([number] {
            setenv("LD_PRELOAD", CISTULA_FAIL_ALLOCATION, 1);
            setenv("CISTULA_FAIL_AT", std::to_string(static_cast<long>(number)).c_str(), 1);
        })];
    EXPECT_GT(ends[End::told], 10);
}

TEST_F(RenderMemory, SaysWhatAFrameTakes) {
    const rlimit limit{rlim_t{4} << 30, rlim_t{4} << 30};
    const ProgramResult result =
        run_with({"s.json", "-o", "f.exr", "--res", "65536x65536"}, [&] { setrlimit(RLIMIT_AS, &limit); });
    EXPECT_EQ(result.code, 1);
    EXPECT_EQ(result.error.rfind("render: out of memory; a frame of 65536x65536 takes ", 0), 0u) << result.error;
    EXPECT_NE(result.error.find("; a smaller --res or --crop"), std::string::npos) << result.error;
}

}  // namespace
}  // namespace cistula
