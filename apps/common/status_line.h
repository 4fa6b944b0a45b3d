// One line on standard error that says how far a program is.
#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

namespace cistula {

/// How a program shows how far it is. `automatic`: a line that is drawn again and again on a terminal, elsewhere a line
/// every 30 s. `plain`: a line every 10 s and at milestones.
enum class ProgressStyle { automatic, plain, none };

/// Whether standard error is a terminal on which a line can be drawn again.
bool is_terminal();

/// "0:07", "12:34", "1:02:03".
std::string format_duration(double seconds);

/// The line, which a thread of its own keeps up to date.
class StatusLine {
  public:
    /// `text` gives the line, without a line end: of at most so many columns where it is drawn on a terminal, of any
    /// length where `columns` is 0. An empty one is not shown. What `text` looks at must outlive this object and be
    /// changed in update() only.
    StatusLine(ProgressStyle style, std::function<std::string(int columns)> text);
    ~StatusLine();

    /// Runs `change`, which changes what `text` looks at, while the thread does not.
    template <class Change>
    void update(const Change& change) {
        const std::lock_guard lock(mutex_);
        change();
    }

    /// Runs `write`, which writes to the terminal, while the line is out of the way.
    template <class Write>
    void aside(const Write& write) {
        const std::lock_guard lock(mutex_);
        erase();
        write();
    }

    /// A line of its own on standard error, in every style.
    void say(const std::string& line);

    /// A line of its own where the style is plain.
    void milestone(const std::string& line);

  private:
    using Clock = std::chrono::steady_clock;
    enum class Output { drawn, lines, sparse_lines, none };

    void watch();
    void show();   // mutex_ held
    void erase();  // mutex_ held

    const Output output_;
    const std::function<std::string(int columns)> text_;
    std::mutex mutex_;
    std::condition_variable wake_;
    bool stop_ = false, drawn_ = false;
    Clock::time_point last_line_ = Clock::now();
    std::thread thread_;
};

}  // namespace cistula
