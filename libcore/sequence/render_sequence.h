// A request carried out: its scene read and compiled, its frames rendered and written.
#pragma once

#include "render/scene.h"
#include "scene/compile/scene_source.h"
#include "sequence/render_request.h"
#include "sequence/sequence_events.h"
#include "sequence/stats.h"

namespace cistula {

class SnapshotRequests;

/// Renders all frames of a request and writes them, with its previews and statistics. Checks all that can be checked
/// before the first ray; files are whole or not there. progress.stop, set from outside, ends it; `snapshots` asks for
/// files of the frame in work. Warnings and remarks are events. Throws Error: interrupted with what is left to do,
/// target if pixels missed it, failed for a frame that cannot be trusted, and whatever the request, the scene or a file
/// has wrong.
RunStats render_sequence(const RenderRequest& request, SequenceEvents& events, RenderProgress& progress,
                         SnapshotRequests* snapshots = nullptr);

/// The precision that the request or else the scene asks for; tells where the scene decides it.
PrecisionChoice told_precision(const RenderRequest& request, const SceneSource& source, SequenceEvents& events);

/// Compiles a scene in that precision, and tells what it found.
Scene compile_for(const RenderRequest& request, SceneSource source, SequenceEvents& events);

/// Number of threads that a request takes.
int threads_of(const RenderRequest& request);

}  // namespace cistula
