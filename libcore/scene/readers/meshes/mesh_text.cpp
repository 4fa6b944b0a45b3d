#include "scene/readers/meshes/mesh_text.h"

#include <algorithm>
#include <cstdint>

#include "base/shown_text.h"
#include "scene/readers/text_tokens.h"

namespace cistula {
namespace {

void append_utf8(std::string& text, uint32_t code) {
    const auto add = [&text](uint32_t byte) { text += static_cast<char>(byte); };
    if (code < 0x80) return add(code);
    if (code < 0x800) {
        add(0xc0 | code >> 6);
    } else {
        if (code < 0x10000) {
            add(0xe0 | code >> 12);
        } else {
            add(0xf0 | code >> 18);
            add(0x80 | (code >> 12 & 0x3f));
        }
        add(0x80 | (code >> 6 & 0x3f));
    }
    add(0x80 | (code & 0x3f));
}

/// An odd last byte becomes U+FFFD.
std::string utf8_of_utf16(std::string_view bytes, bool big_endian) {
    constexpr uint32_t unknown = 0xfffd;
    const auto unit = [&](size_t i) -> uint32_t {
        if (i + 1 >= bytes.size()) return unknown;
        const auto first = static_cast<uint8_t>(bytes[i]);
        const auto second = static_cast<uint8_t>(bytes[i + 1]);
        return static_cast<uint32_t>(big_endian ? first << 8 | second : second << 8 | first);
    };
    std::string text;
    for (size_t i = 0; i < bytes.size(); i += 2) {
        const uint32_t code = unit(i);
        const uint32_t low = unit(i + 2);
        const bool pair = code >= 0xd800 && code < 0xdc00 && low >= 0xdc00 && low < 0xe000;
        append_utf8(text, pair ? 0x10000 + ((code - 0xd800) << 10) + (low - 0xdc00) : code);
        if (pair) i += 2;
    }
    return text;
}

/// Whether a line goes on in the next. In Shift-JIS, GBK and Big5 a character may end with a backslash.
bool is_continued(std::string_view line) {
    if (!line.ends_with('\\')) return false;
    const bool may_be_half = line.size() > 1 && static_cast<uint8_t>(line[line.size() - 2]) >= 0x80;
    return !may_be_half || is_utf8(line);
}

}  // namespace

std::string utf8_of(std::string bytes) {
    if (bytes.starts_with("\xef\xbb\xbf")) bytes.erase(0, 3);
    if (bytes.starts_with("\xff\xfe")) return utf8_of_utf16(std::string_view(bytes).substr(2), false);
    if (bytes.starts_with("\xfe\xff")) return utf8_of_utf16(std::string_view(bytes).substr(2), true);
    if (bytes.size() >= 2 && (bytes[0] == 0) != (bytes[1] == 0)) return utf8_of_utf16(bytes, bytes[0] == 0);
    return bytes;
}

void split_words(std::string_view line, std::vector<std::string_view>& words) {
    words.clear();
    for (size_t at = 0; (at = line.find_first_not_of(blanks, at)) != std::string_view::npos;) {
        const size_t end = std::min(line.find_first_of(blanks, at), line.size());
        words.push_back(line.substr(at, end - at));
        at = end;
    }
}

std::string_view MeshTextLines::physical_line() {
    ++line_;
    const size_t first = at_;
    const size_t end = std::min(text_.find_first_of("\r\n", at_), text_.size());
    at_ = end + (text_.substr(end, 2) == "\r\n" ? 2 : 1);
    std::string_view line = text_.substr(first, end - first);
    for (size_t mark = line.find('#'); mark != std::string_view::npos; mark = line.find('#', mark + 1))
        if (mark == 0 || blanks.find(line[mark - 1]) != std::string_view::npos) line = line.substr(0, mark);
    return line.substr(0, line.find_last_not_of(blanks) + 1);
}

bool MeshTextLines::next() {
    words_.clear();
    while (words_.empty() && at_ < text_.size()) {
        content_ = physical_line();
        if (is_continued(content_)) {
            joined_.clear();
            while (is_continued(content_)) {
                joined_.append(content_.substr(0, content_.size() - 1)) += ' ';
                content_ = at_ < text_.size() ? physical_line() : std::string_view();
            }
            joined_.append(content_);
            content_ = joined_;
        }
        split_words(content_, words_);
    }
    return !words_.empty();
}

std::string_view MeshTextLines::rest(size_t number) const {
    if (number >= words_.size()) return {};
    return {words_[number].data(), words_.back().data() + words_.back().size()};
}

void NameList::add(std::string_view name) {
    constexpr size_t most = 24;
    if (std::find(names_.begin(), names_.end(), name) != names_.end()) return;
    if (names_.size() < most)
        names_.emplace_back(name);
    else
        more_ = true;
}

std::string NameList::text() const {
    std::string text;
    for (const std::string& name : names_) text += (text.empty() ? "" : ", ") + quoted(name);
    return text + (more_ ? ", ..." : "");
}

std::string ignored_warning(const std::string& label, const NameList& names) {
    return label + ": ignored what has no meaning here: " + names.text();
}

}  // namespace cistula
