#include "sequence/frame_writer.h"

#include <fmt/format.h>

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <future>
#include <iterator>

#include "base/default_rounding.h"
#include "base/error.h"
#include "base/stages.h"
#include "base/timing.h"
#include "image/exr/exr.h"
#include "image/picture/picture_io.h"
#include "image/picture/raw_picture.h"
#include "render/record/film_picture.h"
#include "sequence/output_name.h"

namespace cistula {
namespace {

size_t bytes_of(const Film& film) {
    return film.pixels.bytes() + film.layers.words.size() * sizeof(int64_t);
}

/// The number of values that are over the largest half, `clamped` being where their channels count them.
uint64_t clamped_values(const LayeredPicture& picture, std::atomic<uint64_t>& clamped) {
    constexpr size_t block = 1024;
    const size_t pixels = static_cast<size_t>(picture.width) * static_cast<size_t>(picture.height);
    tbb::parallel_for(size_t{0}, (pixels + block - 1) / block, [&](size_t number) {
        const DefaultRounding rounding;
        std::array<float, block> values;
        const size_t first = number * block;
        const size_t last = std::min(first + block, pixels);
        for (const LayeredPicture::Channel& channel : picture.channels)
            if (channel.half) channel.write(first, last, values.data());
    });
    return clamped.exchange(0);
}

}  // namespace

std::string over_largest_half(uint64_t values) {
    return fmt::format("{} value{} over {:.0f}, the largest half; `bits` float holds {}", values,
                       values == 1 ? " is" : "s are", largest_half, values == 1 ? "it" : "them");
}

FrameWriter::FrameWriter(const OutputChannels& channels, bool measure, const WriterLimits& limits,
                         std::atomic<bool>& stop, FrameSink written)
    : channels_(channels), measure_(measure), limits_(limits), stop_(stop), written_(std::move(written)) {}

FrameWriter::~FrameWriter() {
    {
        std::unique_lock lock(mutex_);
        wait_for_all(lock);
        closing_ = true;
    }
    const InStage stage(Stage::end);
    changed_.notify_all();
    threads_.clear();
    spares_.clear();
}

bool FrameWriter::has_room(size_t bytes) const {
    if (in_work_ >= std::max(limits_.frames, 1)) return false;
    return in_work_ == 0 || bytes_ + bytes <= limits_.bytes;
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
    waiting_.push({next_index_++, bytes, std::move(frame)});
    bytes_ += bytes;
    ++in_work_;
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

template <class Condition>
void FrameWriter::wait_until(std::unique_lock<std::mutex>& lock, const Condition& holds) {
    while (!holds()) {
        const InStage stage(Stage::write);
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
        bool is_whole = true;
        try {
            write(task);
        } catch (const Error& error) {
            is_whole = false;
            if (error.kind() != ErrorKind::interrupted) failure = std::current_exception();
        } catch (...) {
            failure = std::current_exception();
        }
        Film film = std::move(task.frame.film);
        lock.lock();
        bytes_ -= task.bytes;
        try {
            if (failure) std::rethrow_exception(failure);
            if (is_whole) done_.emplace(task.index, std::move(task.frame.stats));
            if (bytes_ + (spares_.size() + 1) * task.bytes <= limits_.bytes) spares_.push_back(std::move(film));
        } catch (...) {
            if (!failure_) failure_ = std::current_exception();
            stop_ = true;
        }
        pass_on();
        --in_work_;
        ++idle_;
        changed_.notify_all();
    }
}

void FrameWriter::write(Task& task) {
    FinishedFrame& frame = task.frame;
    FrameStats& stats = frame.stats;
    const std::string path = frame.image.for_frame(stats.frame);
    const bool raw = file_kind(path) == FileKind::raw;
    LayeredPicture layers;
    std::atomic<uint64_t> clamped{0};
    std::future<std::string> hash;  // takes one thread longer than the rest takes all of them
    if (measure_) hash = std::async(std::launch::async, film_hash, std::cref(frame.film));
    if (frame.settings.adaptive()) stats.target = target_report(frame.film, frame.settings);
    if (!raw) layers = channels_of(frame.film, channels_, &clamped);
    if (frame.strict)
        if (const uint64_t values = clamped_values(layers, clamped); values != 0)
            throw Error(ErrorKind::failed, "not written: " + over_largest_half(values)).at(path);
    // The preview is written first: if the image is complete, --resume can rely on both.
    if (raw || !frame.preview.empty()) {
        ColorPicture color, preview;
        stats.encode_seconds = seconds_of([&] {
            color = to_color(frame.film, channels_.transparent);
            if (frame.preview.empty()) return;
            preview = viewed(raw ? color : std::move(color), frame.view, static_cast<uint32_t>(frame.film.full_height));
        });
        stats.write_seconds = seconds_of([&] {
            if (!frame.preview.empty()) write_preview(frame.preview, preview);
            if (raw) write_raw_picture(path, color);
        });
    }
    if (!raw) {
        layers.attributes.merge(std::move(frame.attributes));
        if (frame.settings.adaptive()) add_target_attributes(stats.target, layers.attributes);
        stats.write_seconds += seconds_of([&] {
            for (const FrameFile& file : frame_files(std::move(layers), frame.split, frame.image, stats.frame))
                write_exr(file.path, file.parts, limits_.exr_threads_of_a_frame, stop_);
        });
    }
    stats.clamped = clamped;
    if (measure_) stats.hash = hash.get();
}

std::vector<FrameFile> frame_files(LayeredPicture picture, Split split, const OutputName& name, int frame) {
    FrameFile main{name.for_frame(frame), {}};
    std::vector<FrameFile> files;
    if (split == Split::none) {
        main.parts.push_back({"", std::move(picture)});
    } else {
        main.parts = split_by_layer(std::move(picture), split);
        if (split == Split::parts)
            for (PicturePart& part : main.parts) part.picture.attributes.erase("acesImageContainerFlag");
        if (split == Split::files) {
            for (auto part = std::next(main.parts.begin()); part != main.parts.end(); ++part) {
                FrameFile& own = files.emplace_back(FrameFile{name.for_layer(frame, part->name), {}});
                own.parts.push_back(std::move(*part));
                name_colors_plainly(own.parts.front());
                set_container_flag(own.parts.front().picture);
            }
            main.parts.resize(1);
            set_container_flag(main.parts.front().picture);
        }
    }
    files.push_back(std::move(main));
    return files;
}

}  // namespace cistula
