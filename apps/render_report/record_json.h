// Conversion between the parts of a record and JSON; the members' names are the keys, in their order.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

namespace cistula::report {

using Json = nlohmann::ordered_json;

/// A member as text; empty where it lacks or is null.
inline std::string text_of(const Json& json, const char* key) {
    const auto found = json.find(key);
    if (found == json.end()) return "";
    if (found->is_string()) return found->get<std::string>();
    return found->is_null() ? "" : found->dump();
}

}  // namespace cistula::report

/// Defines to_json and from_json of a struct, in its namespace. from_json requires every member.
#define CISTULA_RECORD_FIELDS(Type, ...)                                                           \
    inline void to_json(::cistula::report::Json& nlohmann_json_j, const Type& nlohmann_json_t) {   \
        NLOHMANN_JSON_EXPAND(NLOHMANN_JSON_PASTE(NLOHMANN_JSON_TO, __VA_ARGS__))                   \
    }                                                                                              \
    inline void from_json(const ::cistula::report::Json& nlohmann_json_j, Type& nlohmann_json_t) { \
        NLOHMANN_JSON_EXPAND(NLOHMANN_JSON_PASTE(NLOHMANN_JSON_FROM, __VA_ARGS__))                 \
    }
