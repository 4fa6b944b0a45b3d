#include "scene/readers/text_tokens.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "base/decimal.h"
#include "base/error.h"
#include "base/shown_text.h"

namespace cistula {
namespace {

/// A finite decimal number; -0 becomes 0.
std::optional<double> finite_decimal(std::string_view word) {
    const std::optional<double> value = decimal<double>(word);
    if (!value || !std::isfinite(*value)) return std::nullopt;
    return *value + 0.0;
}

}  // namespace

TextTokens::Token TextTokens::after(const Token& token) const {
    constexpr std::string_view white = " \t\r\n\v\f";
    const char* const end = text_.data() + text_.size();
    const char* const from = token.text.empty() ? text_.data() : token.text.data() + token.text.size();
    const std::string_view rest(from, static_cast<size_t>(end - from));
    const size_t first = std::min(rest.find_first_not_of(white), rest.size());
    const std::string_view gap = rest.substr(0, first);
    const std::string_view word = rest.substr(first, rest.find_first_of(white, first) - first);
    return {word, token.line + static_cast<int>(std::count(gap.begin(), gap.end(), '\n'))};
}

std::string_view TextTokens::word(const std::string& what) {
    const Token next = after(last_);
    if (next.text.empty()) fail(last_.line, fmt::format("expected {}, found the end of the input", what));
    last_ = next;
    if (next.text.find('\0') != next.text.npos)
        fail(next.line, fmt::format("expected {}, found {}, which has a zero byte", what, quoted(next.text)));
    return next.text;
}

double TextTokens::number(const std::string& what, const Range& range) {
    const std::string expected = fmt::format("{}, a number {}{}", what, range.above ? "" : "from ", range_text(range));
    const std::string_view found = word(expected);
    const std::optional<double> value = finite_decimal(found);
    if (!value || !range.contains(*value)) fail(line(), fmt::format("expected {}, found {}", expected, quoted(found)));
    return *value;
}

int TextTokens::whole(const std::string& what, const Range& range) {
    const std::string expected = fmt::format("{}, a whole number from {}", what, range_text(range));
    const std::string_view found = word(expected);
    const std::optional<double> value = finite_decimal(found);
    if (!value || !range.contains(*value) || *value != std::floor(*value))
        fail(line(), fmt::format("expected {}, found {}", expected, quoted(found)));
    return static_cast<int>(*value);
}

bool TextTokens::one_more_on_line() const {
    const Token next = after(last_);
    if (next.text.empty() || next.line != last_.line) return false;
    const Token second = after(next);
    return second.text.empty() || second.line != next.line;
}

size_t TextTokens::words_on_new_line() const {
    const Token first = after(last_);
    if (!last_.text.empty() && first.line == last_.line) return 0;
    size_t count = 0;
    for (Token token = first; !token.text.empty() && token.line == first.line; token = after(token)) ++count;
    return count;
}

void TextTokens::finish() const {
    const Token next = after(last_);
    if (!next.text.empty()) fail(next.line, fmt::format("expected the end of the input, found {}", quoted(next.text)));
}

void TextTokens::fail(int line, const std::string& message) const {
    throw Error(ErrorKind::scene, message).at(fmt::format("{}:{}", label_, line));
}

}  // namespace cistula
