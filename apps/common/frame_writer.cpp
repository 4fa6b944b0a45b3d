#include "apps/common/frame_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <future>

#include "apps/common/output_name.h"
#include "apps/common/timing.h"
#include "scene/base/error.h"
#include "scene/base/out_of_memory.h"
#include "scene/base/stages.h"
#include "scene/image/exr.h"
#include "scene/image/picture_io.h"
#include "scene/image/raw_picture.h"

namespace cistula {
namespace {

size_t bytes_of(const Film& film) {
    return film.pixels.size() * sizeof(PixelRecord) + film.layers.words.size() * sizeof(int64_t);
}

size_t bytes_of(const LayeredPicture& layers, const ColorPicture& color, const ColorPicture& preview) {
    size_t bytes = (color.texels.size() + preview.texels.size()) * sizeof(glm::vec3);
    for (const LayeredPicture::Channel& channel : layers.channels) bytes += channel.values.size() * sizeof(float);
    return bytes;
}

}  // namespace

std::string over_largest_half(uint64_t values) {
    return fmt::format("{} value{} over {:.0f}, the largest half; --bits float holds {}", values,
                       values == 1 ? " is" : "s are", largest_half, values == 1 ? "it" : "them");
}

FrameWriter::FrameWriter(const OutputChannels& channels, bool measure, const WriterLimits& limits,
                         std::atomic<bool>& stop, FrameSink written)
    : channels_(channels), measure_(measure), limits_(limits), stop_(stop), written_(std::move(written)) {
    set_exr_threads(limits.exr_threads, limits.exr_threads_of_a_frame);
}

FrameWriter::~FrameWriter() {
    {
        std::unique_lock lock(mutex_);
        wait_for_all(lock);
        closing_ = true;
    }
    const InStage stage(Stage::end);
    changed_.notify_all();
    for (std::thread& thread : threads_) thread.join();
    spares_.clear();
}

bool FrameWriter::has_room(size_t bytes) const {
    if (in_work_ >= std::max(limits_.frames, 1)) return false;
    return in_work_ == 0 || bytes_ + bytes <= limits_.bytes || (in_work_ == 1 && films_ == 0);
}

void FrameWriter::put(FinishedFrame frame) {
    const size_t bytes = bytes_of(frame.film);
    std::unique_lock lock(mutex_);
    wait_until(lock, [&] { return failure_ || has_room(bytes); });
    if (failure_) std::rethrow_exception(failure_);
    if (idle_ == waiting_.size()) {
        threads_.emplace_back([this] { work(); });
        ++idle_;
    }
    waiting_.push({next_index_++, bytes, true, std::move(frame)});
    bytes_ += bytes;
    ++in_work_;
    ++films_;
    lock.unlock();
    changed_.notify_all();
}

Film FrameWriter::take_spare() {
    const std::lock_guard lock(mutex_);
    if (spares_.empty()) return {};
    Film film = std::move(spares_.back());
    spares_.pop_back();
    return film;
}

void FrameWriter::finish() {
    std::unique_lock lock(mutex_);
    wait_for_all(lock);
    if (failure_) std::rethrow_exception(failure_);
}

void FrameWriter::wait_for_all(std::unique_lock<std::mutex>& lock) {
    wait_until(lock, [this] { return in_work_ == 0; });
    while (!done_.empty()) {
        next_passed_ = done_.begin()->first;  // the frames before it failed
        pass_on();
    }
}

/// Waits in the stage of the frames in work.
template <class Condition>
void FrameWriter::wait_until(std::unique_lock<std::mutex>& lock, const Condition& holds) {
    while (!holds()) {
        const InStage stage(films_ > 0 ? Stage::encode : Stage::write);
        changed_.wait(lock);
    }
}

/// Passes on the frames whose predecessors have been passed on.
void FrameWriter::pass_on() {
    try {
        for (auto first = done_.begin(); first != done_.end() && first->first == next_passed_;
             first = done_.erase(first), ++next_passed_)
            written_(first->second);
    } catch (...) {
        if (!failure_) failure_ = std::current_exception();
        stop_ = true;
        done_.clear();
    }
}

void FrameWriter::work() {
    std::unique_lock lock(mutex_);
    while (true) {
        changed_.wait(lock, [this] { return !waiting_.empty() || closing_; });
        if (waiting_.empty()) return;
        --idle_;
        Task task = std::move(waiting_.front());
        waiting_.pop();
        lock.unlock();
        std::exception_ptr failure;
        try {
            write(task);
        } catch (const std::exception& error) {
            end_if_out_of_memory(error);
            failure = std::current_exception();
            stop_ = true;
        }
        task.frame.film = Film();
        lock.lock();
        if (!failure)
            done_.emplace(task.index, std::move(task.frame.stats));
        else if (!failure_)
            failure_ = failure;
        pass_on();
        bytes_ -= task.bytes;
        films_ -= task.has_film;
        --in_work_;
        ++idle_;
        changed_.notify_all();
    }
}

/// Releases a film after encoding. The encoded frame is much smaller, so there may be room for another one.
void FrameWriter::give_film_back(Task& task, size_t bytes_of_layers) {
    Film film = std::move(task.frame.film);
    const size_t bytes = bytes_of(film);
    {
        const std::lock_guard lock(mutex_);
        bytes_ += bytes_of_layers;
        bytes_ -= task.bytes;
        task.bytes = bytes_of_layers;
        task.has_film = false;
        --films_;
        if (bytes_ + (spares_.size() + 1) * bytes <= limits_.bytes) spares_.push_back(std::move(film));
    }
    changed_.notify_all();
}

void FrameWriter::write(Task& task) {
    FinishedFrame& frame = task.frame;
    FrameStats& stats = frame.stats;
    const std::string path = frame.image.for_frame(stats.frame);
    const bool raw = file_kind(path) == FileKind::raw;
    LayeredPicture layers;
    ColorPicture color, preview;
    std::future<std::string> hash;  // takes one thread longer than the rest takes all of them
    if (measure_) hash = std::async(std::launch::async, film_hash, std::cref(frame.film));
    if (frame.settings.adaptive()) stats.target = target_report(frame.film, frame.settings);
    stats.encode_seconds = seconds_of([&] {
        if (raw || !frame.preview.empty()) color = to_color(frame.film);
        if (!frame.preview.empty())
            preview = viewed(raw ? color : std::move(color), frame.view, static_cast<uint32_t>(frame.film.full_height));
        if (!raw) layers = to_layers(frame.film, channels_, &stats.clamped);
        layers.attributes.merge(std::move(frame.attributes));
        if (frame.settings.adaptive()) add_target_attributes(stats.target, layers.attributes);
    });
    if (frame.strict && stats.clamped != 0)
        throw Error(ExitCode::failed, fmt::format("{}: not written: {}", path, over_largest_half(stats.clamped)));
    stats.cut = ledger_totals(frame.film, &PixelRecord::cut);
    if (!frame.settings.adaptive())
        stats.depth_loss = depth_loss(stats.cut, ledger_totals(frame.film, &PixelRecord::radiance));
    if (measure_) {
        stats.pruned = ledger_totals(frame.film, &PixelRecord::pruned);
        stats.units = unit_totals(frame.film);
        stats.hash = hash.get();
    }
    give_film_back(task, bytes_of(layers, color, preview));
    stats.write_seconds = seconds_of([&] {
        // The preview is written first: if the image is complete, --resume can rely on both.
        if (!frame.preview.empty()) write_preview(frame.preview, preview);
        if (raw) return write_raw_picture(path, color);
        for (const FrameFile& file : frame_files(std::move(layers), frame.split, frame.image, stats.frame))
            write_exr(file.path, file.parts);
    });
}

}  // namespace cistula
