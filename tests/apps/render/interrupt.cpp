#include "apps/common/interrupt.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdlib>

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
                InterruptGuard guard;
                guard.watch(stop);
                const bool before = stop;
                std::raise(number);
                report(!before && stop);
            },
            testing::ExitedWithCode(0), "");
}

TEST(InterruptDeathTest, TheSecondSignalKills) {
    for (const int number : {SIGINT, SIGTERM, SIGHUP})
        EXPECT_EXIT(
            {
                default_signals();
                std::atomic<bool> stop{false};
                InterruptGuard guard;
                guard.watch(stop);
                std::raise(SIGINT);
                std::raise(number);
                report(false);
            },
            testing::KilledBySignal(number), "");
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
            InterruptGuard guard;
            guard.watch(stop);
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
            InterruptGuard guard;
            std::raise(SIGINT);
            report(false);
        },
        testing::ExitedWithCode(130), "render: interrupted; nothing was written");
}

TEST(InterruptDeathTest, IgnoredSignalsStayIgnored) {
    EXPECT_EXIT(
        {
            default_signals();
            std::signal(SIGINT, SIG_IGN);
            std::atomic<bool> stop{false};
            InterruptGuard guard;
            guard.watch(stop);
            std::raise(SIGINT);
            report(!stop);
        },
        testing::ExitedWithCode(0), "");
}

TEST(InterruptDeathTest, TheOldDispositionComesBack) {
    EXPECT_EXIT(
        {
            default_signals();
            { InterruptGuard guard; }
            std::raise(SIGTERM);
            report(false);
        },
        testing::KilledBySignal(SIGTERM), "");
}

}  // namespace
}  // namespace cistula
