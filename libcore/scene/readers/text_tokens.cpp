#include "scene/readers/text_tokens.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "scene/base/decimal.h"
#include "scene/base/error.h"
#include "scene/base/suggest.h"

namespace cistula {
namespace {

/// A finite decimal number; -0 becomes 0.
std::optional<double> finite_decimal(std::string_view word) {
    const std::optional<double> value = decimal<double>(word);
    if (!value || !std::isfinite(*value)) return std::nullopt;
    return *value + 0.0;
}

}  // namespace

TextTokens::TextTokens(std::string_view text, std::string label) : label_(std::move(label)) {
    constexpr std::string_view white = " \t\r\n\v\f";
    int line = 1;
    size_t at = 0;
    while (at < text.size()) {
        if (white.find(text[at]) != std::string_view::npos) {
            line += text[at++] == '\n';
            continue;
        }
        const size_t end = std::min(text.find_first_of(white, at), text.size());
        tokens_.push_back({text.substr(at, end - at), line});
        last_line_ = line;
        at = end;
    }
}

std::string_view TextTokens::word(const std::string& what) {
    if (next_ == tokens_.size()) fail(last_line_, fmt::format("expected {}, found the end of the input", what));
    return tokens_[next_++].text;
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
    if (next_ == 0 || next_ >= tokens_.size() || tokens_[next_].line != tokens_[next_ - 1].line) return false;
    return next_ + 1 == tokens_.size() || tokens_[next_ + 1].line != tokens_[next_].line;
}

size_t TextTokens::words_on_new_line() const {
    if (next_ >= tokens_.size() || (next_ > 0 && tokens_[next_ - 1].line == tokens_[next_].line)) return 0;
    size_t count = 1;
    while (next_ + count < tokens_.size() && tokens_[next_ + count].line == tokens_[next_].line) ++count;
    return count;
}

void TextTokens::finish() const {
    if (next_ < tokens_.size())
        fail(tokens_[next_].line, fmt::format("expected the end of the input, found {}", quoted(tokens_[next_].text)));
}

void TextTokens::fail(int line, const std::string& message) const {
    throw Error(ExitCode::usage, one_line(fmt::format("{}:{}: {}", label_, line, message)));
}

}  // namespace cistula
