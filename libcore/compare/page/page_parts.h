// Parts of HTML pages that stand alone: text, tables, figures, the style.
#pragma once

#include <string>
#include <vector>

namespace cistula {

/// Text on one line, with its markup escaped.
std::string escaped(const std::string& text);

/// A table in a scrollable box. Cells are HTML; columns whose head begins with '>' are numbers.
class Table {
  public:
    explicit Table(std::vector<std::string> heads);
    void row(const std::vector<std::string>& cells, const std::string& css = "");
    std::string html() const;

  private:
    std::vector<std::string> heads_;
    std::string body_;
};

/// A figure with its caption (HTML).
std::string figure(const std::string& content, const std::string& caption, const std::string& css = "");

/// A command line that a click selects as a whole.
std::string command_html(const std::string& command);

/// The style of all pages: light and dark, wide and narrow.
extern const char* const page_style;

}  // namespace cistula
