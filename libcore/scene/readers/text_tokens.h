// Tokenizer of the text input: words and numbers with their line numbers.
#pragma once

#include <string>
#include <string_view>
#include <utility>

#include "scene/readers/scene_keys.h"

namespace cistula {

/// Characters that ASCII counts as white space.
inline constexpr std::string_view blanks = " \t\r\n\v\f";

class TextTokens {
  public:
    /// `text` must outlive this object.
    TextTokens(std::string_view text, std::string label) : label_(std::move(label)), text_(text) {}

    /// The next word; `what` names it in messages. Throws Error (usage) at the end of the text.
    std::string_view word(const std::string& what);

    /// The next number, which must lie in `range`: decimal; no "nan", no "inf", no hexadecimal.
    double number(const std::string& what, const Range& range);
    int whole(const std::string& what, const Range& range);

    /// Whether exactly one more word follows on the line of the last word.
    bool one_more_on_line() const;

    /// Number of words on the next word's line if that word is the first of its line; else 0.
    size_t words_on_new_line() const;

    /// Throws Error (usage) if any word is left.
    void finish() const;

    /// Line of the last word, from 1; 1 before any is read.
    int line() const { return last_.line; }

    /// Throws Error (usage): "label:line: message", on one line.
    [[noreturn]] void fail(int line, const std::string& message) const;

  private:
    /// A word and its line; empty at the end of the text.
    struct Token {
        std::string_view text;
        int line = 1;
    };

    /// The word that follows `token`; the first one for a default token.
    Token after(const Token& token) const;

    std::string label_;
    std::string_view text_;
    Token last_;  // the last word read
};

}  // namespace cistula
