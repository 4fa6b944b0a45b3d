// Checked access to JSON: what is read is of the right type and in range, or the error says where and what would be.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <nlohmann/json.hpp>

#include "scene/readers/scene_keys.h"

namespace cistula {

using Json = nlohmann::ordered_json;  // names keep the order of the file

/// Parses JSON with comments. Throws Error (usage): "source:line:column: ..." for syntax and numbers beyond double,
/// "source: /place: duplicate key" for keys given twice. Columns count bytes from 1.
Json parse_json(const std::string& text, const std::string& source);

/// A value and the JSON pointer that leads to it. A view: tree and source must outlive it.
class JsonValue {
  public:
    JsonValue(const Json& json, const std::string& source, std::string place = {})
        : json_(&json), source_(&source), place_(std::move(place)) {}

    const Json& json() const { return *json_; }
    const std::string& place() const { return place_; }

    JsonValue item(size_t index) const;
    JsonValue member(const std::string& key) const;

    /// Where a key of this object stands, or would.
    std::string place_of(std::string_view key) const;

    /// Throws unless this object's comment, if it has one, is a string or an array of strings.
    void check_comment() const;

    /// Throws Error (usage): "source: place: message", on one line.
    [[noreturn]] void fail(const std::string& message) const { fail_at(place_, message); }
    [[noreturn]] void fail_at(const std::string& place, const std::string& message) const;

    /// Throws "expected ..., found ...".
    [[noreturn]] void fail_expected(const std::string& expected) const;

    /// The elements of an array of at least `least`; `expected` is for the message.
    size_t array_size(size_t least, const std::string& expected) const;

    /// The value as a type of a table; `key` gives range and choices.
    double number(const Key& key) const;
    int64_t whole(const Key& key) const;
    bool boolean(const Key& key) const;
    const std::string& text(const Key& key) const;
    int choice(const Key& key) const;  // index into key.choices
    glm::dvec3 color(const Key& key) const;
    glm::dvec3 point(const Key& key) const;
    glm::dvec2 pair(const Key& key) const;

  private:
    const Json* json_;
    const std::string* source_;
    std::string place_;
};

/// An object whose keys a table lists. The constructor throws for anything but an object, for keys that the table does
/// not know, but for comments, and for required ones that are missing. read() leaves `value` alone where the key is
/// absent.
class JsonObject {
  public:
    JsonObject(JsonValue value, const KeyTable& table);

    const JsonValue& value() const { return value_; }
    bool has(std::string_view key) { return json_of(key) != nullptr; }
    JsonValue at(std::string_view key);  // the key must be there

    void read(std::string_view key, double& value);
    void read(std::string_view key, int& value);
    void read(std::string_view key, bool& value);
    void read(std::string_view key, std::string& value);
    void read(std::string_view key, glm::dvec3& value);
    void read(std::string_view key, glm::dvec2& value);
    void read(std::string_view key, std::optional<glm::dvec3>& value);
    void read(std::string_view key, std::optional<double>& value);

    /// Index into the key's choices, or -1 where it is absent.
    int read_choice(std::string_view key);

    [[noreturn]] void fail(std::string_view key, const std::string& message) const;

    /// Call last: throws std::logic_error if the reader never asked for one of the table's keys.
    void finish() const;

  private:
    const Key& key_of(std::string_view name);
    const Json* json_of(std::string_view name);

    JsonValue value_;
    const KeyTable& table_;
    uint64_t asked_ = 0;
};

/// "an array of 3", "'glas'", "3.5".
std::string found_text(const Json& json);

}  // namespace cistula
