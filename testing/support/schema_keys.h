// JSON schemas held to the tables of keys that readers take names, types, ranges and defaults from.
#pragma once

#include <gtest/gtest.h>

#include <set>
#include <string>
#include <vector>

#include "scene/readers/json_reader.h"
#include "scene/readers/scene_keys.h"

namespace cistula::test {

inline void expect_range(const Json& number, const Range& range, bool whole) {
    const Json& type = number.at("type");  // or a list, of a number that may have keys
    EXPECT_EQ(type.is_array() ? type.at(0) : type, whole ? "integer" : "number");
    EXPECT_EQ(number.at(range.above ? "exclusiveMinimum" : "minimum").get<double>(), range.low);
    EXPECT_EQ(number.at(range.below ? "exclusiveMaximum" : "maximum").get<double>(), range.high);
}

inline void expect_numbers(const Json& array, size_t count, const Range& range) {
    EXPECT_EQ(array.at("type"), "array");
    EXPECT_EQ(array.at("minItems"), count);
    EXPECT_EQ(array.at("maxItems"), count);
    expect_range(array.at("items"), range, false);
}

/// Expects of a schema's object the keys of a table, with its types, ranges, defaults and choices, and a comment.
inline void expect_keys(const KeyTable& table, const Json& object, const Json& definitions) {
    EXPECT_EQ(object.at("type"), "object") << table.name;
    EXPECT_EQ(object.at("additionalProperties"), false) << table.name;
    EXPECT_EQ(object.at("properties").size(), table.keys.size() + 1) << table.name;
    EXPECT_EQ(object.at("properties").at(comment_key).at("$ref"), "#/$defs/comment") << table.name;
    std::set<std::string> required;
    if (object.contains("required"))
        for (const Json& name : object.at("required")) required.insert(name.get<std::string>());
    for (const Key& key : table.keys) {
        const std::string name(key.name);
        SCOPED_TRACE(std::string(table.name) + "." + name);
        ASSERT_TRUE(object.at("properties").contains(name));
        const Json& property = object.at("properties").at(name);
        EXPECT_EQ(required.count(name), key.required ? 1u : 0u);
        EXPECT_TRUE(property.contains("description"));
        EXPECT_EQ(property.value("default", Json()).dump(),
                  key.fallback.empty() ? "null" : Json::parse(key.fallback).dump());
        const std::string prefix = "#/$defs/";
        const std::string reference = property.value("$ref", "");
        const Json& shape = reference.empty() ? property : definitions.at(reference.substr(prefix.size()));
        switch (key.type) {
            case KeyType::whole:
                expect_range(shape, key.range, true);
                break;
            case KeyType::number:
                expect_range(shape, key.range, false);
                break;
            case KeyType::boolean:
                EXPECT_EQ(shape.at("type"), "boolean");
                break;
            case KeyType::text:
                EXPECT_EQ(shape.at("type"), "string");
                EXPECT_EQ(shape.at("minLength"), 1);
                break;
            case KeyType::choice:
                EXPECT_EQ(shape.at("enum").get<std::vector<std::string>>(),
                          std::vector<std::string>(key.choices.begin(), key.choices.end()));
                break;
            case KeyType::color:
                expect_range(shape.at("oneOf").at(0), key.range, false);
                expect_numbers(shape.at("oneOf").at(1), 3, key.range);
                break;
            case KeyType::point:
                expect_numbers(shape.at("oneOf").at(0), 3, key.range);
                break;
            case KeyType::pair:
                expect_numbers(shape, 2, key.range);
                break;
            case KeyType::other:
                break;
        }
    }
}

}  // namespace cistula::test
