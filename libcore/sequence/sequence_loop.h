// The loop over the frames of a sequence: they are rendered one after the other, and each is written while the next
// ones render.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "render/renderer.h"
#include "scene/description/description.h"
#include "sequence/frame_list.h"
#include "sequence/frame_writer.h"
#include "sequence/output_name.h"
#include "sequence/render_request.h"
#include "sequence/sequence_events.h"
#include "sequence/stats.h"

namespace cistula {

class SnapshotRequests;

/// The parameters shared by all frames.
struct SequenceJob {
    const RenderRequest& request;
    const SceneDescription& scene;
    const FrameHashes& hashes;
    const FrameSettings& settings;
    const OutputName& output;
    const OutputName& preview;  // empty text: none
    const std::vector<int>& frames;
    SequenceEvents& events;
    Precision precision = Precision::single_;
    std::shared_ptr<const LayerNames> layer_names = std::make_shared<const LayerNames>();
    /// Called with the frames that are next, and the one before them, in stretches of the length below. Returns a
    /// warning or nothing, and throws for what keeps them from being rendered or written. The first stretch is the
    /// caller's.
    std::function<std::string(const std::vector<int>&)> look_ahead = {};
    StatsFile* stats_file = nullptr;  // receives the written frames; null: nobody asked
    /// Asks for snapshots of the frame in work (snapshots.h); null: nothing does.
    SnapshotRequests* snapshot_requests = nullptr;
};

/// What the header of a frame's file says, beyond what its channels say.
Attributes attributes_of(const SequenceJob& job, const CameraFrame& camera);

/// The layers that have files of their own.
std::vector<std::string> layers_with_files(const SequenceJob& job);

/// Number of frames whose cameras and file names are looked at together before the first of them is rendered.
inline constexpr size_t stretch_length = 1000;

/// Renders and writes all frames, and adds to stats.totals and stats.resumed. Throws Error: `failed` if a frame's flags
/// make it unreliable (its file is not written), `file` if a file cannot be written, `interrupted` if progress.stop was
/// set from outside (frames finished by then are complete).
void render_frames(const SequenceJob& job, Renderer& renderer, RenderProgress& progress, RunStats& stats);

/// Limits for frames being written while others render.
WriterLimits writer_limits(Backend backend, size_t frames);

}  // namespace cistula
