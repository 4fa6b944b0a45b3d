#include "scene/readers/json_reader.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include "base/error.h"
#include "base/suggest.h"

namespace cistula {
namespace {

/// Reads a number; false if `json` is not a number in range. -0 becomes 0, so that equal scenes have equal bits.
bool number_from(const Json& json, const Range& range, double& value) {
    if (!json.is_number()) return false;
    value = json.get<double>() + 0.0;
    return range.contains(value);
}

template <int n>
bool numbers_from(const Json& json, const Range& range, glm::vec<n, double, glm::defaultp>& value) {
    if (!json.is_array() || json.size() != n) return false;
    for (int i = 0; i < n; ++i)
        if (!number_from(json[static_cast<size_t>(i)], range, value[i])) return false;
    return true;
}

/// An array of n numbers. If exactly one of them is wrong, the error names it.
template <int n>
glm::vec<n, double, glm::defaultp> numbers_of(const JsonValue& value, const Key& key) {
    glm::vec<n, double, glm::defaultp> numbers{0};
    if (numbers_from<n>(value.json(), key.range, numbers)) return numbers;
    if (!value.json().is_array() || value.json().size() != n) value.fail_expected(expected_text(key));
    const Key element{key.name, KeyType::number, key.range, {}, false, {}};
    for (int i = 0; i < n; ++i) numbers[i] = value.item(static_cast<size_t>(i)).number(element);
    return numbers;
}

/// How a value goes from key to key, in the order of their names.
enum class Interpolation { linear, step, smooth };

/// A value that changes over time.
struct KeyedValue {
    std::vector<double> frames;      // ascending
    std::vector<glm::dvec4> values;  // of which a point or color has three, a number one

    /// Change per frame at a key: between its neighbors, at the ends to the only one.
    glm::dvec4 tangent(size_t i) const {
        const size_t before = i == 0 ? 0 : i - 1;
        const size_t after = std::min(i + 1, frames.size() - 1);
        return (values[after] - values[before]) / (frames[after] - frames[before]);
    }

    /// The cubic from key i to the next, by powers of the share of the way.
    std::array<glm::dvec4, 4> curve(size_t i) const {
        const double length = frames[i + 1] - frames[i];
        const glm::dvec4 way = values[i + 1] - values[i], leave = length * tangent(i), arrive = length * tangent(i + 1);
        return {values[i], leave, 3.0 * way - 2.0 * leave - arrive, leave + arrive - 2.0 * way};
    }

    /// The range of component c of a smooth curve between key i and the next. Where the curve would reach an end that
    /// the range does not have, as lengths have no 0, the nearer of the two keys is the end.
    Range range_between(size_t i, int c, Range range) const {
        const bool lacks_low = range.above || range.low == least_size;
        if (!lacks_low && !range.below) return range;
        const auto [start, leave, square, cube] = curve(i);
        const double root = -(square[c] + std::copysign(std::sqrt(square[c] * square[c] - 3 * leave[c] * cube[c]),
                                                        square[c]));  // NaN: the curve has no turn
        for (const double turn : {root / (3 * cube[c]), leave[c] / root}) {
            if (!(turn > 0 && turn < 1)) continue;
            const double far = start[c] + turn * (leave[c] + turn * (square[c] + turn * cube[c]));
            if (far <= range.low && lacks_low) range.low = std::min(values[i][c], values[i + 1][c]);
            if (far >= range.high && range.below) range.high = std::max(values[i][c], values[i + 1][c]);
        }
        return range;
    }

    glm::dvec4 at(double frame, Interpolation interpolation, const Range& range) const {
        const auto next = static_cast<size_t>(std::upper_bound(frames.begin(), frames.end(), frame) - frames.begin());
        if (next == 0) return values.front();
        const size_t i = next - 1;
        if (next == frames.size() || frame == frames[i] || interpolation == Interpolation::step) return values[i];
        const double length = frames[next] - frames[i];
        const double s = (frame - frames[i]) / length;
        const glm::dvec4 way = values[next] - values[i];
        if (interpolation == Interpolation::linear) return values[i] + s * way;
        const auto [start, leave, square, cube] = curve(i);
        glm::dvec4 value = start + s * (leave + s * (square + s * cube));
        for (int c = 0; c < 4; ++c) {
            const Range held = range_between(i, c, range);
            value[c] = std::clamp(value[c], held.low, held.high);
        }
        return value;
    }
};

/// A value within a range, where a smooth curve leaves it between keys.
double held_in(const Range& range, double value) {
    return std::clamp(value, range.low, range.high) + 0.0;
}

}  // namespace

std::string found_text(const Json& json) {
    if (json.is_object()) return json.empty() ? "an empty object" : "an object";
    if (json.is_array()) return json.empty() ? "an empty array" : fmt::format("an array of {}", json.size());
    if (json.is_number_float()) return number_text(json.get<double>());
    if (!json.is_string()) return json.dump();
    const std::string& text = json.get_ref<const std::string&>();
    if (text.empty()) return "an empty string";
    return quoted(text);
}

JsonValue JsonValue::item(size_t index) const {
    return {(*json_)[index], *source_, fmt::format("{}/{}", place_, index), clock_};
}

JsonValue JsonValue::member(const std::string& key) const {
    return {json_->at(key), *source_, place_of(key), clock_};
}

std::string JsonValue::place_of(std::string_view key) const {
    constexpr size_t longest = 80;
    std::string place = place_ + "/";
    for (const char c : first_characters(key, longest)) {  // escapes of RFC 6901
        if (c == '~')
            place += "~0";
        else if (c == '/')
            place += "~1";
        else
            place += c;
    }
    return place;
}

void JsonValue::check_comment() const {
    const auto found = json_->find(std::string(comment_key));
    if (found == json_->end() || found->is_string()) return;
    if (!found->is_array() ||
        !std::all_of(found->begin(), found->end(), [](const Json& line) { return line.is_string(); }))
        member(std::string(comment_key)).fail_expected("a string or an array of strings");
}

void JsonValue::fail_at(const std::string& place, const std::string& problem, const std::string& remedy) const {
    JsonValue(*json_, *source_, place).fail(Error(ErrorKind::scene, problem, remedy));
}

void JsonValue::fail(const Error& error) const {
    throw error.at(fmt::format("{}: {}", *source_, place_.empty() ? "/" : place_));
}

void JsonValue::fail_expected(const std::string& expected) const {
    fail(fmt::format("expected {}, found {}", expected, found_text(*json_)),
         json_->is_object() && json_->contains("keys") ? "keys are for numbers, points, planes and colors of the "
                                                         "camera, lights, objects, materials and what is around"
                                                       : "");
}

size_t JsonValue::array_size(size_t least, const std::string& expected) const {
    if (!json_->is_array() || json_->size() < least) fail_expected(expected);
    return json_->size();
}

template <class Read>
glm::dvec4 JsonValue::keyed(const Key& key, const Read& read) const {
    static constexpr Key frame_key{"frame", KeyType::number, {-1e6, 1e6}, {}, false, {}};
    JsonObject object(*this, keyed_keys);
    const JsonValue list = object.at("keys");
    const auto interpolation = static_cast<Interpolation>(std::max(object.read_choice("interpolation"), 0));
    object.finish();
    KeyedValue keyed;
    const size_t count = list.array_size(1, "an array of keys [frame, value]");
    for (size_t i = 0; i < count; ++i) {
        const JsonValue one = list.item(i);
        if (one.array_size(0, "a key [frame, value]") != 2) one.fail_expected("a key [frame, value]");
        const JsonValue frame = one.item(0);
        keyed.frames.push_back(JsonValue(frame.json(), *source_, frame.place()).number(frame_key));
        if (i > 0 && !(keyed.frames[i] > keyed.frames[i - 1]))
            frame.fail(fmt::format("frame {} stands after frame {}", number_text(keyed.frames[i]),
                                   number_text(keyed.frames[i - 1])),
                       "the frames of keys ascend");
        const JsonValue value = one.item(1);
        keyed.values.push_back(read(JsonValue(value.json(), *source_, value.place()), key));
    }
    clock_->keys.insert(clock_->keys.end(), keyed.frames.begin(), keyed.frames.end());
    if (interpolation == Interpolation::smooth)
        for (size_t i = 0; i + 1 < count; ++i)
            for (int c = 0; c < 4; ++c) {
                const Range held = keyed.range_between(i, c, key.range);
                if (held.low == key.range.low && held.high == key.range.high) continue;
                clock_->held.push_back(fmt::format(
                    "{}: {}: the smooth curve leaves what is possible between frames {} and {}, and stays at {} there; "
                    "add a key between them",
                    *source_, place_, number_text(keyed.frames[i]), number_text(keyed.frames[i + 1]),
                    number_text(held.low != key.range.low ? held.low : held.high)));
                break;  // a number is all four components
            }
    glm::dvec4 value = keyed.at(clock_->frame, interpolation, key.range);
    for (int c = 0; c < 4; ++c) value[c] = held_in(key.range, value[c]);
    return value;
}

double JsonValue::number(const Key& key) const {
    if (is_keyed())
        return keyed(key, [](const JsonValue& value, const Key& k) { return glm::dvec4{value.number(k)}; }).x;
    double value = 0;
    if (number_from(*json_, key.range, value)) return value;
    fail_expected("a number " + std::string(key.range.above ? "" : "from ") + range_text(key.range));
}

int64_t JsonValue::whole(const Key& key) const {
    double value = 0;
    if (number_from(*json_, key.range, value) && value == std::floor(value)) return static_cast<int64_t>(value);
    fail_expected(expected_text(key));
}

bool JsonValue::boolean(const Key& key) const {
    if (!json_->is_boolean()) fail_expected(expected_text(key));
    return json_->get<bool>();
}

const std::string& JsonValue::text(const Key& key) const {
    if (!json_->is_string() || json_->get_ref<const std::string&>().empty()) fail_expected(expected_text(key));
    return json_->get_ref<const std::string&>();
}

int JsonValue::choice(const Key& key) const {
    if (!json_->is_string()) fail_expected(expected_text(key));
    const std::string& name = json_->get_ref<const std::string&>();
    for (size_t i = 0; i < key.choices.size(); ++i)
        if (key.choices[i] == name) return static_cast<int>(i);
    fail(fmt::format("unknown value {}", found_text(*json_)),
         suggestion(name, {key.choices.begin(), key.choices.end()}, "values"));
}

glm::dvec3 JsonValue::color(const Key& key) const {
    if (is_keyed())
        return keyed(key, [](const JsonValue& value, const Key& k) { return glm::dvec4(value.color(k), 0); });
    double gray = 0;
    if (number_from(*json_, key.range, gray)) return glm::dvec3{gray};
    return numbers_of<3>(*this, key);
}

glm::dvec3 JsonValue::point(const Key& key) const {
    if (is_keyed())
        return keyed(key, [](const JsonValue& value, const Key& k) { return glm::dvec4(value.point(k), 0); });
    return numbers_of<3>(*this, key);
}

glm::dvec4 JsonValue::plane(const Key& key) const {
    if (is_keyed()) return keyed(key, [](const JsonValue& value, const Key& k) { return value.plane(k); });
    const std::string expected = "a plane [nx, ny, nz, d]";
    if (array_size(4, expected) != 4) fail_expected(expected);
    glm::dvec4 numbers;
    for (int k = 0; k < 4; ++k) numbers[k] = item(static_cast<size_t>(k)).number(key);
    return numbers;
}

glm::dvec2 JsonValue::pair(const Key& key) const {
    return numbers_of<2>(*this, key);
}

JsonObject::JsonObject(JsonValue value, const KeyTable& table) : value_(std::move(value)), table_(table) {
    if (table.keys.size() > 64) throw std::logic_error("a key table holds at most 64 keys");
    if (!value_.json().is_object()) value_.fail_expected("an object");
    value_.check_comment();
    for (const auto& member : value_.json().items())
        if (member.key() != comment_key && !table.find(member.key()))
            value_.fail_at(value_.place_of(member.key()), "unknown key",
                           suggestion(member.key(), table.names(), "keys"));
    for (const Key& key : table.keys)
        if (key.required && !value_.json().contains(key.name))
            value_.fail(fmt::format("missing key '{}'{}", key.name,
                                    key.type == KeyType::other ? "" : ": expected " + expected_text(key)));
}

const Key& JsonObject::key_of(std::string_view name) {
    for (size_t i = 0; i < table_.keys.size(); ++i) {
        if (table_.keys[i].name != name) continue;
        asked_ |= uint64_t{1} << i;
        return table_.keys[i];
    }
    throw std::logic_error(fmt::format("the table '{}' has no key '{}'", table_.name, name));
}

const Json* JsonObject::json_of(std::string_view name) {
    key_of(name);
    const auto found = value_.json().find(std::string(name));
    return found == value_.json().end() ? nullptr : &*found;
}

JsonValue JsonObject::at(std::string_view key) {
    key_of(key);
    return value_.member(std::string(key));
}

void JsonObject::read(std::string_view key, double& value) {
    if (has(key)) value = at(key).number(key_of(key));
}
void JsonObject::read(std::string_view key, int& value) {
    if (has(key)) value = static_cast<int>(at(key).whole(key_of(key)));
}
void JsonObject::read(std::string_view key, bool& value) {
    if (has(key)) value = at(key).boolean(key_of(key));
}
void JsonObject::read(std::string_view key, std::string& value) {
    if (has(key)) value = at(key).text(key_of(key));
}
void JsonObject::read(std::string_view key, glm::dvec3& value) {
    if (has(key)) value = key_of(key).type == KeyType::color ? at(key).color(key_of(key)) : at(key).point(key_of(key));
}
void JsonObject::read(std::string_view key, glm::dvec2& value) {
    if (has(key)) value = at(key).pair(key_of(key));
}
void JsonObject::read(std::string_view key, std::optional<glm::dvec3>& value) {
    if (has(key)) read(key, value.emplace());
}
void JsonObject::read(std::string_view key, std::optional<double>& value) {
    if (has(key)) read(key, value.emplace());
}

int JsonObject::read_choice(std::string_view key) {
    return has(key) ? at(key).choice(key_of(key)) : -1;
}

void JsonObject::fail(std::string_view key, const std::string& problem, const std::string& remedy) const {
    value_.fail_at(value_.place_of(key), problem, remedy);
}

void JsonObject::finish() const {
    const size_t count = table_.keys.size();
    const uint64_t all = count == 64 ? ~uint64_t{0} : (uint64_t{1} << count) - 1;
    if (asked_ != all) throw std::logic_error(fmt::format("a key of the table '{}' is never read", table_.name));
}

}  // namespace cistula
