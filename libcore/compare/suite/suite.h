// Suites of golden images: suite.json as it is read (docs/regression.md).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "compare/metrics/compare.h"
#include "render/picture_size.h"
#include "render/record/film_picture.h"
#include "sequence/backends.h"
#include "sequence/frame_list.h"
#include "sequence/render_request.h"

namespace cistula {

/// A picture, with the keys of a request that change it, and what is expected of it.
struct SuiteCase : RenderRequest {
    Thresholds thresholds;
    std::vector<Backend> backends = {Backend::embree};
    std::vector<std::string> tags;
    std::string name;
    std::string place;                     // in suite.json: "/cases/3"
    std::string golden;                    // as given: an EXR, with a pattern for several frames; or empty
    std::string rendered;                  // as golden: what another program rendered; or empty
    std::vector<std::string> command;      // words of a command that renders to {output}; or empty
    std::vector<std::string> hashes;       // of the frames' pictures (picture_hash); or empty
    std::vector<std::string> film_hashes;  // of the frames' films (film_hash); or empty
    std::string recorded_version;          // of Cistula, when the hashes were recorded; or empty
    std::optional<Precision> recorded_precision;

    /// Whether the picture is another program's.
    bool is_foreign() const { return !rendered.empty() || !command.empty(); }
    /// What renders it on a backend, for tables: "embree", "file", "command".
    const char* source_name(Backend backend) const {
        return !rendered.empty() ? "file" : !command.empty() ? "command" : backend_name(backend);
    }
    std::string scene_path(const std::string& folder) const;
    /// The golden file of a frame; empty if there is none.
    std::string golden_path(const std::string& folder, int frame) const;
    std::string rendered_path(const std::string& folder, int frame) const;
};

struct Suite {
    std::string folder;  // as given
    std::string path;    // of suite.json
    std::string name;    // of the folder
    std::string text;    // of suite.json
    std::vector<SuiteCase> cases;
};

/// Reads FOLDER/suite.json. Throws Error: `file` if it cannot be read, `usage` with the JSON pointer, or line and
/// column, if its contents are wrong. Scenes and golden images are not opened.
Suite read_suite(const std::string& folder);

}  // namespace cistula
