// Changes of values in JSON text that leave everything else as it is: comments, blanks, the order of keys.
#pragma once

#include <string>
#include <string_view>

namespace cistula {

/// The text with another value at a JSON pointer, whose parent exists. Where the pointer's last key is not there, it
/// becomes the last of its object, on a line of its own if the key before it has one. A value of several lines gets the
/// key's indentation, or becomes one line where the key has no line of its own. The text must be JSON, with comments or
/// without. Throws std::logic_error if it has no such place.
std::string with_json_value(const std::string& text, std::string_view pointer, const std::string& value);

}  // namespace cistula
