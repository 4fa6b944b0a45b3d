#include "scene/readers/scene_formats.h"

#include <algorithm>
#include <cstdint>
#include <span>

#include <fmt/format.h>

#include "base/decimal.h"
#include "base/shown_text.h"
#include "scene/readers/text_tokens.h"

namespace cistula {
namespace {

using namespace std::literals;

constexpr std::string_view wanted =
    "expected JSON, which begins with '{', or the text input, which begins with the number of frames";
constexpr std::string_view of_mesh = R"(a scene names meshes in its "objects", as {"mesh": "FILE"})";
constexpr std::string_view of_picture = R"(a scene names pictures in its "textures", as {"file": "FILE"})";
constexpr std::string_view of_archive = "unpack it first";
constexpr std::string_view of_encoding = "save it as UTF-8";

/// A format that is told by its first bytes or its first word, and advice for who has such a file.
struct Format {
    std::string_view sign, name, advice;
};

constexpr Format by_bytes[] = {
    {"\x89PNG", "a PNG picture", of_picture},
    {"\x76\x2f\x31\x01", "an OpenEXR picture", of_picture},
    {"\xff\xd8\xff", "a JPEG picture", of_picture},
    {"GIF8", "a GIF picture", of_picture},
    {"II*\0"sv, "a TIFF picture", of_picture},
    {"MM\0*"sv, "a TIFF picture", of_picture},
    {"#?RADIANCE", "a Radiance picture", of_picture},
    {"#?RGBE", "a Radiance picture", of_picture},
    {"RIFF", "a RIFF file, as WebP pictures are", of_picture},
    {"\x1f\x8b", "packed by gzip", of_archive},
    {"\x28\xb5\x2f\xfd", "packed by zstd", of_archive},
    {"\xfd"
     "7zXZ",
     "packed by xz", of_archive},
    {"7z\xbc\xaf", "packed by 7-Zip", of_archive},
    {"BZh", "packed by bzip2", of_archive},
    {"PK\x03\x04", "a ZIP archive", of_archive},
    {"%PDF", "a PDF document", wanted},
    {"\x7f"
     "ELF",
     "a program", wanted},
    {"#!", "a script", wanted},
    {"glTF", "a glTF scene", wanted},
    {"BLENDER", "a Blender scene", wanted},
    {"#usda", "a USD scene", wanted},
    {"PXR-USDC", "a USD scene", wanted},
    {"Kaydara FBX", "an FBX scene", wanted},
};

constexpr Format by_word[] = {
    {"ply", "a PLY mesh", of_mesh},
    {"v", "an OBJ mesh", of_mesh},
    {"vn", "an OBJ mesh", of_mesh},
    {"vt", "an OBJ mesh", of_mesh},
    {"f", "an OBJ mesh", of_mesh},
    {"g", "an OBJ mesh", of_mesh},
    {"o", "an OBJ mesh", of_mesh},
    {"s", "an OBJ mesh", of_mesh},
    {"mtllib", "an OBJ mesh", of_mesh},
    {"usemtl", "an OBJ mesh", of_mesh},
    {"newmtl", "an MTL library", "an OBJ mesh names it, and a scene the mesh"},
    {"solid", "an STL mesh", "convert it to PLY or OBJ, which a scene names in its \"objects\""},
    {"OFF", "an OFF mesh", "convert it to PLY or OBJ, which a scene names in its \"objects\""},
    {"#include", "a POV-Ray scene", wanted},
    {"#declare", "a POV-Ray scene", wanted},
    {"#version", "a POV-Ray scene", wanted},
    {"#local", "a POV-Ray scene", wanted},
    {"#macro", "a POV-Ray scene", wanted},
    {"#default", "a POV-Ray scene", wanted},
    {"global_settings", "a POV-Ray scene", wanted},
    {"background", "a POV-Ray scene", wanted},
    {"camera", "a POV-Ray scene", wanted},
    {"light_source", "a POV-Ray scene", wanted},
    {"sphere", "a POV-Ray scene", wanted},
    {"plane", "a POV-Ray scene", wanted},
    {"box", "a POV-Ray scene", wanted},
    {"union", "a POV-Ray scene", wanted},
    {"LookAt", "a pbrt scene", wanted},
    {"Film", "a pbrt scene", wanted},
    {"Camera", "a pbrt scene", wanted},
    {"Integrator", "a pbrt scene", wanted},
    {"WorldBegin", "a pbrt scene", wanted},
    {"P1", "a PNM picture", of_picture},
    {"P2", "a PNM picture", of_picture},
    {"P3", "a PNM picture", of_picture},
    {"P5", "a PNM picture", of_picture},
    {"P6", "a PNM picture", of_picture},
    {"---", "a YAML document", wanted},
};

std::string is(const Format& format) {
    return fmt::format("is {}; {}", format.name, format.advice);
}

/// Whether bytes without a byte order mark are UTF-16: mostly ASCII, each with a zero byte beside it.
bool is_utf16(std::string_view bytes, bool big_endian) {
    const size_t count = std::min<size_t>(bytes.size() / 2, 64);
    size_t ascii = 0;
    for (size_t i = 0; i < count; ++i) {
        const char high = bytes[2 * i + (big_endian ? 0 : 1)];
        const char low = bytes[2 * i + (big_endian ? 1 : 0)];
        if (high == 0 && low == 0) return false;
        ascii += high == 0 && (low >= ' ' || blanks.find(low) != std::string_view::npos);
    }
    return count > 0 && 4 * ascii > 3 * count;
}

std::string_view encoding_of(std::string_view start) {
    if (start.starts_with("\xff\xfe\0\0"sv) || start.starts_with("\0\0\xfe\xff"sv) || start.starts_with("{\0\0\0"sv) ||
        start.starts_with("\0\0\0{"sv))
        return "UTF-32";
    const bool marked = start.starts_with("\xff\xfe") || start.starts_with("\xfe\xff");
    return marked || is_utf16(start, false) || is_utf16(start, true) ? "UTF-16" : "";
}

bool is_binary(std::string_view start) {
    return std::any_of(start.begin(), start.end(), [](char c) {
        return static_cast<unsigned char>(c) < 0x20 && blanks.find(c) == std::string_view::npos;
    });
}

/// Removes white space from the front.
void skip_blanks(std::string_view& text) {
    text.remove_prefix(std::min(text.find_first_not_of(blanks), text.size()));
}

/// Removes comments from the front: those of JSON and POV-Ray, and lines that begin with # and a blank.
void skip_comments(std::string_view& text) {
    skip_blanks(text);
    for (size_t before = 0; before != text.size();) {
        before = text.size();
        const bool is_block = text.starts_with("/*");
        if (is_block || text.starts_with("//") ||
            (text.starts_with('#') && blanks.find(text[1 % text.size()]) != text.npos)) {
            const size_t end = text.find(is_block ? "*/" : "\n");
            text.remove_prefix(end == text.npos ? text.size() : end + (is_block ? 2 : 1));
        }
        skip_blanks(text);
    }
}

std::string_view first_word(std::string_view text) {
    return text.substr(0, text.find_first_of(blanks));
}

std::string markup(std::string_view text) {
    std::string start(text.substr(0, 64));
    for (char& c : start)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    const bool html = start.starts_with("<!doctype html") || start.starts_with("<html");
    return is({"", html ? "an HTML page" : "an XML document", wanted});
}

}  // namespace

std::string no_scene_because(std::string_view start) {
    for (const Format& format : by_bytes)
        if (start.starts_with(format.sign)) return is(format);
    if (const std::string_view encoding = encoding_of(start); !encoding.empty()) return is({"", encoding, of_encoding});
    skip_blanks(start);
    if (start.empty() || start[0] == '{' || decimal<double>(first_word(start))) return "";
    if (is_binary(start)) return is({"", "binary data", wanted});
    std::string_view text = start;
    skip_comments(text);
    if (text.starts_with('<')) return markup(text);
    std::string_view word = first_word(text);
    word = word.substr(0, word.find('{'));  // camera{
    for (const Format& format : by_word)
        if (word == format.sign) return is(format);
    return "";
}

}  // namespace cistula
