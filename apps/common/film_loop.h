// The frame loop of a film: frames are rendered one after the other, and each is written while the next ones render.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "apps/common/film_options.h"
#include "apps/common/frame_list.h"
#include "apps/common/frame_writer.h"
#include "apps/common/output_name.h"
#include "apps/common/stats.h"
#include "scene/description/description.h"
#include "scene/film/renderer.h"

namespace cistula {

class UserSignal;

/// The parameters shared by all frames.
struct FilmJob {
    const FilmOptions& options;
    const SceneDescription& scene;
    const FrameHashes& hashes;
    const FrameSettings& settings;
    const OutputName& output;
    const OutputName& preview;  // empty text: none
    const std::vector<int>& frames;
    std::shared_ptr<const LayerNames> layer_names = std::make_shared<const LayerNames>();
    /// Called for each frame whose files are whole, in the film's order, on any thread, one at a time.
    FrameSink written = {};
    /// Called with the frames that are next, and the one before them, in stretches of the length below. Returns a
    /// warning or nothing, and throws for what keeps them from being rendered or written. The first stretch is the
    /// caller's.
    std::function<std::string(const std::vector<int>&)> look_ahead = {};
    /// Asks for snapshots of the frame in work (snapshots.h); null: nothing does.
    UserSignal* snapshot_signal = nullptr;
};

/// What the header of a frame's file says, beyond what its channels say.
Attributes attributes_of(const FilmJob& job, const CameraFrame& camera);

/// The layers that have files of their own.
std::vector<std::string> layers_with_files(const FilmJob& job);

/// Number of frames whose cameras and file names are looked at together before the first of them is rendered.
inline constexpr size_t stretch_length = 1000;

/// Renders and writes all frames, and adds to stats.totals and stats.resumed. Throws Error: `failed` if a frame's flags
/// make it unreliable (its file is not written), `file` if a file cannot be written, `interrupted` if progress.stop was
/// set from outside (frames finished by then are complete).
void render_film(const FilmJob& job, Renderer& renderer, RenderProgress& progress, RunStats& stats);

/// Limits for frames being written while others render.
WriterLimits writer_limits(const FilmOptions& options, size_t frames);

/// Renders a frame; again with larger tables of objects where a pixel shows more than they hold, which the settings
/// then keep for the next frame. False if it was stopped; the film is then incomplete.
bool render_frame(Renderer& renderer, const CameraFrame& camera, FrameSettings& settings, Film& film,
                  RenderProgress& progress);

/// The reason why a film of a scene with these flags (RenderFlag bits) is unreliable, for a message; empty for 0.
std::string describe_flags(uint32_t flags, const SceneDescription& scene);

}  // namespace cistula
