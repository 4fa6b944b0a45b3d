// Progress as it is drawn on a terminal.
#include "apps/common/sequence_progress.h"

#include <gtest/gtest.h>
#include <poll.h>
#include <pty.h>
#include <unistd.h>

#include <array>
#include <cstdlib>

#include "apps/common/step_progress.h"

namespace cistula {
namespace {

TEST(Progress, Texts) {
    EXPECT_EQ(format_duration(0), "0:00");
    EXPECT_EQ(format_duration(6.2), "0:07");
    EXPECT_EQ(format_duration(754), "12:34");
    EXPECT_EQ(format_duration(3723), "1:02:03");
    EXPECT_EQ(format_rate(950), "950 rays/s");
    EXPECT_EQ(format_rate(12.34e6), "12.3 Mrays/s");
    EXPECT_EQ(format_rate(999.6e6), "1.00 Grays/s");
    ProgressState state{12, 2, 10, 0.5, 25, 3e6};
    EXPECT_DOUBLE_EQ(remaining_seconds(state), 75);
    EXPECT_EQ(progress_line(state), "frame 12 (3/10): 50 %, 3.0 Mrays/s, ETA 1:15");
    EXPECT_EQ(progress_bar(state, 64), "frame 12 (3/10) [########---------]  50 %  3.0 Mrays/s  ETA 1:15");
    for (int columns = 0; columns < 200; ++columns)
        EXPECT_LE(progress_bar(state, columns).size(), static_cast<size_t>(columns));
    state.index = 0;
    state.fraction = 0;
    EXPECT_LT(remaining_seconds(state), 0);
    EXPECT_EQ(progress_line(state), "frame 12 (1/10): 0 %, 3.0 Mrays/s, ETA ?");
}

/// Makes standard error a terminal as long as it lives.
class Terminal {
  public:
    Terminal() : before_(dup(STDERR_FILENO)) {
        int shown = -1;
        if (openpty(&seen_, &shown, nullptr, nullptr, nullptr) != 0) throw std::runtime_error("there is no terminal");
        dup2(shown, STDERR_FILENO);
        close(shown);
        setenv("TERM", "xterm", 1);
    }
    ~Terminal() {
        dup2(before_, STDERR_FILENO);
        close(before_);
        close(seen_);
    }

    /// Whether `text` appears within a minute, after what was found before.
    bool shows(const std::string& text) {
        const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(1);
        pollfd waited{seen_, POLLIN, 0};
        while (shown_.find(text) == std::string::npos) {
            char bytes[256];
            if (std::chrono::steady_clock::now() > end || poll(&waited, 1, 60'000) != 1) return false;
            shown_.append(bytes, static_cast<size_t>(std::max<ssize_t>(read(seen_, bytes, sizeof bytes), 0)));
        }
        shown_.erase(0, shown_.find(text) + text.size());
        return true;
    }

  private:
    const int before_;
    int seen_ = -1;
    std::string shown_;
};

TEST(Progress, IsDrawnAgainOnATerminalAndIsGoneInTheEnd) {
    Terminal terminal;
    {
        StepProgress progress(ProgressStyle::automatic);
        progress.begin("cases", 4);
        progress.name_part("geometry/fans");
        progress.advance();
        EXPECT_TRUE(terminal.shows("\rcases: geometry/fans: 25 %, ETA 0:"));
        progress.aside([] { std::fputs("a row\n", stderr); });
        EXPECT_TRUE(terminal.shows("\r\033[Ka row\r\n\rcases: geometry/fans: 25 %, ETA 0:"));
        progress.advance(2);
        progress.render.pixels_done = 50;
        progress.frame(100);
        EXPECT_TRUE(terminal.shows("\rcases: geometry/fans: 87 %"));
    }
    EXPECT_TRUE(terminal.shows("\033[K\r\033[K"));
}

}  // namespace
}  // namespace cistula
