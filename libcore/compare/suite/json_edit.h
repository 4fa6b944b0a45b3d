// Changes of values in JSON text that leave everything else as it is: comments, blanks, the order of keys.
#pragma once

#include <map>
#include <string>

namespace cistula {

/// Values as JSON text by JSON pointers of keys without '/' and '~'.
using JsonValues = std::map<std::string, std::string>;

/// The text with other values at pointers whose parents exist, none within another. Where a pointer's last key is not
/// there, it becomes the last of its object, on a line of its own if the key before it has one. A value of several
/// lines gets the key's indentation, or becomes one line where the key has no line of its own. The text must be JSON,
/// with comments or without. Throws std::logic_error if it has no such place.
std::string with_json_values(const std::string& text, const JsonValues& values);

}  // namespace cistula
