#include "sequence/sequence_loop.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <deque>
#include <filesystem>
#include <optional>
#include <set>
#include <vector>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/shown_text.h"
#include "base/stages.h"
#include "base/timing.h"
#include "cistula/geometry/ray.h"
#include "cistula/model/pixel_record.h"
#include "image/exr/exr.h"
#include "scene/compile/contacts/overlaps.h"
#include "sequence/frame_list.h"
#include "sequence/snapshots.h"

namespace cistula {
namespace {

/// The files of a frame, without values: their windows, channels and attributes.
std::vector<FrameFile> expected_files(const SequenceJob& job, const CameraFrame& camera) {
    Film one;
    one.full_width = one.full_height = one.rect.width = one.rect.height = 1;
    one.pixels.assign(1);
    begin_layers(one.layers, job.settings.layers, 1, job.layer_names);
    LayeredPicture picture = channels_of(one, job.request.channels);
    const PixelRect& crop = job.settings.crop;
    picture.width = crop.width;
    picture.height = crop.height;
    picture.x = crop.x;
    picture.y = crop.y;
    picture.display_width = job.settings.full_width;
    picture.display_height = job.settings.full_height;
    picture.attributes.merge(attributes_of(job, camera));
    return frame_files(std::move(picture), job.request.split, job.output, camera.frame);
}

/// Whether a file is complete, and of this frame.
bool is_finished(const FrameFile& file) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(file.path, error)) return false;
    try {
        const std::vector<PicturePart> parts = read_exr_headers(file.path);
        const auto is_same = [&](const PicturePart& part, const PicturePart& expected) {
            return (parts.size() == 1 || part.name == expected.name) && is_same_image(part.picture, expected.picture);
        };
        return std::equal(parts.begin(), parts.end(), file.parts.begin(), file.parts.end(), is_same) &&
               exr_is_complete(file.path);
    } catch (const Error&) {
        return false;  // not an EXR of this frame: rendered again
    }
}

bool is_finished(const SequenceJob& job, const CameraFrame& camera) {
    const std::string preview = job.preview.for_frame(camera.frame);
    std::error_code error;
    if (!std::filesystem::is_regular_file(job.output.for_frame(camera.frame), error)) return false;
    if (!preview.empty() && !std::filesystem::exists(preview, error)) return false;
    const std::vector<FrameFile> files = expected_files(job, camera);
    return std::all_of(files.rbegin(), files.rend(), [](const FrameFile& file) { return is_finished(file); });
}

/// The files that are written for a frame: images, those of layers first, and the preview.
std::vector<std::string> paths_of(const SequenceJob& job, const CameraFrame& camera) {
    std::vector<std::string> paths;
    if (job.request.split == Split::files)
        for (const FrameFile& file : expected_files(job, camera)) paths.push_back(file.path);
    else
        paths.push_back(job.output.for_frame(camera.frame));
    if (!job.preview.text().empty()) paths.push_back(job.preview.for_frame(camera.frame));
    return paths;
}

/// Throws Error if a frame cannot be written.
void probe_outputs(const SequenceJob& job, const CameraFrame& camera) {
    for (const std::string& path : paths_of(job, camera)) const AtomicFile probe(path);
}

/// Removes what programs that died left beside a frame's files.
void remove_stale(const SequenceJob& job, const CameraFrame& camera) {
    for (const std::string& path : paths_of(job, camera)) AtomicFile::remove_stale(path);
}

/// Finished frames that are looked at for the one to announce to the renderer, before it renders the one before.
constexpr size_t most_looked_at = 4;

/// The frames of a job that are still to be rendered, found as they are asked for.
class FramesToRender {
  public:
    FramesToRender(const SequenceJob& job, const std::atomic<bool>& stop, std::vector<int>& resumed)
        : job_(job), stop_(stop), resumed_(resumed) {}

    /// The next one, if it is among the `most` frames that follow.
    std::optional<CameraFrame> next(size_t most = most_frames) {
        const InStage stage(Stage::read);
        for (; index_ < job_.frames.size() && most > 0 && !stop_; ++index_, --most) {
            if (index_ > 0 && index_ % stretch_length == 0) look_ahead();
            const CameraFrame camera = camera_at(job_.scene.camera, job_.frames[index_]);
            if (!job_.request.resume || !is_finished(job_, camera)) {
                ++index_;
                return camera;
            }
            remove_stale(job_, camera);
            resumed_.push_back(camera.frame);
            job_.events.kept(camera.frame, job_.output.for_frame(camera.frame));
        }
        return std::nullopt;
    }

    /// How many frames of the job are to be rendered, as far as is known.
    size_t count() const { return job_.frames.size() - resumed_.size(); }

  private:
    void look_ahead() {
        if (!job_.look_ahead) return;
        const std::string warning = job_.look_ahead(frames_from(job_.frames, index_ - 1, stretch_length + 1));
        if (!warning.empty()) job_.events.warning(warning);
    }

    const SequenceJob& job_;
    const std::atomic<bool>& stop_;
    std::vector<int>& resumed_;
    size_t index_ = 0;
};

/// `rendered`: index of the first frame that was not.
[[noreturn]] void fail_interrupted(const SequenceJob& job, size_t done, size_t rendered) {
    const bool raw = file_kind(job.output.text()) == FileKind::raw;
    throw Error(ErrorKind::interrupted, fmt::format("interrupted; {} of {} frames written", done, job.frames.size()),
                fmt::format("the same command with {} goes on from here",
                            raw ? "`frames` " + format_frames(job.frames, rendered) : std::string("`resume`")));
}

FrameStats stats_of(const Film& film, int frame, const std::string& path, double seconds, const RenderTimes& device) {
    FrameStats stats;
    stats.frame = frame;
    stats.file = path;
    stats.width = film.rect.width;
    stats.height = film.rect.height;
    stats.render_seconds = seconds;
    stats.device = device;
    stats.rays = film.rays;
    stats.pruned = ledger_totals(film, film.totals.pruned);
    stats.cut = ledger_totals(film, film.totals.cut);
    stats.units = unit_totals(film);
    return stats;
}

/// Adds to a frame what its files and its statistics say beside its film.
void describe(FinishedFrame& frame, const SequenceJob& job, const CameraFrame& camera, double seconds,
              const Renderer& renderer) {
    frame.image = job.output;
    frame.split = job.request.split;
    frame.preview = job.preview.for_frame(camera.frame);
    frame.view = job.request.view;
    frame.attributes = attributes_of(job, camera);
    frame.stats = stats_of(frame.film, camera.frame, job.output.for_frame(camera.frame), seconds, renderer.times());
    if (!job.settings.adaptive())
        frame.stats.depth_loss = depth_loss(frame.stats.cut, ledger_totals(frame.film, frame.film.totals.radiance));
    frame.settings = job.settings;
    frame.strict = job.request.strict;
}

/// Returns the number of frames that were rendered.
size_t render_and_write(const SequenceJob& job, Renderer& renderer, RenderProgress& progress, RunStats& stats) {
    const RenderRequest& request = job.request;
    std::set<std::string> notes;  // printed so far
    FrameWriter writer(request.channels, !request.stats.empty(), writer_limits(request.backend, job.frames.size()),
                       progress.stop, [&](const FrameStats& frame) {
                           stats.totals.add(frame);
                           if (job.stats_file) job.stats_file->add(frame);
                           job.events.written(frame);
                       });
    size_t rendered = 0;
    FrameSettings settings = job.settings;
    job.events.begin(job.frames.size());
    {
        std::optional<Snapshots> snapshots;
        if (job.snapshot_requests) snapshots.emplace(job, *job.snapshot_requests, progress.tiles);
        FramesToRender frames(job, progress.stop, stats.resumed);
        std::deque<CameraFrame> ahead;  // announced to the renderer, after the first
        while (true) {
            if (ahead.empty())
                if (const std::optional<CameraFrame> next = frames.next()) ahead.push_back(*next);
            if (ahead.empty() || progress.stop) break;
            const CameraFrame camera = ahead.front();
            ahead.pop_front();
            if (rendered == 0) probe_outputs(job, camera);
            while (ahead.size() < renderer.frames_ahead()) {
                const std::optional<CameraFrame> next = frames.next(most_looked_at);
                if (!next) break;
                ahead.push_back(*next);
                renderer.expect(*next, settings);
            }
            progress.pixels_done = 0;
            progress.rays = 0;
            const PixelRect& crop = job.settings.crop;
            const uint64_t pixels = static_cast<uint64_t>(crop.width) * static_cast<uint64_t>(crop.height);
            job.events.begin_frame(camera.frame, rendered, frames.count(), pixels);
            FinishedFrame finished;
            finished.film = writer.take_spare();
            bool whole = false;
            if (snapshots) snapshots->begin_frame(camera);
            const double seconds = seconds_of([&] {
                const InStage stage(Stage::render);
                whole = render_frame(renderer, camera, settings, finished.film, progress);
            });
            if (snapshots) snapshots->end_frame();
            for (const std::string& note : renderer.notes())
                if (notes.insert(note).second) job.events.remark(note);
            if (!whole) break;
            if (finished.film.flags != 0) {
                writer.finish();
                throw Error(ErrorKind::failed,
                            fmt::format("frame {} cannot be trusted and is not written: {}", camera.frame,
                                        describe_flags(finished.film.flags, renderer, job.scene, job.precision, camera,
                                                       settings)))
                    .at(job.scene.source);
            }
            describe(finished, job, camera, seconds, renderer);
            job.events.end_frame(finished.stats);
            writer.put(std::move(finished));
            ++rendered;
        }
    }
    writer.finish();
    if (!stats.resumed.empty())
        job.events.remark(
            fmt::format("{} of {} frames are complete and stay as they are", stats.resumed.size(), job.frames.size()));
    return rendered;
}

/// Warns of values of the written frames that were clamped to half precision.
void warn_of_clamped(const SequenceJob& job, const SequenceTotals& totals) {
    if (totals.clamped == 0) return;
    const std::string where = totals.frames == 1 ? totals.first_file
                                                 : fmt::format("{}: in {} of {} frames", job.output.text(),
                                                               totals.clamped_frames, totals.frames);
    job.events.warning(fmt::format("{}: clamped: {}", where, over_largest_half(totals.clamped)));
}

}  // namespace

Attributes attributes_of(const SequenceJob& job, const CameraFrame& camera) {
    Attributes attributes = header_attributes(job.hashes, job.settings, job.precision, camera);
    add_film_attributes(job.scene.film, attributes);
    return attributes;
}

// Every core compresses that has no rays to trace: TBB's by zip, which go where there is work, and OpenEXR's threads by
// others. A GPU renders much faster than frames are compressed, so several frames are written at once, and of OpenEXR's
// threads a few share each: with one frame per core, cores would idle until as many frames are rendered, and again
// while the last ones are written. At least two frames, so that one is encoded while the
// other is compressed. The CPU backend writes one, with all cores: it has memory for no more than two films.
WriterLimits writer_limits(Backend backend, size_t frames) {
    constexpr int few = 4;  // a frame queues twice as many blocks of lines, and others wait behind them
    const int threads = tbb::this_task_arena::max_concurrency();
    WriterLimits limits;
    limits.exr_threads_of_a_frame = threads;
    if (backend == Backend::cuda && frames > 1) {
        limits.frames = std::max(2, threads / 2);
        limits.exr_threads_of_a_frame = std::min(threads, few);
    }
    return limits;
}

std::vector<std::string> layers_with_files(const SequenceJob& job) {
    std::vector<std::string> layers;
    if (job.request.split != Split::files) return layers;
    for (const FrameFile& file : expected_files(job, camera_at(job.scene.camera, job.frames.front())))
        if (file.parts.front().name != main_part) layers.push_back(file.parts.front().name);
    return layers;
}

void render_frames(const SequenceJob& job, Renderer& renderer, RenderProgress& progress, RunStats& stats) {
    size_t rendered = 0;
    const auto close = [&] {
        stats.intersector = renderer.intersector();
        stats.lanes = renderer.lanes();
        stats.effects = renderer.effects();  // it knows which it used
        warn_of_clamped(job, stats.totals);
    };
    try {
        stats.seconds = seconds_of([&] { rendered = render_and_write(job, renderer, progress, stats); });
    } catch (const Error&) {
        close();
        throw;
    }
    close();
    const size_t done = stats.resumed.size() + stats.totals.frames;
    if (done < job.frames.size()) {  // an interruption after the last frame has no effect
        job.events.end(stats, done, job.frames.size());
        fail_interrupted(job, done, rendered);
    }
    const std::string depth = describe_depth_loss(stats.totals, job.output.text(), job.settings.depth);
    if (!depth.empty()) job.events.warning(depth);
    std::string target;
    if (job.settings.adaptive() && stats.totals.frames > 0)
        target = describe_target(stats.totals.target, stats.totals.pixels, job.settings, job.precision);
    const bool is_missed = stats.totals.target.missed != 0;
    if (!target.empty() && !is_missed) job.events.remark(target);
    job.events.end(stats, done, job.frames.size());
    if (is_missed) throw Error(ErrorKind::target, target);
}

}  // namespace cistula
