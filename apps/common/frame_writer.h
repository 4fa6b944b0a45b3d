// Writes frames on threads of its own, so that the next ones render meanwhile.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <exception>
#include <map>
#include <mutex>
#include <queue>
#include <string>
#include <thread>
#include <vector>

#include "apps/common/header_attributes.h"
#include "apps/common/stats.h"
#include "scene/film/film.h"
#include "scene/film/film_picture.h"

namespace cistula {

/// A rendered frame on its way to its files.
struct FinishedFrame {
    Film film;
    Attributes attributes;
    std::string path, preview;  // empty preview: none
    FrameStats stats;           // the writer adds the ledger, the hash, its times, and how far a target was reached
    FrameSettings settings;
};

/// How much a FrameWriter may have in work.
struct WriterLimits {
    int frames = 1;                  // one thread each
    size_t bytes = size_t{2} << 30;  // of films and of the layers that they become
    int exr_threads = 0;             // of OpenEXR, shared by the frames, beside those; see set_exr_threads
};

/// Every frame in work is led by one thread from its film to its files, whatever the others do.
class FrameWriter {
  public:
    /// `stop` is set as soon as a write fails. `written` receives the frames in the order in which they were put; it
    /// may be read after finish() or the destructor. Ledger and hash are computed where `measure`. Sets OpenEXR's
    /// threads: files are neither written nor read elsewhere meanwhile.
    FrameWriter(const OutputChannels& channels, bool measure, const WriterLimits& limits, std::atomic<bool>& stop,
                std::vector<FrameStats>& written);
    ~FrameWriter();

    /// Waits for room. Frames that exceed the limit of bytes on their own go two at a time, and one film at a time.
    /// Throws what the first write that failed threw; the frame is then not written.
    void put(FinishedFrame frame);

    /// A film whose frame is encoded, for its memory; or an empty one.
    Film take_spare();

    /// Waits until all is written. Throws what the first write that failed threw.
    void finish();

  private:
    struct Task {
        size_t index = 0;  // in the order of put()
        size_t bytes = 0;  // in memory, of the film or then of its layers
        bool has_film = true;
        FinishedFrame frame;
    };

    bool has_room(size_t bytes) const;  // mutex_ held
    void work();
    void write(Task& task);
    void give_film_back(Task& task, size_t bytes_of_layers);
    void wait_for_all(std::unique_lock<std::mutex>& lock);

    const OutputChannels channels_;
    const bool measure_;
    const WriterLimits limits_;
    std::atomic<bool>& stop_;
    std::vector<FrameStats>& written_;

    std::mutex mutex_;
    std::condition_variable changed_;
    std::queue<Task> waiting_;           // for a thread to take notice
    std::map<size_t, FrameStats> done_;  // not yet in written_
    std::vector<Film> spares_;
    std::exception_ptr failure_;         // the first
    size_t next_index_ = 0, bytes_ = 0;  // bytes_: of all in work
    int in_work_ = 0, films_ = 0;        // films_: frames in work that are not encoded
    size_t idle_ = 0;                    // threads, those that have not noticed a waiting frame among them
    bool closing_ = false;
    std::vector<std::thread> threads_;
};

}  // namespace cistula
