// A status line on standard error that shows a program's progress.
#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

#include "sequence/sequence_events.h"

namespace cistula {

/// Whether standard error is a terminal on which a line can be redrawn.
bool is_terminal();

/// A duration as text: "0:07", "12:34", "1:02:03".
std::string format_duration(double seconds);

/// A status line, kept up to date by its own thread.
class StatusLine {
  public:
    /// `text` returns the line without a line end: on a terminal its first `columns` characters are shown; `columns` is
    /// 0 where there is room for all. An empty line is not shown. In a style for programs it is a record, printed every
    /// second. The data that `text` reads must outlive this object
    /// and be changed in update() only.
    StatusLine(ProgressStyle style, std::function<std::string(int columns)> text);
    ~StatusLine();

    /// Runs `change`, which may modify the data that `text` reads, while the thread does not call `text`.
    template <class Change>
    void update(const Change& change) {
        const std::lock_guard lock(mutex_);
        change();
    }

    /// Runs `write`, which writes to the terminal, while the status line is erased.
    template <class Write>
    void aside(const Write& write) {
        const std::lock_guard lock(mutex_);
        erase();
        write();
    }

    /// Prints a line on standard error, in every style.
    void say(const std::string& line);

    /// Prints a line on standard error if the style is plain.
    void milestone(const std::string& line);

    /// Prints lines on standard output if the style is for programs. A failure changes nothing.
    void record(const std::string& lines);

  private:
    using Clock = std::chrono::steady_clock;
    enum class Output { drawn, lines, sparse_lines, records, none };

    void watch();
    void show();   // requires mutex_
    void erase();  // requires mutex_

    const Output output_;
    const std::function<std::string(int columns)> text_;
    std::mutex mutex_;
    std::condition_variable wake_;
    bool stop_ = false;
    bool drawn_ = false;
    Clock::time_point last_line_ = Clock::now();
    std::thread thread_;
};

}  // namespace cistula
