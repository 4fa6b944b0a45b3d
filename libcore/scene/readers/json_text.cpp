// Parses JSON text into a tree. Beyond nlohmann's own tree builder, duplicate keys are errors, and every error has a
// line and a column or a place.
#include <algorithm>
#include <unordered_set>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/error.h"
#include "base/shown_text.h"
#include "scene/readers/json_reader.h"

namespace cistula {
namespace {

constexpr size_t most_levels = 64;          // of arrays and objects in one another
constexpr size_t most_entries = 4'000'000;  // keys, strings, arrays and objects, which take more memory than text
constexpr size_t fewest_places = 4;         // of an array that is not empty; as a point has; of an object twice that
constexpr size_t most_compared = 16;        // keys of an object that are compared each with each
constexpr size_t levels_of_a_scene = 6;     // the scene, "objects", an object, "triangles", "vertices", a point

/// nlohmann's message without its prefix, and with the quoted last token shortened to its end.
std::string plain_message(std::string message) {
    if (const size_t bracket = message.find("] "); message.starts_with("[json.exception.") && bracket != message.npos)
        message.erase(0, bracket + 2);
    if (message.starts_with("parse error at "))
        if (const size_t colon = message.find(": "); colon != message.npos) message.erase(0, colon + 2);
    constexpr std::string_view openings[] = {"last read: '", "number overflow parsing '"};
    constexpr size_t longest = 40;
    for (const std::string_view opening : openings) {
        const size_t found = message.find(opening);
        if (found == message.npos) continue;
        const size_t first = found + opening.size();
        const size_t end = std::min(message.rfind("'; expected "), message.rfind('\''));
        if (end == message.npos || end < first + longest) continue;
        size_t kept = end - longest;
        while (kept < end && (static_cast<unsigned char>(message[kept]) & 0xc0) == 0x80) ++kept;  // whole characters
        message.replace(first, kept - first, "...");
    }
    return message;
}

class TreeBuilder final : public nlohmann::json_sax<Json> {
  public:
    TreeBuilder(const std::string& text, const std::string& source) : text_(text), source_(source) {}

    Json take() { return std::move(root_); }

    bool null() override { return add(nullptr); }
    bool boolean(bool value) override { return add(value); }
    bool number_integer(number_integer_t value) override { return add(value); }
    bool number_unsigned(number_unsigned_t value) override { return add(value); }
    bool number_float(number_float_t value, const string_t&) override { return add(value); }
    bool string(string_t& value) override {
        add(std::move(value));
        return count();
    }
    bool binary(binary_t&) override { return false; }  // cannot occur in JSON text

    bool start_object(std::size_t) override {
        open(Json::object());
        names_.emplace_back();
        return count();
    }
    bool key(string_t& name) override {
        auto& members = open_.back()->get_ref<Json::object_t&>();
        if (members.size() == members.capacity()) enlarge(members);
        const bool is_new = is_new_key(members, name);
        members.emplace_back(std::move(name), Json());
        if (!is_new) fail("duplicate key", "give it once");
        return count();
    }
    bool end_object() override {
        open_.pop_back();
        names_.pop_back();
        return true;
    }
    bool start_array(std::size_t) override {
        open(Json::array());
        return count();
    }
    bool end_array() override {
        auto& elements = open_.back()->get_ref<Json::array_t&>();
        if (elements.size() > fewest_places) elements.shrink_to_fit();
        open_.pop_back();
        return true;
    }

    bool parse_error(std::size_t position, const std::string&, const nlohmann::detail::exception& error) override {
        fail_at(std::min(position == 0 ? 0 : position - 1, text_.size()), plain_message(error.what()));
    }

    /// Throws an error with the line and the column of a byte.
    [[noreturn]] void fail_at(size_t at, const std::string& what) const {
        const auto line = 1 + std::count(text_.begin(), text_.begin() + static_cast<ptrdiff_t>(at), '\n');
        const size_t line_start = at == 0 ? 0 : text_.rfind('\n', at - 1) + 1;  // npos + 1 is 0
        throw Error(ErrorKind::scene, what).at(fmt::format("{}:{}:{}", source_, line, at - line_start + 1));
    }

  private:
    [[noreturn]] void fail(const std::string& problem, const std::string& remedy) const {
        throw Error(ErrorKind::scene, problem, remedy).at(fmt::format("{}: {}", source_, place()));
    }
    bool count() {
        if (++entries_ > most_entries)
            fail(fmt::format(
                     "more than {} million keys, strings, arrays and objects up to here, which no scene may have",
                     most_entries / 1'000'000),
                 "put large meshes into files of their own, PLY or OBJ");
        return true;
    }
    /// Makes room for more members. The vector itself would copy them all, with everything in them: their names are
    /// const, so that they cannot be moved.
    static void enlarge(Json::object_t& members) {
        Json::object_t larger;
        larger.reserve(std::max(2 * members.size(), 2 * fewest_places));
        for (auto& [name, value] : members) larger.emplace_back(name, std::move(value));
        members.swap(larger);
    }
    /// Adds a key to those of the innermost object, which a set holds only where they are many.
    bool is_new_key(const Json::object_t& members, const std::string& name) {
        std::unordered_set<std::string>& names = names_.back();
        if (members.size() < most_compared)
            return std::none_of(members.begin(), members.end(), [&](const auto& m) { return m.first == name; });
        if (names.empty())
            for (const auto& member : members) names.insert(member.first);
        return names.insert(name).second;
    }
    Json& slot(Json value) {
        if (open_.empty()) return root_ = std::move(value);
        Json& parent = *open_.back();
        if (parent.is_array()) {
            auto& elements = parent.get_ref<Json::array_t&>();
            if (elements.empty()) elements.reserve(fewest_places);
            elements.push_back(std::move(value));
            return elements.back();
        }
        return parent.get_ref<Json::object_t&>().back().second = std::move(value);
    }
    template <class Value>
    bool add(Value&& value) {
        slot(Json(std::forward<Value>(value)));
        return true;
    }
    void open(Json container) {
        Json* level = &slot(std::move(container));
        if (open_.size() == most_levels)
            fail(fmt::format("more than {} levels deep", most_levels),
                 fmt::format("a scene has {} at most", levels_of_a_scene));
        open_.push_back(level);
    }

    std::string place() const {
        std::string path;
        for (Json* level : open_) {
            if (level->empty()) break;  // it is open, and what comes is its first
            if (level->is_array())
                path += fmt::format("/{}", level->size() - 1);
            else
                path += "/" + first_characters(level->get_ref<Json::object_t&>().back().first, 80);
        }
        return path;
    }

    const std::string& text_;
    const std::string& source_;
    Json root_;
    std::vector<Json*> open_;  // from the root inward; an element is moved only after it is closed
    std::vector<std::unordered_set<std::string>> names_;
    size_t entries_ = 0;
};

}  // namespace

Json parse_json(const std::string& text, const std::string& source) {
    TreeBuilder builder(text, source);
    // The library takes it for the end of the text, or of a comment.
    if (const size_t found = text.find('\0'); found != text.npos)
        builder.fail_at(found, "a NUL byte, which JSON does not have");
    constexpr bool strict = true;
    constexpr bool ignore_comments = true;
    Json::sax_parse(text, &builder, Json::input_format_t::json, strict, ignore_comments);
    return builder.take();
}

}  // namespace cistula
