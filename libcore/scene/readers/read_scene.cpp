#include "scene/readers/read_scene.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>

#include <fmt/format.h>

#include "base/decimal.h"
#include "base/default_rounding.h"
#include "base/error.h"
#include "scene/readers/scene_formats.h"
#include "scene/readers/text_tokens.h"

namespace cistula {
namespace {

constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
constexpr size_t start_bytes = 4096;  // that tell what a file is

std::string_view without_mark(std::string_view text) {
    if (text.starts_with(byte_order_mark)) text.remove_prefix(byte_order_mark.size());
    return text;
}

/// Throws if a text that begins so cannot be a scene. `text` may be the first part of one, of several words.
void check_start(std::string_view text, const std::string& label) {
    text = without_mark(text);
    const auto fail = [&label](const std::string& problem, const char* remedy = "") {
        throw Error(ErrorKind::scene, problem, remedy).at(label);
    };
    if (const std::string reason = no_scene_because(text.substr(0, start_bytes)); !reason.empty()) fail(reason);
    text.remove_prefix(std::min(text.find_first_not_of(blanks), text.size()));
    if (text.empty()) fail("the scene is empty", "expected JSON or the text of `print_template`");
    if (text[0] == '/' || text[0] == '[')
        fail(fmt::format("a JSON scene begins with '{{', found '{}'", text[0]), "comments may stand anywhere after it");
    if (text[0] != '{' && !decimal<double>(text.substr(0, text.find_first_of(blanks))))
        read_text_input(std::string(text), label, "");  // throws: it does not begin with a number
}

/// The text of a scene. What cannot be one is refused by its first bytes, so that input without an end has one here.
std::string read_all(std::istream& stream, const std::string& name) {
    std::string text;
    while (text.size() <= largest_scene_bytes) {
        const size_t old_size = text.size();
        const size_t step = std::min(std::max(old_size, start_bytes), largest_scene_bytes + 1 - old_size);
        text.resize(old_size + step);
        stream.read(text.data() + old_size, static_cast<std::streamsize>(step));
        const auto got = static_cast<size_t>(stream.gcount());
        text.resize(old_size + got);
        if (stream.bad()) throw Error(ErrorKind::file, "cannot be read to its end").at(name);
        if (got < step) return text;
        if (old_size == 0 && without_mark(text).find_first_not_of(blanks) != text.npos) check_start(text, name);
    }
    throw Error(ErrorKind::scene,
                fmt::format("is larger than {} MiB, which no scene may be", largest_scene_bytes >> 20),
                "put large meshes into files of their own, PLY or OBJ, and name these in \"objects\"")
        .at(name);
}

std::string read_scene_file(const std::string& path) {
    std::error_code ignored;
    if (std::filesystem::is_directory(path, ignored))
        throw Error(ErrorKind::file, "is a folder", "expected a scene file").at(path);
    errno = 0;
    std::ifstream stream(path, std::ios::binary);
    if (!stream) {
        const char* reason = errno != 0 ? std::strerror(errno) : "the file does not open";
        throw Error(ErrorKind::file, std::string("cannot read the scene: ") + reason).at(path);
    }
    return read_all(stream, path);
}

}  // namespace

SceneDescription read_scene(const std::string& path) {
    if (path == "-") return read_scene_text(read_all(std::cin, "standard input"), path, "");
    return read_scene_text(read_scene_file(path), path, std::filesystem::path(path).parent_path().string());
}

SceneDescription read_scene_text(const std::string& text, const std::string& source_name, const std::string& base_dir) {
    const std::string label = source_name == "-" ? "standard input" : source_name;
    check_start(text, label);
    const std::string_view plain = without_mark(text);
    const bool is_json = plain[plain.find_first_not_of(blanks)] == '{';
    SceneDescription scene = in_default_rounding([&] {
        return is_json ? read_json_scene(text, label, base_dir) : read_text_input(std::string(plain), label, base_dir);
    });
    scene.source = source_name;
    return scene;
}

}  // namespace cistula
