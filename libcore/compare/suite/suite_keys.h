// Tables of all keys of suite.json. The reader takes names, ranges and choices from them, and a test compares
// docs/suite.schema.json and docs/regression.md with them.
#pragma once

#include <span>

#include "scene/readers/scene_keys.h"

namespace cistula {

/// `suite`: the file. `case`: one of its cases. `defaults`: the keys of a case that may stand for all. `thresholds`,
/// `recorded`: objects of a case.
extern const KeyTable suite_keys, suite_case_keys, suite_defaults_keys, suite_thresholds_keys, suite_recorded_keys;

/// All of the tables above.
std::span<const KeyTable* const> all_suite_tables();

/// One of the backends.
extern const Key suite_backend_key;

/// The name of a case or a tag: letters, digits and these, but one of the first kinds first. Nothing else, since names
/// are words of command lines, tests of ctest and parts of lists.
inline constexpr std::string_view suite_name_signs = "_-+./=@";
/// The rule as a regular expression.
inline constexpr std::string_view suite_name_pattern = "^[A-Za-z0-9_][A-Za-z0-9_+./=@-]*$";
bool is_suite_name(std::string_view text);

}  // namespace cistula
