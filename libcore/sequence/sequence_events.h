// What happens to a sequence of frames while it renders, as it is told to whoever asked for it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace cistula {

struct FrameSettings;
struct FrameStats;
struct RunStats;

/// How a program shows its progress. `automatic`: on a terminal a line that is redrawn, elsewhere a line every 30 s.
/// `plain`: a line every 10 s and at milestones. `json` and `openjd`: records for other programs on standard output.
enum class ProgressStyle { automatic, plain, none, json, openjd };

/// Whether a style is for other programs to read.
constexpr bool is_for_programs(ProgressStyle style) {
    return style == ProgressStyle::json || style == ProgressStyle::openjd;
}

/// Receives what happens to a sequence, on any thread, one call at a time for each member. The library prints nothing
/// itself. What these throw ends the sequence.
class SequenceEvents {
  public:
    virtual ~SequenceEvents() = default;

    /// What the frames will be rendered with, before anything is compiled or written.
    virtual void planned(const FrameSettings&) {}
    /// A scene is compiled and its renderer made: what is known of them.
    virtual void ready(const RunStats&) {}
    /// The files that the scene names, its meshes, their libraries and maps, which may be missing.
    virtual void read(const std::vector<std::string>& /*files*/) {}
    /// A sequence of so many frames, of which some may be complete.
    virtual void begin(size_t /*frames*/) {}
    /// A frame that is complete since an earlier run.
    virtual void kept(int /*frame*/, const std::string& /*file*/) {}
    /// A frame's first ray. It is at `index` of the `count` frames to render.
    virtual void begin_frame(int /*frame*/, size_t /*index*/, size_t /*count*/, uint64_t /*pixels*/) {}
    /// A frame's last ray. Its stats lack what depends on its files.
    virtual void end_frame(const FrameStats&) {}
    /// A frame whose files are whole, in the sequence's order. What it throws is a failed write.
    virtual void written(const FrameStats&) {}
    /// A file with the part of a frame that is done, `fraction` of its pixels.
    virtual void snapshot(int /*frame*/, const std::string& /*file*/, double /*fraction*/) {}
    /// A line on something that may be wrong with the pictures, or that may interest.
    virtual void warning(const std::string& /*line*/) {}
    virtual void remark(const std::string& /*line*/) {}
    /// All that could be rendered is written, `done` of its frames; the last event.
    virtual void end(const RunStats&, size_t /*done*/, size_t /*frames*/) {}
};

}  // namespace cistula
