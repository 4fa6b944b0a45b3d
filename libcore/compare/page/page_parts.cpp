#include "compare/page/page_parts.h"

#include <fmt/format.h>

#include "base/shown_text.h"

namespace cistula {

std::string escaped(const std::string& text) {
    std::string out;
    for (const char c : one_line(text)) {
        if (c == '&')
            out += "&amp;";
        else if (c == '<')
            out += "&lt;";
        else if (c == '>')
            out += "&gt;";
        else if (c == '"')
            out += "&quot;";
        else
            out += c;
    }
    return out;
}

Table::Table(std::vector<std::string> heads) : heads_(std::move(heads)) {}

void Table::row(const std::vector<std::string>& cells, const std::string& css) {
    body_ += css.empty() ? "<tr>" : fmt::format("<tr class=\"{}\">", css);
    for (size_t i = 0; i < cells.size(); ++i) {
        const bool number = heads_.at(i)[0] == '>';
        const char* tag = i == 0 ? "th scope=\"row\"" : "td";
        body_ += fmt::format("<{}{}>{}</{}>", tag, number ? " class=\"n\"" : "", cells[i], i == 0 ? "th" : "td");
    }
    body_ += "</tr>\n";
}

std::string Table::html() const {
    std::string text = "<div class=\"scroll\" tabindex=\"0\"><table><thead><tr>";
    for (const std::string& head : heads_) {
        const bool number = head[0] == '>';
        text += fmt::format("<th scope=\"col\"{}>{}</th>", number ? " class=\"n\"" : "", head.substr(number ? 1 : 0));
    }
    return text + "</tr></thead><tbody>\n" + body_ + "</tbody></table></div>\n";
}

std::string figure(const std::string& content, const std::string& caption, const std::string& css) {
    return fmt::format("<figure{}>{}<figcaption>{}</figcaption></figure>\n",
                       css.empty() ? "" : " class=\"" + css + "\"", content, caption);
}

std::string command_html(const std::string& command) {
    return "<pre class=\"command\" tabindex=\"0\"><code>" + escaped(command) + "</code></pre>\n";
}

}  // namespace cistula
