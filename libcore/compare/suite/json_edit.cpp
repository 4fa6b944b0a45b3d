#include "compare/suite/json_edit.h"

#include <set>
#include <stdexcept>
#include <string_view>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

namespace cistula {
namespace {

/// A part of the text, [begin, end).
struct TextRange {
    size_t begin = 0;
    size_t end = 0;
};

struct JsonMember {
    size_t key = 0;    // where its key begins
    std::string name;  // empty in arrays
    TextRange value;
};

/// Walks over text that is known to be JSON.
class JsonWalk {
  public:
    explicit JsonWalk(const std::string& text) : text_(text) {}

    size_t after_blanks(size_t at) const {
        while (at < text_.size()) {
            if (text_.compare(at, 2, "//") == 0)
                at = text_.find_first_of("\r\n", at);  // where the parser ends it
            else if (text_.compare(at, 2, "/*") == 0)
                at = text_.find("*/", at) + 2;
            else if (is_blank(text_[at]))
                ++at;
            else
                return at;
        }
        throw std::logic_error("JSON text ends early");
    }

    /// The value that begins here.
    TextRange value(size_t begin) const {
        if (text_[begin] == '"') return {begin, string_end(begin)};
        if (text_[begin] == '{' || text_[begin] == '[') return {begin, container_end(begin)};
        size_t end = begin;
        while (end < text_.size() && !is_blank(text_[end]) && std::string_view(",]}/").find(text_[end]) == npos) ++end;
        return {begin, end};
    }

    /// The members of the object, or the elements of the array, that begins here.
    std::vector<JsonMember> members(size_t begin) const {
        const bool is_object = text_[begin] == '{';
        if (!is_object && text_[begin] != '[') throw std::logic_error("the place has no members");
        std::vector<JsonMember> found;
        for (size_t at = after_blanks(begin + 1); text_[at] != '}' && text_[at] != ']';) {
            if (text_[at] == ',') {
                at = after_blanks(at + 1);
                continue;
            }
            JsonMember member;
            member.key = at;
            if (is_object) {
                const size_t end = string_end(at);
                member.name = nlohmann::json::parse(text_.substr(at, end - at)).get<std::string>();
                at = after_blanks(after_blanks(end) + 1);  // behind the colon
            }
            member.value = value(at);
            at = after_blanks(member.value.end);
            found.push_back(std::move(member));
        }
        return found;
    }

  private:
    static constexpr size_t npos = std::string::npos;

    /// Blanks of JSON, and the bytes of a byte order mark.
    static bool is_blank(char c) {
        return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '\xEF' || c == '\xBB' || c == '\xBF';
    }
    size_t string_end(size_t at) const {
        for (++at; text_.at(at) != '"'; ++at)
            if (text_[at] == '\\') ++at;
        return at + 1;
    }
    size_t container_end(size_t begin) const {
        const std::vector<JsonMember> inside = members(begin);
        return after_blanks(inside.empty() ? begin + 1 : inside.back().value.end) + 1;
    }

    const std::string& text_;
};

/// The blanks before a place if nothing else stands before it on its line; null: something does.
const std::string* indentation(const std::string& text, size_t at, std::string& store) {
    const size_t line = at == 0 ? std::string::npos : text.rfind('\n', at - 1);
    if (line == std::string::npos) return nullptr;
    store = text.substr(line + 1, at - line - 1);
    return store.find_first_not_of(" \t") == std::string::npos ? &store : nullptr;
}

/// A value whose lines after the first are indented by as much, or one line of it where that is null.
std::string fitted(const std::string& value, const std::string* indentation) {
    std::string text;
    for (size_t i = 0; i < value.size(); ++i) {
        if (value[i] != '\n') {
            text += value[i];
        } else if (indentation) {
            text += '\n' + *indentation;
        } else {
            if (text.back() == ',') text += ' ';
            while (value[i + 1] == ' ') ++i;
        }
    }
    return text;
}

/// Finds what the text gets in which place.
class JsonChanges {
  public:
    JsonChanges(const std::string& text, const JsonValues& values) : text_(text), values_(values), walk_(text) {
        look_into(walk_.after_blanks(0), "");
        if (pieces_.size() != values_.size()) throw std::logic_error("the JSON text has no such place");
    }

    std::string text() const {
        std::string changed;
        size_t at = 0;
        for (const auto& [range, piece] : pieces_) {
            changed.append(text_, at, range.begin - at).append(piece);
            at = range.end;
        }
        return changed.append(text_, at);
    }

  private:
    /// Whether the value at a pointer, or one below it, changes.
    bool has_below(const std::string& pointer) const {
        const auto first = values_.lower_bound(pointer + '/');
        return first != values_.end() && first->first.starts_with(pointer + '/');
    }

    void look_into(size_t at, const std::string& pointer) {
        const std::vector<JsonMember> members = walk_.members(at);
        const bool is_object = text_[at] == '{';
        std::set<std::string> there;
        std::string store;
        for (size_t i = 0; i < members.size(); ++i) {
            const JsonMember& member = members[i];
            const std::string own = pointer + '/' + (is_object ? member.name : std::to_string(i));
            there.insert(own);
            if (const auto value = values_.find(own); value != values_.end())
                pieces_.emplace_back(member.value, fitted(value->second, indentation(text_, member.key, store)));
            else if (has_below(own))
                look_into(member.value.begin, own);
        }
        if (!is_object) return;
        const std::string* lines = members.empty() ? nullptr : indentation(text_, members.back().key, store);
        const size_t end = members.empty() ? at + 1 : members.back().value.end;
        std::string between = members.empty() ? "" : lines ? ",\n" + *lines : ", ";
        for (auto value = values_.lower_bound(pointer + '/');
             value != values_.end() && value->first.starts_with(pointer + '/'); ++value) {
            const std::string key = value->first.substr(pointer.size() + 1);
            if (key.find('/') != key.npos || there.contains(value->first)) continue;
            pieces_.emplace_back(TextRange{end, end},
                                 between + nlohmann::json(key).dump() + ": " + fitted(value->second, lines));
            if (between.empty()) between = ", ";
        }
    }

    const std::string& text_;
    const JsonValues& values_;
    const JsonWalk walk_;
    std::vector<std::pair<TextRange, std::string>> pieces_;  // in the order of the text
};

}  // namespace

std::string with_json_values(const std::string& text, const JsonValues& values) {
    return JsonChanges(text, values).text();
}

}  // namespace cistula
