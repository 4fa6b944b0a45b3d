// Pictures of a suite's cases, rendered in this process: those that `render` would write.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "compare/suite/suite.h"

namespace cistula {

/// A frame of a case as its file would hold it.
struct SuiteFrame {
    int frame = 0;
    LayeredPicture picture;  // with the header that `render` writes, and rounded to the file's types
    std::string film_hash;
    double seconds = 0;  // of the render alone
    std::vector<std::string> notes;
};

/// A case that is ready to be rendered on a backend. The scene's warnings are among its notes.
struct SuiteScene {
    std::optional<Precision> precision;  // none: another program's
    std::vector<std::string> notes;
    /// Renders a frame. Throws Error: `failed` if it cannot be trusted, `interrupted` if progress.stop was set.
    std::function<SuiteFrame(int frame, RenderProgress& progress)> render;
};

/// Reads and compiles the scene of a case. Throws Error.
SuiteScene prepare_case(const SuiteCase& one, const std::string& folder, Backend backend, const CudaOptions& cuda,
                        StopSignal stop = {});

/// A case whose pictures another program renders. Throws Error (usage) for a command where `run_commands` is false.
SuiteScene prepare_foreign(const SuiteCase& one, const std::string& folder, bool run_commands);

/// The scene of a case, a regular file. Throws Error.
SceneDescription read_scene_of(const SuiteCase& one, const std::string& folder);

/// The settings of a case's frames. Throws Error (usage) if its crop leaves the frame.
FrameSettings settings_of(const SuiteCase& one, const SceneDescription& scene);

}  // namespace cistula
