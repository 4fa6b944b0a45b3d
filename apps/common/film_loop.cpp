#include "apps/common/film_loop.h"
#include "apps/common/command_line.h"

#include <fmt/format.h>
#include <tbb/task_arena.h>

#include <sys/mman.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <set>

#include "apps/common/describe_flags.h"
#include "apps/common/film_progress.h"
#include "apps/common/frame_list.h"
#include "apps/common/timing.h"
#include "scene/base/error.h"
#include "scene/image/exr.h"

namespace cistula {
namespace {

/// The picture that a frame's file must match, without values: its windows, channels and attributes.
Attributes attributes_of(const FilmJob& job, const CameraFrame& camera) {
    Attributes attributes =
        header_attributes(job.scene_hash, job.settings, job.options.precision, camera, job.options.intersection);
    add_channel_attributes(job.options.channels, attributes);
    add_film_attributes(job.scene.film, attributes);
    return attributes;
}

LayeredPicture expected_picture(const FilmJob& job, const CameraFrame& camera) {
    Film one;
    one.full_width = one.full_height = one.rect.width = one.rect.height = 1;
    one.pixels.assign(1, PixelRecord());
    LayeredPicture picture = to_layers(one, job.options.channels);
    const PixelRect& crop = job.settings.crop;
    picture.width = crop.width;
    picture.height = crop.height;
    picture.x = crop.x;
    picture.y = crop.y;
    picture.display_width = job.settings.full_width;
    picture.display_height = job.settings.full_height;
    picture.attributes = attributes_of(job, camera);
    return picture;
}

bool is_finished(const FilmJob& job, const CameraFrame& camera) {
    const std::string path = job.output.for_frame(camera.frame);
    const std::string preview = job.preview.for_frame(camera.frame);
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error) || !exr_is_complete(path)) return false;
    if (!preview.empty() && !std::filesystem::exists(preview, error)) return false;
    try {
        return is_same_image(read_exr(path), expected_picture(job, camera));
    } catch (const Error&) {
        return false;  // not an EXR of this frame: rendered again
    }
}

[[noreturn]] void fail_interrupted(const FilmJob& job, const std::vector<FrameStats>& written) {
    std::vector<int> left;
    for (const int frame : job.frames) {
        bool done = false;
        for (const FrameStats& one : written) done = done || one.frame == frame;
        if (!done) left.push_back(frame);
    }
    const bool raw = file_kind(job.output.text()) == FileKind::raw;
    throw Error(ExitCode::interrupted,
                fmt::format("interrupted; {} of {} frames written; the same command with {} goes on from here",
                            job.frames.size() - left.size(), job.frames.size(),
                            raw ? "--frames " + format_frames(left) : std::string("--resume")));
}

/// Allocates the film in large pages where the system has them; page faults on small ones would take longer than a GPU
/// needs for the pixels.
void reserve(Film& film, uint64_t pixels) {
    if (film.pixels.capacity() >= pixels) return;
    film.pixels.reserve(pixels);
    constexpr uintptr_t large_page = uintptr_t{2} << 20;
    const auto place = reinterpret_cast<uintptr_t>(film.pixels.data());
    const uintptr_t begin = (place + large_page - 1) / large_page * large_page;
    const uintptr_t end = (place + pixels * sizeof(PixelRecord)) / large_page * large_page;
    if (begin < end) (void)madvise(reinterpret_cast<void*>(begin), end - begin, MADV_HUGEPAGE);
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
    return stats;
}

}  // namespace

// A GPU renders much faster than frames are compressed, so every core should compress. Several cores share a frame:
// with one frame per core, cores would idle until as many frames are rendered, and again while the last ones are
// written. At least two frames, so that one is encoded while the other is compressed. The CPU backend needs the cores
// for rendering, and memory for no more than two films.
WriterLimits writer_limits(const FilmOptions& options) {
    WriterLimits limits;
    if (options.backend == Backend::cuda) {
        const int threads = tbb::this_task_arena::max_concurrency();
        limits.frames = std::max(2, threads / 2);
        limits.exr_threads = threads;
    }
    return limits;
}

void render_film(const FilmJob& job, Renderer& renderer, RenderProgress& progress, RunStats& stats) {
    const FilmOptions& options = job.options;
    std::vector<CameraFrame> cameras;
    for (const int frame : job.frames) {
        CameraFrame camera = camera_at(job.scene.camera, frame);
        if (options.resume && is_finished(job, camera))
            stats.resumed.push_back(frame);
        else
            cameras.push_back(camera);
    }
    if (!options.quiet && !stats.resumed.empty())
        note(fmt::format("render: {} of {} frames are complete and stay as they are", stats.resumed.size(),
                         job.frames.size()));

    std::set<std::string> notes;  // printed so far
    FrameWriter writer(options.channels, !options.stats.empty(), writer_limits(options), progress.stop, stats.frames);
    {
        FilmProgress report(options.quiet ? ProgressStyle::none : options.progress, cameras.size(), progress);
        for (size_t i = 0; i < cameras.size() && !progress.stop; ++i) {
            const int frame = cameras[i].frame;
            progress.pixels_done = 0;
            progress.rays = 0;
            const PixelRect& crop = job.settings.crop;
            const uint64_t pixels = static_cast<uint64_t>(crop.width) * static_cast<uint64_t>(crop.height);
            report.begin_frame(frame, i, pixels);
            FinishedFrame finished;
            finished.film = writer.take_spare();
            reserve(finished.film, pixels);
            if (i + 1 < cameras.size()) renderer.expect(cameras[i + 1], job.settings);
            bool whole = false;
            const double seconds =
                seconds_of([&] { whole = renderer.render(cameras[i], job.settings, finished.film, progress); });
            for (const std::string& note : renderer.notes())
                if (!options.quiet && notes.insert(note).second) report.say("render: " + note);
            if (!whole) break;
            report.end_frame();
            if (finished.film.flags != 0) {
                writer.finish();
                throw Error(ExitCode::failed,
                            fmt::format("{}: frame {} cannot be trusted and is not written: {}", job.scene.source,
                                        frame, describe_flags(finished.film.flags)));
            }
            finished.path = job.output.for_frame(frame);
            finished.preview = job.preview.for_frame(frame);
            finished.attributes = attributes_of(job, cameras[i]);
            finished.stats = stats_of(finished.film, frame, finished.path, seconds, renderer.times());
            finished.settings = job.settings;
            finished.strict = options.strict;
            if (options.verbose)
                report.say(fmt::format("render: frame {}: {:.3f} s, {} rays, {}", frame, seconds,
                                       finished.film.rays.total(),
                                       format_rate(static_cast<double>(finished.film.rays.total()) / seconds)));
            writer.put(std::move(finished));
        }
    }
    writer.finish();
    if (stats.frames.size() == cameras.size()) return;  // an interruption after the last frame has no effect
    fail_interrupted(job, stats.frames);
}

}  // namespace cistula
