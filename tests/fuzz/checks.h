// What all targets share.
#pragma once

#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "base/shown_text.h"

namespace cistula::fuzz {

inline void require(bool holds) {
    if (!holds) std::abort();
}

/// Aborts unless a text is one line as messages show it.
inline void check_line(const std::string& text) {
    require(!text.empty() && one_line(text) == text);
}

/// Aborts unless an error is one line for the user, of this kind.
inline void check_error(const Error& error, ErrorKind kind) {
    require(error.kind() == kind);
    check_line(error.what());
}

/// Aborts unless a text is XML or a page as suites write them: UTF-8 without characters that XML lacks, whose elements
/// end in their order and whose entities and attributes are whole.
inline void check_markup(std::string_view text) {
    require(is_utf8(text) && text.find("\xef\xbf\xbe") == text.npos && text.find("\xef\xbf\xbf") == text.npos);
    const auto is_one_of = [](std::string_view word, std::initializer_list<std::string_view> list) {
        return std::find(list.begin(), list.end(), word) != list.end();
    };
    std::vector<std::string_view> open;
    for (size_t at = 0; at < text.size(); ++at) {
        require(text[at] == '\n' || static_cast<unsigned char>(text[at]) >= 0x20);
        require(text[at] != '>');
        if (text[at] == '&')
            require(is_one_of(text.substr(at + 1, text.find(';', at) - at - 1), {"amp", "lt", "gt", "quot"}));
        if (text[at] != '<') continue;
        const size_t end = text.find('>', at);
        require(end != text.npos);
        const std::string_view tag = text.substr(at + 1, end - at - 1);
        require(tag.find('<') == tag.npos && std::count(tag.begin(), tag.end(), '"') % 2 == 0);
        const std::string_view name = tag.substr(0, tag.find(' '));
        at = end;
        if (tag.starts_with('/')) {
            require(!open.empty() && open.back() == tag.substr(1));
            open.pop_back();
        } else if (name == "style" || name == "script") {
            at = text.find(std::string("</").append(name).append(">"), end) + name.size() + 2;
        } else if (!tag.ends_with('/') && !is_one_of(name, {"?xml", "!doctype", "meta", "img", "input", "br"})) {
            open.push_back(name);
        }
    }
    require(open.empty());
}

/// Bytes as a file that has a path and lies in memory.
class MemoryFile {
  public:
    MemoryFile(const uint8_t* data, size_t size) : descriptor_(memfd_create("fuzz", MFD_CLOEXEC)) {
        require(descriptor_ >= 0 && write(descriptor_, data, size) == static_cast<ssize_t>(size));
    }
    ~MemoryFile() { close(descriptor_); }
    MemoryFile(const MemoryFile&) = delete;
    MemoryFile& operator=(const MemoryFile&) = delete;

    std::string path() const { return "/proc/self/fd/" + std::to_string(descriptor_); }

  private:
    int descriptor_;
};

}  // namespace cistula::fuzz
