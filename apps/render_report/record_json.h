// How the parts of a record become JSON and come back: the names of the members are the keys, in their order.
#pragma once

#include <nlohmann/json.hpp>

namespace cistula::report {

using Json = nlohmann::ordered_json;

}  // namespace cistula::report

/// to_json and from_json of a struct, next to it in its namespace. Every member must be there.
#define CISTULA_RECORD_FIELDS(Type, ...)                                                           \
    inline void to_json(::cistula::report::Json& nlohmann_json_j, const Type& nlohmann_json_t) {   \
        NLOHMANN_JSON_EXPAND(NLOHMANN_JSON_PASTE(NLOHMANN_JSON_TO, __VA_ARGS__))                   \
    }                                                                                              \
    inline void from_json(const ::cistula::report::Json& nlohmann_json_j, Type& nlohmann_json_t) { \
        NLOHMANN_JSON_EXPAND(NLOHMANN_JSON_PASTE(NLOHMANN_JSON_FROM, __VA_ARGS__))                 \
    }
