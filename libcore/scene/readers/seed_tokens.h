// Words and numbers of the seed's text input, with the lines that they stand on.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "scene/readers/scene_keys.h"

namespace cistula {

class SeedTokens {
  public:
    SeedTokens(std::string_view text, std::string label);

    /// The next word; `what` names it in messages. Throws Error (usage) at the end of the text.
    std::string_view word(const std::string& what);

    /// The next number, in range. Decimal; no "nan", no "inf", no hexadecimal.
    double number(const std::string& what, const Range& range);
    int whole(const std::string& what, const Range& range);

    /// True if there is one more word on the line of the last one, and no more than that.
    bool one_more_on_line() const;

    /// How many words the line of the next word has, if that is the first of them; else 0.
    size_t words_on_new_line() const;

    /// Throws if anything is left.
    void finish() const;

    /// Line of the last word, from 1; the first line before any is read.
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
