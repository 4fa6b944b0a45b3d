// Where the time of a program's main thread goes: the thread is in exactly one stage at any time, so that the stages
// add up to its run.
#pragma once

#include <array>
#include <cstddef>

namespace cistula {

/// What the main thread does or waits for.
enum class Stage {
    start,     // the process: its libraries, the command line
    read,      // files: the scene, its meshes and pictures; frames that are there already
    compile,   // the scene to arrays
    tree,      // trees over the scene
    device,    // waiting for devices: their contexts, kernels, memory
    upload,    // the scene to devices
    plan,      // of frames: what they show where
    render,    // rays, or waiting for devices that trace them
    transfer,  // frames from devices to the host
    write,     // waiting for frames that are made into pictures, compressed and written
    end,       // memory and devices given back
    other,
};
inline constexpr std::array stage_names = {"start", "read",   "compile",  "tree",  "device", "upload",
                                           "plan",  "render", "transfer", "write", "end",    "other"};

using StageSeconds = std::array<double, stage_names.size()>;

/// Makes the calling thread the one whose stages are timed, in Stage::start since the process began. Without this call
/// nothing is timed.
void begin_stages();

/// Ends the stage that the thread is in, and begins one; the stage that ended. On other threads it does nothing.
Stage enter_stage(Stage stage);

/// The times so far.
StageSeconds stage_seconds();

/// A stage for the time of the object, then the one before again.
class InStage {
  public:
    explicit InStage(Stage stage) : before_(enter_stage(stage)) {}
    ~InStage() { enter_stage(before_); }
    InStage(const InStage&) = delete;
    InStage& operator=(const InStage&) = delete;

  private:
    const Stage before_;
};

}  // namespace cistula
