// Writes frames on its own threads while the next ones render.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <exception>
#include <functional>
#include <map>
#include <mutex>
#include <queue>
#include <string>
#include <thread>
#include <vector>

#include "image/view/picture_view.h"
#include "render/record/film.h"
#include "render/record/film_picture.h"
#include "render/record/frame_header.h"
#include "render/record/split_picture.h"
#include "sequence/output_name.h"
#include "sequence/stats.h"

namespace cistula {

/// A rendered frame to be written.
struct FinishedFrame {
    Film film;
    Attributes attributes;
    OutputName image;           // the frame number is that of `stats`
    std::string preview;        // empty: none
    Split split = Split::none;  // of the image's layers
    PictureView view;           // of the preview
    FrameStats stats;           // the writer adds what depends on the film
    FrameSettings settings;
    bool strict = false;  // not written, but an Error (failed), if a value is over the largest half
};

/// Limits on the frames in a FrameWriter.
struct WriterLimits {
    int frames = 1;                  // one thread each
    size_t bytes = size_t{2} << 30;  // of films
    int exr_threads_of_a_frame = 0;  // OpenEXR's, additional to those above, see write_exr
};

/// What is said of values that half precision does not hold.
std::string over_largest_half(uint64_t values);

/// Receives a frame whose files are whole.
using FrameSink = std::function<void(const FrameStats&)>;

/// Writes frames concurrently; each is processed by one thread from its film to its files.
class FrameWriter {
  public:
    /// `stop` is set as soon as a write fails. `written` receives the frames in the order of put(), one at a time, on
    /// any thread; what it throws is a failed write. The hash is computed if `measure` is set.
    FrameWriter(const OutputChannels& channels, bool measure, const WriterLimits& limits, std::atomic<bool>& stop,
                FrameSink written);
    ~FrameWriter();

    /// Adds a frame; blocks until there is room. Frames that exceed the limit of bytes on their own are written one
    /// after the other. Throws the first write error; the frame is then not written.
    void put(FinishedFrame frame);

    /// A film that is no longer needed, for reuse of its memory; or an empty one.
    Film take_spare();

    /// Waits until all frames are written. Throws the first write error.
    void finish();

  private:
    struct Task {
        size_t index = 0;  // in the order of put()
        size_t bytes = 0;  // memory of the film
        FinishedFrame frame;
    };

    bool has_room(size_t bytes) const;  // requires mutex_
    void work();
    void write(Task& task);
    template <class Condition>
    void wait_until(std::unique_lock<std::mutex>& lock, const Condition& holds);
    void pass_on();  // requires mutex_
    void wait_for_all(std::unique_lock<std::mutex>& lock);

    const OutputChannels channels_;
    const bool measure_;
    const WriterLimits limits_;
    std::atomic<bool>& stop_;
    const FrameSink written_;

    std::mutex mutex_;
    std::condition_variable changed_;
    std::queue<Task> waiting_;           // tasks that no thread has taken yet
    std::map<size_t, FrameStats> done_;  // not yet passed on, since a frame before them is not done
    size_t next_passed_ = 0;
    std::vector<Film> spares_;
    std::exception_ptr failure_;  // the first write error
    // bytes_: of all frames in work
    size_t next_index_ = 0;
    size_t bytes_ = 0;
    int in_work_ = 0;
    size_t idle_ = 0;  // threads without work, including those that have not yet woken up for a waiting frame
    bool closing_ = false;
    std::vector<std::jthread> threads_;
};

struct FrameFile {
    std::string path;
    std::vector<PicturePart> parts;
};

/// The files that a frame's channels go to, the main one last: when it is complete, so are the others.
std::vector<FrameFile> frame_files(LayeredPicture picture, Split split, const OutputName& name, int frame);

}  // namespace cistula
