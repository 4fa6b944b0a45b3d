#include "apps/common/interrupt.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdlib>

#include "base/atomic_file.h"
#include "scene/description/mesh_source.h"
#include "testing/support/render_program.h"
#include "verify/scenes/generated_scene.h"

namespace cistula {
namespace {

/// In the child of a death test: dispositions as in a shell's foreground job.
void default_signals() {
    std::signal(SIGINT, SIG_DFL);
    std::signal(SIGTERM, SIG_DFL);
    std::signal(SIGHUP, SIG_DFL);
    std::signal(SIGPIPE, SIG_DFL);
}

/// Exit code 0 if `good`, else 1: what a child reports.
[[noreturn]] void report(bool good) {
    std::_Exit(good ? 0 : 1);
}

TEST(InterruptDeathTest, TheFirstSignalSetsTheFlag) {
    for (const int number : {SIGINT, SIGTERM, SIGHUP})
        EXPECT_EXIT(
            {
                default_signals();
                std::atomic<bool> stop{false};
                const InterruptGuard guard("render");
                const StopOnInterrupt watch(stop);
                const bool before = stop;
                std::raise(number);
                report(!before && stop);
            },
            testing::ExitedWithCode(0), "");
}

TEST(InterruptDeathTest, TheSecondSignalEndsTheProgramAtOnce) {
    for (const int number : {SIGINT, SIGTERM, SIGHUP})
        EXPECT_EXIT(
            {
                default_signals();
                std::atomic<bool> stop{false};
                const InterruptGuard guard("render");
                const StopOnInterrupt watch(stop);
                std::raise(SIGINT);
                std::raise(number);
                report(false);
            },
            testing::ExitedWithCode(130), "");
}

TEST(InterruptDeathTest, NoTemporaryIsLeft) {
    const ScratchDirectory scratch;
    const std::string path = scratch.file("a.txt");
    EXPECT_EXIT(
        {
            default_signals();
            const InterruptGuard guard("render-merge");
            std::atomic<bool> stop{false};
            { const StopOnInterrupt watch(stop); }  // watches no more
            const AtomicFile file(path);
            if (scratch.names().empty()) report(false);
            std::raise(SIGTERM);
            report(false);
        },
        testing::ExitedWithCode(130), "render-merge: interrupted");
    EXPECT_TRUE(scratch.names().empty());
}

/// Sends this process a signal from another one.
void send_from_another(int number) {
    const pid_t self = getpid(), other = fork();
    if (other == 0) _exit(kill(self, number));
    waitpid(other, nullptr, 0);
}

TEST(InterruptDeathTest, ABrokenPipeIsNoInterruptionButSigpipeOfOthersIs) {
    EXPECT_EXIT(
        {
            default_signals();
            std::atomic<bool> stop{false};
            const InterruptGuard guard("render");
            const StopOnInterrupt watch(stop);
            int ends[2];
            bool good = pipe(ends) == 0 && close(ends[0]) == 0;
            good &= write(ends[1], "x", 1) < 0 && errno == EPIPE && !stop;
            send_from_another(SIGPIPE);
            report(good && stop);
        },
        testing::ExitedWithCode(0), "");
}

TEST(InterruptDeathTest, BeforeAnythingRendersItEndsTheProgramAtOnce) {
    EXPECT_EXIT(
        {
            default_signals();
            const InterruptGuard guard("render");
            std::raise(SIGINT);
            report(false);
        },
        testing::ExitedWithCode(130), "render: interrupted");
}

TEST(InterruptDeathTest, IgnoredSignalsStayIgnored) {
    EXPECT_EXIT(
        {
            default_signals();
            std::signal(SIGINT, SIG_IGN);
            std::atomic<bool> stop{false};
            const InterruptGuard guard("render");
            const StopOnInterrupt watch(stop);
            std::raise(SIGINT);
            report(!stop);
        },
        testing::ExitedWithCode(0), "");
}

TEST(InterruptDeathTest, TheOldDispositionComesBack) {
    EXPECT_EXIT(
        {
            default_signals();
            { const InterruptGuard guard("render"); }
            std::raise(SIGTERM);
            report(false);
        },
        testing::KilledBySignal(SIGTERM), "");
}

/// A mesh of many triangles, as a binary PLY.
std::string ply_of(const TrianglesObject& mesh) {
    std::string bytes = "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(mesh.vertices.size()) +
                        "\nproperty double x\nproperty double y\nproperty double z\nelement face " +
                        std::to_string(mesh.triangles.size()) +
                        "\nproperty list uchar uint vertex_indices\nend_header\n";
    const auto add = [&](const auto& numbers) {
        bytes.append(reinterpret_cast<const char*>(&numbers), sizeof numbers);
    };
    for (const glm::dvec3& vertex : mesh.vertices) add(vertex);
    for (const TriangleCorners& corners : mesh.triangles) {
        bytes += '\3';
        add(corners);
    }
    return bytes;
}

TEST_F(RenderProgram, InterruptionsEndTheCompilationOfALargeMesh) {
    put_bytes(file("m.ply"), ply_of(bumpy_sphere(330'000)));
    put_bytes(file("m.json"), R"({"materials": {"m": {"reflection": 0.2}}, "lights": [{"position": [3, -4, 5]}],
        "objects": [{"mesh": "m.ply", "material": "m", "keep_triangles": true}]})");
    for (const int number : {SIGINT, SIGTERM}) {
        RunningProgram running(program_, {"m.json", "-o", "m.exr", "--stats", "m.stats"}, file(""));
        // It says why it takes double, and compiles.
        ASSERT_TRUE(
            running.wait_until([&] { return running.error_so_far().find("double: ") != std::string::npos; }, 60));
        running.send(number);
        const ProgramResult result = running.wait();
        EXPECT_EQ(result.code, 130) << result.error;
        EXPECT_TRUE(result.error.ends_with("render: interrupted; nothing was written\n")) << result.error;
        EXPECT_FALSE(exists("m.exr") || exists("m.stats") || has_part_files());
    }
}

}  // namespace
}  // namespace cistula
