#include "base/shown_text.h"

#include <algorithm>
#include <cstdint>
#include <vector>

#include <fmt/format.h>

namespace cistula {
namespace {

struct Character {
    uint32_t code = 0;
    size_t length = 1;      // bytes
    bool is_valid = false;  // otherwise one byte that does not belong to any character
};

/// The first character of UTF-8, which must not be empty. No overlong forms, no halves of UTF-16's pairs.
Character first_character(std::string_view text) {
    const auto byte = [&](size_t i) { return static_cast<uint32_t>(static_cast<unsigned char>(text[i])); };
    const uint32_t first = byte(0);
    if (first < 0x80) return {first, 1, true};
    const size_t length = first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : 2;
    if (first < 0xc2 || first > 0xf4 || text.size() < length) return {first};
    uint32_t code = first & (0xffu >> (length + 1));
    for (size_t i = 1; i < length; ++i) {
        if ((byte(i) & 0xc0) != 0x80) return {first};
        code = code << 6 | (byte(i) & 0x3f);
    }
    const bool overlong = code < (length == 4 ? 0x10000u : length == 3 ? 0x800u : 0x80u);
    if (overlong || (code >= 0xd800 && code < 0xe000) || code > 0x10ffff) return {first};
    return {code, length, true};
}

/// Whether a character beyond ASCII controls a terminal, ends a line, changes the direction of writing, or is none of
/// XML's.
bool is_control(uint32_t code) {
    return (code >= 0x80 && code < 0xa0) || code == 0x61c || code == 0x200e || code == 0x200f ||
           (code >= 0x2028 && code <= 0x202e) || (code >= 0x2066 && code <= 0x2069) || code == 0xfeff ||
           (code & 0xfffe) == 0xfffe;
}

std::string shown(const Character& character, std::string_view bytes) {
    const uint32_t code = character.code;
    if (code == '\n') return "\\n";
    if (code == '\t') return "\\t";
    if (!character.is_valid || code < 0x20 || code == 0x7f) return fmt::format("\\x{:02x}", code);
    if (is_control(code)) return fmt::format("\\u{:04x}", code);
    return std::string(bytes);
}

}  // namespace

bool is_utf8(std::string_view text) {
    while (!text.empty()) {
        const Character character = first_character(text);
        if (!character.is_valid) return false;
        text.remove_prefix(character.length);
    }
    return true;
}

std::string utf8_name(std::string_view text) {
    constexpr std::string_view digits = "0123456789ABCDEF";
    constexpr std::string_view digits_of_bytes = digits.substr(8);
    std::string name;
    while (!text.empty()) {
        const Character character = first_character(text);
        const std::string_view next = text.substr(1, 2);
        const bool is_escape =
            character.code == '%' && next.size() == 2 &&
            (next == "25" || (digits_of_bytes.find(next[0]) != next.npos && digits.find(next[1]) != next.npos));
        if (is_escape || !character.is_valid)
            name += fmt::format("%{:02X}", character.code);
        else
            name += text.substr(0, character.length);
        text.remove_prefix(character.length);
    }
    return name;
}

std::string one_line(std::string_view text) {
    return first_characters(text, text.size());
}

std::string first_characters(std::string_view text, size_t most) {
    std::string line;
    for (size_t count = 0; !text.empty() && count < most; ++count) {
        const Character character = first_character(text);
        line += shown(character, text.substr(0, character.length));
        text.remove_prefix(character.length);
    }
    return line;
}

std::string quoted(std::string_view word) {
    constexpr size_t longest = 40;
    constexpr size_t bytes_of_a_character = 4;
    const std::string start = first_characters(word, longest);
    const bool is_whole = word.size() <= longest * bytes_of_a_character && start == first_characters(word, longest + 1);
    return fmt::format("'{}{}'", start, is_whole ? "" : "...");
}

std::string shell_word(std::string_view text) {
    std::string word = "'";
    for (const char c : text) word += c == '\'' ? "'\\''" : std::string(1, c);
    return word + "'";
}

std::string message_line(std::string_view message) {
    constexpr size_t part = 2000;
    std::string line = one_line(message);
    if (line.size() <= 2 * part) return line;
    std::vector<size_t> starts;  // of the line's characters
    for (size_t at = 0; at < line.size(); ++at)
        if ((static_cast<unsigned char>(line[at]) & 0xc0) != 0x80) starts.push_back(at);
    if (starts.size() <= 2 * part) return line;
    return line.substr(0, starts[part]) + " ... " + line.substr(starts[starts.size() - part]);
}

}  // namespace cistula
