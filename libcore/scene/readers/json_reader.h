// Checked access to JSON: values of the wrong type or out of range give an error with the place and the expected value.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "scene/readers/scene_keys.h"

namespace cistula {

using Json = nlohmann::ordered_json;  // keeps the order of keys in the file

/// Parses JSON with comments. Throws Error (usage): "source:line:column: ..." for syntax errors, NUL bytes and numbers
/// out of double's range, "source: /place: ..." for repeated keys, for more than 64 levels and for more than 4 million
/// keys, strings, arrays and objects. Columns count bytes from 1.
Json parse_json(const std::string& text, const std::string& source);

/// The frame that values which change over time are read for, the frames of all keys that were read, and what is said
/// of smooth curves that are held.
struct KeyClock {
    double frame = 0;
    std::vector<double> keys = {};
    std::vector<std::string> held = {};
};

/// A value and its JSON pointer. A view: tree and source must outlive it.
class JsonValue {
  public:
    JsonValue(const Json& json, const std::string& source, std::string place = {}, KeyClock* clock = nullptr)
        : json_(&json), source_(&source), place_(std::move(place)), clock_(clock) {}

    /// This value, in which numbers, points and colors may change over time; the clock must outlive it.
    JsonValue over_time(KeyClock& clock) const { return {*json_, *source_, place_, &clock}; }

    const Json& json() const { return *json_; }
    const std::string& place() const { return place_; }

    JsonValue item(size_t index) const;
    JsonValue member(const std::string& key) const;
    /// The member `key` where its value is at hand; looking it up takes time that grows with their number.
    JsonValue member(const std::string& key, const Json& value) const {
        return {value, *source_, place_of(key), clock_};
    }

    /// JSON pointer of a key of this object, present or not; a very long key is cut, since the pointer is for messages.
    std::string place_of(std::string_view key) const;

    /// Whether the value changes over time by keys, and may.
    bool is_keyed() const {
        return clock_ && json_->is_object() && (json_->contains("keys") || json_->contains("interpolation"));
    }

    /// Throws unless this object's comment, if it has one, is a string or an array of strings.
    void check_comment() const;

    /// Throws Error (scene) at "source: place".
    [[noreturn]] void fail(const std::string& problem, const std::string& remedy = {}) const {
        fail_at(place_, problem, remedy);
    }
    [[noreturn]] void fail_at(const std::string& place, const std::string& problem,
                              const std::string& remedy = {}) const;
    /// Throws the error at "source: place".
    [[noreturn]] void fail(const Error& error) const;

    /// Throws Error (scene): "expected ..., found ...".
    [[noreturn]] void fail_expected(const std::string& expected) const;

    /// Length of an array, which must be `least` or more; `expected` is for the message.
    size_t array_size(size_t least, const std::string& expected) const;

    /// The value as the type that a table asks for; `key` gives range and choices. A number, a color, a point
    /// or a plane [nx, ny, nz, d] with keys is that of the clock's frame.
    double number(const Key& key) const;
    int64_t whole(const Key& key) const;
    bool boolean(const Key& key) const;
    const std::string& text(const Key& key) const;
    int choice(const Key& key) const;  // index into key.choices
    glm::dvec3 color(const Key& key) const;
    glm::dvec3 point(const Key& key) const;
    glm::dvec4 plane(const Key& key) const;
    glm::dvec2 pair(const Key& key) const;

  private:
    /// The value with keys at the clock's frame; read(value, key) reads that of a key.
    template <class Read>
    glm::dvec4 keyed(const Key& key, const Read& read) const;

    const Json* json_;
    const std::string* source_;
    std::string place_;
    KeyClock* clock_;
};

/// An object whose keys are listed in a table. The constructor throws unless it is an object, and for keys that are
/// neither in the table nor comments, and for missing required keys. read() leaves `value` unchanged where the key is
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

    /// The choice as an index into the key's choices, or -1 if the key is absent.
    int read_choice(std::string_view key);

    [[noreturn]] void fail(std::string_view key, const std::string& problem, const std::string& remedy = {}) const;

    /// Call it last: throws std::logic_error if the reader skipped one of the table's keys.
    void finish() const;

  private:
    const Key& key_of(std::string_view name);
    const Json* json_of(std::string_view name);

    JsonValue value_;
    const KeyTable& table_;
    uint64_t asked_ = 0;
};

/// A short text for a JSON value in messages: "an array of 3", "'glas'", "3.5".
std::string found_text(const Json& json);

}  // namespace cistula
