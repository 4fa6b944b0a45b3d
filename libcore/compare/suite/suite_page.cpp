#include "compare/suite/suite_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <set>

#include "base/error.h"
#include "base/file_bytes.h"
#include "compare/page/page_parts.h"
#include "compare/suite/suite_pixels.h"
#include "image/picture/picture_io.h"
#include "sequence/run_context.h"

namespace cistula {
namespace {

constexpr size_t most_worst_pixels = 3;
constexpr int largest_shown_side = 1600;  // pixels; of larger pictures the part around the worst pixel is shown

constexpr const char* suite_style = R"(
.stack { position: relative; margin: 0 auto; max-width: 100%; --at: 50%; }
.stack img { width: 100%; image-rendering: pixelated; border-radius: 0; } .stack img + img { position: absolute; inset: 0; height: 100%; }
.stack .difference { visibility: hidden; } .stack .new { clip-path: inset(0 0 0 var(--at)); }
[data-view=golden] .new, [data-view=difference] .new { visibility: hidden; } [data-view=new] .new { clip-path: none; }
[data-view=difference] .difference { visibility: visible; }
.views { display: flex; flex-wrap: wrap; gap: .4rem; align-items: center; margin-bottom: .7rem; }
.views button { font: inherit; font-size: .9rem; padding: .25rem .8rem; border: 1px solid var(--line); border-radius: 99px; background: var(--paper); color: inherit; cursor: pointer; }
.views button[aria-pressed=true] { border-color: var(--accent); color: var(--accent); } .views input { flex: 1 1 8rem; min-width: 0; }
.why { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(100%, 30rem), 1fr)); gap: 0 1.2rem; } .why > div { min-width: 0; }
.why pre { overflow: auto; max-height: 32rem; white-space: pre; font-size: .8rem; }
mark { color: inherit; background: color-mix(in srgb, var(--accent) 22%, transparent); }
)";

constexpr const char* suite_script = R"(
const all = [...document.querySelectorAll('.compare')];
function show(box, view) {
  box.dataset.view = view;
  for (const b of box.querySelectorAll('button')) b.setAttribute('aria-pressed', b.value === view);
}
for (const box of all) {
  box.querySelector('input').addEventListener('input', e => {
    box.querySelector('.stack').style.setProperty('--at', e.target.value + '%');
    show(box, 'slider');
  });
  for (const b of box.querySelectorAll('button')) b.addEventListener('click', () => show(box, b.value));
}
addEventListener('keydown', e => {
  if (e.ctrlKey || e.metaKey || e.altKey) return;
  for (const box of all) {
    if (e.key === 'b') show(box, box.dataset.view === 'golden' ? 'new' : 'golden');
    if (e.key === 'd') show(box, box.dataset.view === 'difference' ? 'slider' : 'difference');
  }
});
)";

/// The part of a data window that is shown.
PixelRect shown_part(const LayeredPicture& picture, const SuitePixel* worst) {
    PixelRect part{0, 0, std::min(picture.width, largest_shown_side), std::min(picture.height, largest_shown_side)};
    if (worst) {
        part.x = std::clamp(worst->x - picture.x - part.width / 2, 0, picture.width - part.width);
        part.y = std::clamp(worst->y - picture.y - part.height / 2, 0, picture.height - part.height);
    }
    return part;
}

/// Runs over the pixels of a part, row by row.
template <class Color>
ColorPicture colors_of(const LayeredPicture& picture, const PixelRect& part, const Color& color) {
    ColorPicture colors;
    colors.width = static_cast<uint32_t>(part.width);
    colors.height = static_cast<uint32_t>(part.height);
    for (int y = part.y; y < part.y + part.height; ++y)
        for (int x = part.x; x < part.x + part.width; ++x)
            colors.texels.push_back(
                color(static_cast<size_t>(y) * static_cast<size_t>(picture.width) + static_cast<size_t>(x)));
    return colors;
}

/// R, G and B as they are stored; a channel that is not there is black.
ColorPicture beauty(const LayeredPicture& picture, const PixelRect& part) {
    const std::vector<float>* values[3] = {};
    for (const LayeredPicture::Channel& channel : picture.channels)
        for (int c = 0; c < 3; ++c)
            if (channel.name == std::string(1, "RGB"[c])) values[c] = &channel.values;
    return colors_of(picture, part, [&](size_t i) {
        glm::vec3 color{0};
        for (int c = 0; c < 3; ++c)
            if (values[c] && !std::isnan((*values[c])[i])) color[c] = (*values[c])[i];
        return color;
    });
}

/// Black where nothing differs; elsewhere from violet to yellow by the logarithm of the difference, over six decades
/// below the largest.
ColorPicture difference_colors(const LayeredPicture& picture, const PixelRect& part,
                               const std::vector<double>& differences) {
    double largest = 0;
    for (const double d : differences)
        if (std::isfinite(d)) largest = std::max(largest, d);
    return colors_of(picture, part, [&](size_t i) {
        const double d = differences[i];
        if (d == 0) return glm::vec3(0);
        const double share = std::isinf(d) ? 1 : std::clamp(1 + std::log10(d / largest) / 6, 0.0, 1.0);
        return glm::mix(glm::vec3(0.2f, 0.02f, 0.35f), glm::vec3(1, 0.9f, 0.2f), static_cast<float>(share));
    });
}

std::string image_html(const ColorPicture& picture, const char* css, const std::string& alt) {
    return fmt::format("<img class=\"{}\" width=\"{}\" height=\"{}\" alt=\"{}\" src=\"data:image/png;base64,{}\">", css,
                       picture.width, picture.height, escaped(alt), base64(encode_png(picture)));
}

/// Width in CSS pixels at which a picture is shown: small ones are enlarged by whole numbers.
int shown_width(int width) {
    return width * std::max(1, 640 / width);
}

std::string stack_html(const std::string& images, int width) {
    return fmt::format("<div class=\"stack\" style=\"width: {}px\">{}</div>", shown_width(width), images);
}

std::string pictures_html(const LayeredPicture* golden, const LayeredPicture& fresh,
                          const std::vector<double>& differences, const SuitePixel* worst) {
    const PixelRect part = shown_part(fresh, worst);
    std::string said = part.width < fresh.width || part.height < fresh.height
                           ? fmt::format("The {}x{} pixels around the worst of {}x{}. ", part.width, part.height,
                                         fresh.width, fresh.height)
                           : "";
    const std::string now = image_html(beauty(fresh, part), "new", "rendered");
    if (!golden)
        return figure(stack_html(image_html(beauty(fresh, part), "", "rendered"), part.width),
                      said + "Rendered. There is no golden image to show beside it.");
    if (differences.empty())  // of another size
        return "<div class=\"pair\">" +
               figure(stack_html(image_html(beauty(*golden, shown_part(*golden, nullptr)), "", "golden image"),
                                 shown_part(*golden, nullptr).width),
                      fmt::format("<b>Golden</b>, {}x{}", golden->width, golden->height)) +
               figure(stack_html(image_html(beauty(fresh, part), "", "rendered"), part.width),
                      fmt::format("<b>New</b>, {}x{}", fresh.width, fresh.height)) +
               "</div>";
    const std::string images = image_html(beauty(*golden, part), "golden", "golden image") + now +
                               image_html(difference_colors(fresh, part, differences), "difference", "difference");
    return "<figure class=\"compare\" data-view=\"slider\"><div class=\"views\">"
           "<button type=\"button\" value=\"slider\" aria-pressed=\"true\">Slider</button>"
           "<input type=\"range\" min=\"0\" max=\"100\" value=\"50\" step=\"0.5\" aria-label=\"where golden ends and "
           "new begins\">"
           "<button type=\"button\" value=\"golden\" aria-pressed=\"false\">Golden</button>"
           "<button type=\"button\" value=\"new\" aria-pressed=\"false\">New</button>"
           "<button type=\"button\" value=\"difference\" aria-pressed=\"false\">Difference</button></div>" +
           stack_html(images, part.width) + "<figcaption>" + said +
           "Left of the slider the golden image, right of it the new one. The key <b>b</b> blinks between them, "
           "<b>d</b> "
           "shows the difference: black where every bit of every channel is the same, else from violet to yellow by "
           "its "
           "logarithm.</figcaption></figure>\n";
}

float value_at(const LayeredPicture::Channel& channel, const LayeredPicture& picture, const SuitePixel& pixel) {
    return channel.values[static_cast<size_t>(pixel.y - picture.y) * static_cast<size_t>(picture.width) +
                          static_cast<size_t>(pixel.x - picture.x)];
}

std::string values_html(const LayeredPicture& golden, const LayeredPicture& fresh, const SuitePixel& pixel) {
    Table table({"channel", ">golden", ">new", ">difference"});
    for (const LayeredPicture::Channel& channel : fresh.channels)
        for (const LayeredPicture::Channel& other : golden.channels) {
            if (other.name != channel.name) continue;
            const float a = value_at(other, golden, pixel);
            const float b = value_at(channel, fresh, pixel);
            if (std::bit_cast<uint32_t>(a) == std::bit_cast<uint32_t>(b) && channel.name.size() > 1) continue;
            table.row({escaped(channel.name), fmt::format("{:.9g}", a), fmt::format("{:.9g}", b),
                       fmt::format("{:.4g}", difference(a, b))});
        }
    return table.html();
}

std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines;
    for (size_t begin = 0; begin < text.size();) {
        const size_t end = std::min(text.find('\n', begin), text.size());
        lines.push_back(text.substr(begin, end - begin));
        begin = end + 1;
    }
    return lines;
}

/// A tree; the lines that the other side's tree does not have are marked.
std::string side_html(const char* title, const std::string& tree, const std::string& other, const std::string& note) {
    std::string html = fmt::format("<div><h4>{}</h4>", title);
    if (!note.empty()) html += fmt::format("<p class=\"note\">{}.</p>", escaped(note));
    if (tree.empty()) return html + "</div>\n";
    html += "<pre class=\"command\" tabindex=\"0\"><code>";
    const std::vector<std::string> others = lines_of(other);
    const std::set<std::string> known(others.begin(), others.end());
    for (const std::string& line : lines_of(tree))
        html += other.empty() || known.count(line) > 0 ? escaped(line) + "\n"
                                                       : fmt::format("<mark>{}</mark>\n", escaped(line));
    return html + "</code></pre></div>\n";
}

std::string pixel_html(const SuiteResult& result, const std::string& folder, const LayeredPicture& golden,
                       const LayeredPicture& fresh, const SuitePixel& pixel, StopSignal stop) {
    std::string html = fmt::format("<h3>Pixel {},{}</h3>\n{}", pixel.x, pixel.y, values_html(golden, fresh, pixel));
    try {
        const SuitePixelWhy why = why_pixel(result, folder, &golden, fresh, pixel, stop);
        html += "<div class=\"why\">" + side_html("Why golden", why.golden, why.fresh, why.golden_note) +
                side_html("Why new", why.fresh, why.golden, why.fresh_note) + "</div>\n";
    } catch (const Error& error) {
        if (error.kind() == ErrorKind::interrupted) throw;
        html += fmt::format("<p class=\"note\">Its rays cannot be followed: {}.</p>\n", escaped(error.what()));
    }
    return html;
}

std::string title_of(const SuiteResult& result) {
    return result.of->name + variant_text(result);
}

std::string notes_html(const SuiteResult& result) {
    std::string html = fmt::format("<p>{}</p>\n", escaped(result.verdict));
    if (result.notes.empty()) return html;
    html += "<ul>\n";
    for (const std::string& note : result.notes) html += fmt::format("<li>{}</li>\n", escaped(note));
    return html + "</ul>\n";
}

}  // namespace

std::string failure_html(const SuiteResult& result, const std::string& folder, const LayeredPicture* golden,
                         const LayeredPicture& fresh, StopSignal stop) {
    std::vector<double> differences;
    const bool same_window = golden && golden->width == fresh.width && golden->height == fresh.height &&
                             golden->x == fresh.x && golden->y == fresh.y;
    if (same_window) differences = pixel_differences(*golden, fresh);
    const std::vector<SuitePixel> worst = worst_pixels(fresh, differences, most_worst_pixels);
    std::string html = pictures_html(golden, fresh, differences, worst.empty() ? nullptr : &worst.front());
    for (const SuitePixel& pixel : worst) html += pixel_html(result, folder, *golden, fresh, pixel, stop);
    return html;
}

std::string suite_page(const Suite& suite, const std::vector<SuiteResult>& results, const SuiteCounts& counts) {
    Table table({"case", ">frame", "backend", "precision", "result"});
    std::string sections;
    size_t number = 0;
    for (const SuiteResult& result : results) {
        std::string name = escaped(result.of->name);
        if (result.failed()) {
            const std::string id = fmt::format("failure{}", ++number);
            name = fmt::format("<a href=\"#{}\">{}</a>", id, name);
            sections +=
                fmt::format("<section id=\"{}\">\n<h2>{}</h2>\n{}{}<p>To accept the new picture:</p>\n{}</section>\n",
                            id, escaped(title_of(result)), notes_html(result), result.page,
                            command_html(fmt::format("render-compare suite {} {} --update", shell_word(suite.folder),
                                                     result.of->name)));
        }
        table.row({name, std::to_string(result.frame), result.of->source_name(result.backend),
                   result.precision ? precision_name(*result.precision) : "–", escaped(result_text(result))});
    }
    const auto context = run_context("render-compare");
    std::string title = fmt::format("{}: {}", suite.name, summary_text(counts));
    title.pop_back();  // the end of the line
    return fmt::format(
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
        "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>{}</title>\n"
        "<style>{}{}</style>\n</head>\n<body>\n<header>\n<p class=\"brand\">Cistula {}</p>\n<h1>{}</h1>\n<p>{}, {}, "
        "{}.</p>\n</header>\n<main>\n<section id=\"cases\">\n<h2>Cases</h2>\n{}</section>\n{}</main>\n"
        "<script>{}</script>\n</body>\n</html>\n",
        escaped(title), page_style, suite_style, CISTULA_VERSION, escaped(title), escaped(suite.path),
        escaped(context["host_name"].get<std::string>()), escaped(context["date"].get<std::string>()), table.html(),
        sections, suite_script);
}

}  // namespace cistula
