#include "scene/readers/read_scene.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>

#include <fmt/format.h>

#include "scene/base/error.h"
#include "scene/base/suggest.h"
#include "scene/readers/read_json.h"
#include "scene/readers/read_text_input.h"

namespace cistula {
namespace {

std::string read_all(std::istream& stream, const std::string& name) {
    std::string text{std::istreambuf_iterator<char>(stream), {}};
    if (stream.bad()) throw Error(ExitCode::file, one_line(fmt::format("{}: cannot be read to its end", name)));
    return text;
}

std::string read_file(const std::string& path) {
    std::error_code ignored;
    if (std::filesystem::is_directory(path, ignored))
        throw Error(ExitCode::file, one_line(fmt::format("{}: is a folder; expected a scene file", path)));
    errno = 0;
    std::ifstream stream(path, std::ios::binary);
    if (!stream) {
        const char* reason = errno != 0 ? std::strerror(errno) : "the file does not open";
        throw Error(ExitCode::file, one_line(fmt::format("{}: cannot read the scene: {}", path, reason)));
    }
    return read_all(stream, path);
}

}  // namespace

SceneDescription read_scene(const std::string& path) {
    if (path == "-") return read_scene_text(read_all(std::cin, "standard input"), path, "");
    return read_scene_text(read_file(path), path, std::filesystem::path(path).parent_path().string());
}

SceneDescription read_scene_text(const std::string& text, const std::string& source_name, const std::string& base_dir) {
    const std::string label = source_name == "-" ? "standard input" : source_name;
    constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
    const size_t start = text.starts_with(byte_order_mark) ? byte_order_mark.size() : 0;
    const size_t first = text.find_first_not_of(" \t\r\n\v\f", start);
    if (first == std::string::npos)
        throw Error(
            ExitCode::usage,
            one_line(fmt::format("{}: the scene is empty; expected JSON or the text of --print-template", label)));
    if (text[first] == '/' || text[first] == '[')
        throw Error(ExitCode::usage, one_line(fmt::format("{}: a JSON scene begins with '{{', found '{}'; comments may "
                                                          "stand anywhere after it",
                                                          label, text[first])));
    SceneDescription scene = text[first] == '{' ? read_json_scene(text, label, base_dir)
                                                : read_text_input(text.substr(start), label, base_dir);
    scene.source = source_name;
    return scene;
}

}  // namespace cistula
