#include "compare/suite/json_edit.h"

#include <stdexcept>
#include <vector>

#include <nlohmann/json.hpp>

namespace cistula {
namespace {

/// A part of the text, [begin, end).
struct TextRange {
    size_t begin = 0, end = 0;
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
                at = text_.find('\n', at);
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

}  // namespace

std::string with_json_value(const std::string& text, std::string_view pointer, const std::string& value) {
    const JsonWalk walk(text);
    size_t at = walk.after_blanks(0);
    while (true) {
        if (pointer.empty() || pointer[0] != '/') throw std::logic_error("no JSON pointer");
        pointer.remove_prefix(1);
        const std::string_view key = pointer.substr(0, pointer.find('/'));
        pointer.remove_prefix(key.size());
        const std::vector<JsonMember> members = walk.members(at);
        const bool is_object = text[at] == '{';
        const JsonMember* found = nullptr;
        for (size_t i = 0; i < members.size() && !found; ++i)
            if (is_object ? members[i].name == key : std::to_string(i) == key) found = &members[i];
        std::string store;
        if (found && !pointer.empty()) {
            at = found->value.begin;
        } else if (found) {
            const std::string* lines = indentation(text, found->key, store);
            return text.substr(0, found->value.begin) + fitted(value, lines) + text.substr(found->value.end);
        } else if (is_object && pointer.empty()) {
            const std::string* lines = members.empty() ? nullptr : indentation(text, members.back().key, store);
            const size_t place = members.empty() ? at + 1 : members.back().value.end;
            const std::string before = members.empty() ? "" : lines ? ",\n" + *lines : ", ";
            return text.substr(0, place) + before + nlohmann::json(key).dump() + ": " + fitted(value, lines) +
                   text.substr(place);
        } else {
            throw std::logic_error("the JSON text has no such place");
        }
    }
}

}  // namespace cistula
