#include "frame_writer.h"

#include "scene/exr.h"
#include "scene/picture_io.h"
#include "scene/seed_data.h"

namespace cistula {

FrameWriter::FrameWriter(const OutputChannels& channels, bool measure, std::atomic<bool>& stop,
                         std::vector<FrameStats>& written)
    : channels_(channels), measure_(measure), stop_(stop), written_(written), thread_([this] { work(); }) {}

FrameWriter::~FrameWriter() {
    {
        const std::lock_guard lock(mutex_);
        closing_ = true;
    }
    changed_.notify_all();
    thread_.join();
}

void FrameWriter::put(FinishedFrame frame) {
    finish();
    {
        const std::lock_guard lock(mutex_);
        frame_ = std::move(frame);
    }
    changed_.notify_all();
}

void FrameWriter::finish() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return !frame_; });
    if (failure_) std::rethrow_exception(failure_);
}

void FrameWriter::work() {
    std::unique_lock lock(mutex_);
    while (true) {
        changed_.wait(lock, [this] { return frame_ || closing_; });
        if (!frame_) return;
        lock.unlock();
        std::exception_ptr failure;
        try {
            write(*frame_);  // nobody else touches it before it is reset below
        } catch (...) {
            failure = std::current_exception();
            stop_ = true;
        }
        lock.lock();
        if (failure)
            failure_ = failure;
        else
            written_.push_back(std::move(frame_->stats));
        frame_.reset();
        changed_.notify_all();
    }
}

void FrameWriter::write(FinishedFrame& frame) const {
    FrameStats& stats = frame.stats;
    const bool raw = file_kind(frame.path) == FileKind::raw;
    LayeredPicture layers;
    ColorPicture color;
    stats.encode_seconds = seconds_of([&] {
        if (raw || !frame.preview.empty()) color = to_color(frame.film);
        if (!raw) layers = to_layers(frame.film, channels_);
        layers.attributes = std::move(frame.attributes);
    });
    if (measure_) {
        stats.hash = film_hash(frame.film);
        stats.pruned = ledger_totals(frame.film, &PixelRecord::pruned);
        stats.cut = ledger_totals(frame.film, &PixelRecord::cut);
    }
    frame.film = Film();
    stats.write_seconds = seconds_of([&] {
        // The preview first: where the image is complete, --resume may rely on both.
        if (!frame.preview.empty()) write_preview(frame.preview, color);
        if (raw)
            write_seed_frame(frame.path, color);
        else
            write_exr(frame.path, layers);
    });
}

}  // namespace cistula
