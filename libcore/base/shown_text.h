// Text from outside, such as names and paths: as UTF-8, and as messages show it, so that nothing in it can act on a
// terminal or break a line.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace cistula {

/// Whether a text is UTF-8, without overlong forms and halves of UTF-16's pairs.
bool is_utf8(std::string_view text);

/// The text as UTF-8, unlike that of any other text: a byte that is no UTF-8 becomes % and two digits (%E9), and so
/// does a % (%25) before digits that would be read as such a byte's.
std::string utf8_name(std::string_view text);

/// The text as a single line of whole characters. Escaped are control characters (\n, \t, \x1b, \u0085), characters
/// that break lines or turn the direction of writing (\u2028, \u202e), and bytes that are no UTF-8 (\xff). A backslash
/// stays as it is, so the text of the text is the text.
std::string one_line(std::string_view text);

/// The first `most` characters of one_line(text), none of them cut.
std::string first_characters(std::string_view text, size_t most);

/// A name or word from a file in single quotes, for messages: on one line, cut after 40 characters.
std::string quoted(std::string_view word);
// Without these std::quoted would match strings better where <iomanip> is included.
inline std::string quoted(const std::string& word) {
    return quoted(std::string_view(word));
}
inline std::string quoted(std::string& word) {
    return quoted(std::string_view(word));
}

/// One word of a shell's command line.
std::string shell_word(std::string_view text);

/// A message as a single line. Of more than 4,000 characters those in the middle are left out.
std::string message_line(std::string_view message);

}  // namespace cistula
