#include "sequence/output_name.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <numeric>
#include <regex>
#include <set>

#include "base/error.h"
#include "base/file_bytes.h"

namespace cistula {
namespace {

namespace fs = std::filesystem;

constexpr int most_digits = 32;
constexpr size_t longest_name = 255;  // of a file, by the system; std::regex recurses

/// The place of the frame number as other programs write it, or "".
std::string other_pattern(std::string_view text) {
    static const std::regex pattern(R"(\$F[0-9]*(?![A-Za-z_])|@@+|[<{](frame|FRAME)[^<>{}]*[>}]|<[fF][0-9]*>)");
    std::cmatch found;
    const std::string_view file = text.substr(text.find_last_of('/') + 1).substr(0, longest_name);
    return std::regex_search(file.data(), file.data() + file.size(), found, pattern) ? found.str() : "";
}

/// Creates the directory of a file.
void make_directory(const std::string& path) {
    const fs::path directory = fs::path(path).parent_path();
    if (directory.empty()) return;
    std::error_code error;
    fs::create_directories(directory, error);
    if (error)
        throw Error(
            ErrorKind::file,
            fmt::format("cannot be written: the directory {} cannot be made: {}", directory.string(), error.message()),
            "give another")
            .at(path);
}

}  // namespace

OutputName::OutputName(std::string_view text, std::string_view option) : text_(text) {
    const auto fail = [&](const std::string& problem, const std::string& remedy = "") {
        throw Error(ErrorKind::usage, fmt::format("{} {}: {}", option, text, problem), remedy);
    };
    if (text.empty()) throw Error(ErrorKind::usage, fmt::format("{}: the file name is empty", option));
    if (const std::string other = other_pattern(text); !other.empty()) {
        std::string right(text);
        right.replace(right.rfind(other), other.size(), "####");
        fail(other + " is no place for the frame number here", "#### or %04d is, as in " + right);
    }
    std::string* part = &prefix_;
    const auto place = [&](int digits) {
        if (has_pattern()) fail("two places for the frame number", "a name has one, #### or %04d");
        if (digits > most_digits) fail(fmt::format("a frame number of more than {} digits", most_digits));
        digits_ = digits;
        part = &suffix_;
    };
    const size_t file = text.rfind('/') + 1;  // npos + 1 is 0
    for (size_t i = 0; i < text.size();) {
        if (!has_pattern()) place_ = i;
        if (text[i] == '#' && i >= file) {
            size_t end = i;
            while (end < text.size() && text[end] == '#') ++end;
            place(static_cast<int>(std::min<size_t>(end - i, most_digits + 1)));
            i = end;
        } else if (text[i] == '%') {
            if (i + 1 < text.size() && text[i + 1] == '%') {
                *part += '%';
                i += 2;
                continue;
            }
            size_t end = i + 1;
            int digits = 1;
            if (end < text.size() && text[end] == '0') {
                digits = 0;
                while (end < text.size() && text[end] >= '0' && text[end] <= '9')
                    digits = std::min(digits * 10 + (text[end++] - '0'), most_digits + 1);
            }
            if (end >= text.size() || text[end] != 'd')
                fail("after % only d, as in %d or %04d, or another % for a percent sign");
            place(std::max(digits, 1));
            i = end + 1;
        } else {
            *part += text[i++];
        }
    }
}

std::string OutputName::for_frame(int frame) const {
    return has_pattern() ? fmt::format("{}{:0{}d}{}", prefix_, frame, digits_, suffix_) : prefix_;
}

OutputName OutputName::named(const std::string& word) const {
    OutputName name = *this;
    if (has_pattern() && suffix_.find('/') == std::string::npos) {
        const char before = prefix_.empty() ? '/' : prefix_.back();
        const bool separates = std::string_view("._- ").find(before) != std::string_view::npos;
        std::string added = word + (separates ? before : '.');
        if (!separates && before != '/') added.insert(0, 1, '.');
        name.prefix_ += added;
        name.text_.insert(place_, added);
        name.place_ += added.size();
    } else {
        std::string& last = has_pattern() ? name.suffix_ : name.prefix_;
        const size_t extension = fs::path(last).extension().string().size();
        last.insert(last.size() - extension, '.' + word);
        name.text_.insert(text_.size() - extension, '.' + word);
    }
    return name;
}

FileKind file_kind(const std::string& path) {
    const std::string extension = lower_extension(path);
    if (extension == ".exr") return FileKind::exr;
    if (extension == ".out" || extension == ".data") return FileKind::raw;
    throw Error(
        ErrorKind::usage,
        fmt::format("`output` {}: images are written as .exr, or as the seed's raw frames .out and .data", path),
        extension == ".png" ? "for a PNG add `preview` FILE.png" : "name it *.exr");
}

std::string default_output(const SceneDescription& scene, size_t frames_given) {
    if (!scene.film.output.empty()) return scene.film.output;
    const std::string stem = scene.source == "-" ? "stdin" : fs::path(scene.source).stem().string();
    std::string name;
    for (const char c : stem) name += c == '%' ? "%%" : std::string(1, c == '#' ? '_' : c);
    return name + (frames_given > 1 ? ".####.exr" : ".exr");
}

std::vector<int> frames_to_render(const OutputName& output, const std::vector<int>& given, int film_frames) {
    if (!output.has_pattern() && given.size() > 1) {
        fs::path better = output.text();
        better.replace_extension(".####" + better.extension().string());
        throw Error(ErrorKind::usage,
                    fmt::format("`output` {} holds one frame and `frames` names {}", output.text(), given.size()),
                    fmt::format("put the frame number into the name, as in `output` {}", better.string()));
    }
    if (!given.empty()) return given;
    std::vector<int> film(static_cast<size_t>(output.has_pattern() ? std::max(film_frames, 1) : 1));
    std::iota(film.begin(), film.end(), 0);
    return film;
}

OutputName preview_name(const std::string& text, const std::vector<int>& frames) {
    if (text.empty()) return OutputName();
    OutputName name(text, "`preview`");
    if (std::filesystem::path(text).extension() != ".png")
        throw Error(ErrorKind::usage, fmt::format("`preview` {}: a preview is a PNG", text), "name it *.png");
    if (frames.size() > 1 && !name.has_pattern())
        throw Error(ErrorKind::usage, fmt::format("`preview` {}: holds one frame of {}", text, frames.size()),
                    "put #### into the name");
    return name;
}

std::set<int> numbers_in(const std::string& path) {
    std::set<int> numbers;
    const auto is_digit = [&](size_t i) { return i < path.size() && path[i] >= '0' && path[i] <= '9'; };
    for (size_t begin = 0; begin < path.size(); ++begin) {
        int number = 0;
        for (size_t i = begin; is_digit(i); ++i) {
            number = number * 10 + (path[i] - '0');
            if (number > largest_frame) break;
            numbers.insert(number);
        }
    }
    return numbers;
}

std::vector<int> frames_named_in(const std::vector<std::string>& paths, const std::vector<int>& frames) {
    std::set<int> numbers;
    for (const std::string& path : paths) numbers.merge(numbers_in(path));
    std::vector<int> named;
    std::copy_if(frames.begin(), frames.end(), std::back_inserter(named),
                 [&](int frame) { return numbers.contains(frame); });
    return named;
}

std::string snapshot_of(const OutputName& image, int frame) {
    return image.text().empty() ? "" : image.for_layer(frame, "snapshot");
}

void require_different_files(RunFiles others, const OutputName& image, const OutputName& preview,
                             const std::vector<int>& frames, const std::vector<std::string>& layers) {
    for (const int frame : frames) {
        others.writes(image.for_frame(frame), "an image");
        others.writes(snapshot_of(image, frame), "a snapshot");
        for (const std::string& layer : layers) others.writes(image.for_layer(frame, layer), "a layer's image");
        others.writes(preview.for_frame(frame), "a preview");
    }
}

void make_directory_of(const std::string& path) {
    make_directory(path);
    std::error_code error;
    if (fs::is_directory(path, error))
        throw Error(ErrorKind::file, "cannot be written: it is a directory", "name a file in it").at(path);
}

void make_directories(const OutputName& name, const std::vector<int>& frames) {
    make_directory_of(name.for_frame(frames.front()));
    for (const int frame : frames) make_directory(name.for_frame(frame));
}

}  // namespace cistula
