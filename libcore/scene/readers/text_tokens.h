// Tokenizer of the text input: words and numbers with their line numbers.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "scene/readers/scene_keys.h"

namespace cistula {

class TextTokens {
  public:
    TextTokens(std::string_view text, std::string label);

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
    int line() const { return next_ == 0 ? 1 : tokens_[next_ - 1].line; }

    /// Throws Error (usage): "label:line: message", on one line.
    [[noreturn]] void fail(int line, const std::string& message) const;

  private:
    struct Token {
        std::string_view text;
        int line;
    };

    std::vector<Token> tokens_;
    size_t next_ = 0;
    int last_line_ = 1;
    std::string label_;
};

}  // namespace cistula
