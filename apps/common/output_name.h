// File names with a place for the frame number: beauty.####.exr, beauty.%04d.exr, frame%d.out.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "scene/description/description.h"

namespace cistula {

/// A file name, or a pattern of one. A run of # is the frame number with at least as many digits, %d and %0Nd are
/// printf's, %% is a percent sign.
class OutputName {
  public:
    OutputName() = default;

    /// `option` is what the messages blame ("-o"). Throws Error (usage) where the text holds two patterns or another
    /// conversion.
    OutputName(std::string_view text, std::string_view option);

    bool has_pattern() const { return digits_ >= 0; }
    std::string for_frame(int frame) const;
    const std::string& text() const { return text_; }

  private:
    std::string text_, prefix_, suffix_;
    int digits_ = -1;  // least number of digits; -1: no pattern
};

enum class FileKind {
    exr,
    raw,  // the seed's frames: .out or .data
};

/// By the extension, case ignored. Throws Error (usage) for any other.
FileKind file_kind(const std::string& path);

/// Where no -o is given: the scene's own film.output if it names one, else SCENE.exr in the working directory, or
/// SCENE.####.exr where several frames were asked for by name. A scene from standard input is called "stdin".
std::string default_output(const SceneDescription& scene, size_t frames_given);

/// The frames to render: those given; else all of the film with a pattern, the first without one. Throws Error (usage)
/// where several are given for a name that holds one.
std::vector<int> frames_to_render(const OutputName& output, const std::vector<int>& given, int film_frames);

/// Makes the directories of these frames where they are missing. Throws Error (file) where that fails or the first name
/// is a directory's: better now than after an hour of rendering.
void make_directories(const OutputName& name, const std::vector<int>& frames);

/// Makes the directory of a single file in the same way.
void make_directory_of(const std::string& path);

/// Throws Error (usage) where two of these would be one file, symbolic links followed: the scene, the stats, the images
/// and previews of all frames. `stats` may be empty, `scene` "-"; `option` is what names the stats.
void require_different_files(const std::string& scene, const OutputName& image, const OutputName& preview,
                             const std::string& stats, const std::vector<int>& frames, const char* option = "--stats");

}  // namespace cistula
