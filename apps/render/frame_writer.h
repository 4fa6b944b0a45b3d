// Writes frames on a thread of its own, so that the next one renders meanwhile.
#pragma once

#include <atomic>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "header_attributes.h"
#include "options.h"
#include "scene/film.h"
#include "stats.h"

namespace cistula {

/// A rendered frame on its way to its files.
struct FinishedFrame {
    Film film;
    Attributes attributes;
    std::string path, preview;  // empty preview: none
    FrameStats stats;           // the writer adds the ledger, the hash and its times
};

/// One frame in work at a time; put() waits for the one before, so that at most two films are in memory.
class FrameWriter {
  public:
    /// `stop` is set as soon as a write fails. `written` receives the frames in order; it may be read after finish() or
    /// the destructor. Ledger and hash are computed where `measure`.
    FrameWriter(const OutputChannels& channels, bool measure, std::atomic<bool>& stop,
                std::vector<FrameStats>& written);
    ~FrameWriter();

    /// Throws what the frame before threw.
    void put(FinishedFrame frame);

    /// Waits until all is written. Throws what a write threw.
    void finish();

  private:
    void work();
    void write(FinishedFrame& frame) const;

    const OutputChannels channels_;
    const bool measure_;
    std::atomic<bool>& stop_;
    std::vector<FrameStats>& written_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::optional<FinishedFrame> frame_;  // in work, or waiting for the thread to take notice
    std::exception_ptr failure_;
    bool closing_ = false;
    std::thread thread_;
};

}  // namespace cistula
