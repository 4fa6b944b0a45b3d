// Text of mesh files: its encoding, its lines and words.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace cistula {

/// A file's text without a byte order mark, as its bytes are, or as UTF-8 where it comes as UTF-16, which zero bytes
/// tell where the mark lacks. A half of a pair that stands alone stays what it is: three bytes that are no UTF-8.
std::string utf8_of(std::string bytes);

/// Sets `words` to those of a line, which blanks, CR and LF part.
void split_words(std::string_view line, std::vector<std::string_view>& words);

/// Lines of OBJ and MTL files, which LF, CR or both end. `#` at the start of a word begins a comment; a backslash at
/// the end joins the next line, unless it is half of a character.
class MeshTextLines {
  public:
    explicit MeshTextLines(std::string_view text) : text_(text) {}

    /// Goes on to the next line that has words; false at the end of the text.
    bool next();

    /// The words of the line, at least one.
    const std::vector<std::string_view>& words() const { return words_; }
    /// What follows word `number` - 1: words with the blanks between them, as in a file's name.
    std::string_view rest(size_t number) const;
    /// Number of the line, from 1; the last one of joined lines.
    int line() const { return line_; }

  private:
    std::string_view physical_line();

    std::string_view text_;
    size_t at_ = 0;
    int line_ = 0;
    std::string joined_;
    std::string_view content_;
    std::vector<std::string_view> words_;
};

/// Names from files for one warning: each once, in order, no more than a line holds.
class NameList {
  public:
    void add(std::string_view name);
    bool empty() const { return names_.empty(); }
    std::string text() const;

  private:
    std::vector<std::string> names_;
    bool more_ = false;
};

/// The warning of a file, which `label` names, that says things which nothing here makes use of.
std::string ignored_warning(const std::string& label, const NameList& names);

}  // namespace cistula
