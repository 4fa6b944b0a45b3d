// Records of a sequence's progress for other programs: lines of JSON, or the messages that Open Job Description
// defines.
#pragma once

#include <cstddef>
#include <string>

#include "apps/common/command_line.h"
#include "apps/common/sequence_progress.h"

namespace cistula {

/// Something that happens to a film. `event`: "read" (the scene), "begin", "frame" (its first ray), "rendered",
/// "written", "kept" (complete since an earlier run), "snapshot", "message" or "end".
struct EventRecord {
    const char* event;
    int frame = -1;         // -1: none
    std::string file = {};  // empty: none
    double fraction = -1;   // of the frame's pixels in a snapshot; negative: none
    std::string text = {};
    std::vector<std::string> files = {};  // of "read"
};

/// Records are one or more lines without the last line end, or empty where the style has none for this.
std::string event_record(ProgressStyle style, const EventRecord& event, const ProgressState& state);

/// The record of a frame under way.
std::string state_record(ProgressStyle style, const ProgressState& state);

/// The record of an error that ends the program.
std::string failure_record(ProgressStyle style, const std::string& message, ExitCode code);

}  // namespace cistula
