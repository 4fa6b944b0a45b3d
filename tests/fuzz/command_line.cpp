// Command lines, one word a line. The first line is the program's name: render, render-compare or render-merge.
#include <algorithm>
#include <string_view>
#include <vector>

#include "apps/common/render_options.h"
#include "apps/render_compare/options.h"
#include "apps/render_compare/suite_options.h"
#include "apps/render_merge/options.h"
#include "checks.h"
#include "sequence/output_name.h"
#include "target.h"

FUZZ_TARGET(command_line) {
    using namespace cistula;
    const std::string text(reinterpret_cast<const char*>(data), std::find(data, data + size, 0) - data);
    std::vector<std::string> words;
    for (size_t begin = 0; begin <= text.size();) {
        const size_t end = std::min(text.find('\n', begin), text.size());
        words.push_back(text.substr(begin, end - begin));
        begin = end + 1;
    }
    std::vector<const char*> arguments;
    for (const std::string& word : words) arguments.push_back(word.c_str());
    const auto count = static_cast<int>(arguments.size());
    try {
        if (words[0] == "render-compare" && count > 1 && words[1] == "suite") {
            parse_suite_options(count - 1, arguments.data() + 1);
        } else if (words[0] == "render-compare") {
            parse_compare_options(count, arguments.data());
        } else if (words[0] == "render-merge") {
            parse_merge_options(count, arguments.data());
        } else {
            const RenderCommand options = parse_options(count, arguments.data());
            fuzz::require(options.frames.size() <= most_frames);
            SceneDescription scene;
            scene.source = options.scene;
            if (options.action != Action::render) return 0;
            const FrameSettings settings = frame_settings(options, scene);
            fuzz::require(settings.crop.x >= 0 && settings.crop.x + settings.crop.width <= settings.full_width);
            fuzz::require(settings.crop.y >= 0 && settings.crop.y + settings.crop.height <= settings.full_height);
            const OutputName name(
                options.output.empty() ? default_output(scene, options.frames.size()) : options.output, "-o");
            file_kind(name.text());
            const std::vector<int> frames = frames_to_render(name, options.frames, 300);
            fuzz::require(!frames.empty());
            if (frames.size() > 1) fuzz::require(name.for_frame(frames[0]) != name.for_frame(frames[1]));
            fuzz::require(parse_frames(format_frames(frames)) == frames);
        }
    } catch (const Error& error) {
        fuzz::require(error.kind() == ErrorKind::usage || error.kind() == ErrorKind::device ||
                      error.kind() == ErrorKind::file);
        fuzz::check_line(error.what());
    }
    return 0;
}
