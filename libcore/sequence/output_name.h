// File names with a place for the frame number: beauty.####.exr, beauty.%04d.exr, frame%d.out.
#pragma once

#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "scene/description/description.h"
#include "sequence/frame_list.h"
#include "sequence/run_files.h"

namespace cistula {

/// A file name or a pattern of file names. A run of # after the last / is replaced by the frame number with at least as
/// many digits; %d and %0Nd are as in printf; %% is a percent sign.
class OutputName {
  public:
    OutputName() = default;

    /// `option` names it in messages ("`output`"). Throws Error (usage) if the text holds two patterns or another
    /// conversion.
    OutputName(std::string_view text, std::string_view option);

    bool has_pattern() const { return digits_ >= 0; }
    std::string for_frame(int frame) const;

    /// This name with another word before the frame number or the extension: beauty.tile07.####.exr, beauty.tile07.exr.
    OutputName named(const std::string& word) const;

    /// The name of a file that a layer has for itself: beauty.diffuse.0001.exr, beauty.diffuse.exr.
    std::string for_layer(int frame, const std::string& layer) const { return named(layer).for_frame(frame); }
    const std::string& text() const { return text_; }

  private:
    std::string text_, prefix_, suffix_;
    int digits_ = -1;   // least number of digits; -1: not a pattern
    size_t place_ = 0;  // of the pattern in the text
};

enum class FileKind {
    exr,
    raw,  // the seed's format: .out or .data
};

/// The kind of a file by its extension, case ignored. Throws Error (usage) for unknown ones.
FileKind file_kind(const std::string& path);

/// The output if no -o is given: the scene's film.output if it has one, else SCENE.exr in the working directory, or
/// SCENE.####.exr if several frames were given explicitly. A scene from standard input is named "stdin".
std::string default_output(const SceneDescription& scene, size_t frames_given);

/// The frames to render: those given; by default all of the scene's for a pattern, the first frame for a plain name.
/// Throws Error (usage) if several frames are given for a plain name.
std::vector<int> frames_to_render(const OutputName& output, const std::vector<int>& given, int film_frames);

/// The name of previews of these frames; an empty text is none. Throws Error (usage).
OutputName preview_name(const std::string& text, const std::vector<int>& frames);

/// The frame numbers that stand in a path, in whole or as a part of a longer number.
std::set<int> numbers_in(const std::string& path);

/// The frames of a list whose file could be one of these paths: those whose numbers stand in one, in whole or as a part
/// of a longer number.
std::vector<int> frames_named_in(const std::vector<std::string>& paths, const std::vector<int>& frames);

/// Creates missing directories for these frames. Throws Error (file) if that fails or the first name is a directory, so
/// that the error is found before rendering.
void make_directories(const OutputName& name, const std::vector<int>& frames);

/// Creates the directory of a single file if it is missing. Throws Error (file) if that fails.
void make_directory_of(const std::string& path);

/// The file of a snapshot of a frame in work, beside its own: beauty.snapshot.0001.exr.
std::string snapshot_of(const OutputName& image, int frame);

/// Throws Error (usage) if two files are one: `others`, the images, snapshots and previews of these frames, and the
/// files of layers that have their own.
void require_different_files(RunFiles others, const OutputName& image, const OutputName& preview,
                             const std::vector<int>& frames, const std::vector<std::string>& layers = {});

}  // namespace cistula
