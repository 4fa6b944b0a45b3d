#include "html.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace cistula::report {
namespace {

/// A number with at most `digits` significant digits, without an exponent.
std::string plain(double value, int digits) {
    const int before = value != 0 ? static_cast<int>(std::floor(std::log10(std::abs(value)))) + 1 : 1;
    std::string text = fmt::format("{:.{}f}", value, std::max(0, digits - before));
    if (text.find('.') != text.npos) {
        while (text.back() == '0') text.pop_back();
        if (text.back() == '.') text.pop_back();
    }
    return text;
}

}  // namespace

std::string time_text(double ms) {
    if (ms >= 1000) return plain(ms / 1000, 3) + " s";
    return plain(ms, 3) + " ms";
}

std::string time_html(const Timing& timing) {
    if (timing.empty()) return "–";
    std::string text = time_text(timing.median());
    if (timing.runs.size() > 1)
        text += fmt::format("<small>{} to {}</small>", time_text(timing.least()), time_text(timing.most()));
    return text;
}

std::string number_text(double value) {
    if (value == 0) return "0";
    const double size = std::abs(value);
    int exponent = static_cast<int>(std::floor(std::log10(size) + 1e-12));
    if (size >= 1e-3 && size < 1e4) return plain(value, size >= 1000 ? 4 : 3);
    std::string mantissa = plain(value / std::pow(10.0, exponent), 2);
    if (mantissa == "10") mantissa = "1", ++exponent;
    static const char* digits[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
    std::string power = exponent < 0 ? "⁻" : "";
    for (const char c : std::to_string(std::abs(exponent))) power += digits[c - '0'];
    return (mantissa == "1" ? "" : mantissa + "·") + "10" + power;
}

std::string count_text(uint64_t value) {
    std::string text = std::to_string(value);
    for (size_t at = text.size(); at > 3;) text.insert(at -= 3, 1, ',');
    return text;
}

std::string float_count_text(double value) {
    return value >= 0 && value < 0x1p64 ? count_text(static_cast<uint64_t>(value)) : number_text(value);
}

std::string percent_text(double share) {
    return plain(100 * share, share < 0.1 ? 2 : 3) + " %";
}

std::string setting_text(const Setting& s) {
    const std::string accuracy = s.adaptive()
                                     ? "target error " + number_text(s.target_error)
                                     : fmt::format("{}×{} samples, depth {}, {}", s.supersample, s.supersample, s.depth,
                                                   s.cutoff > 0 ? "cutoff " + number_text(s.cutoff) : "no cutoff");
    return accuracy + (s.precision == Precision::double_ ? ", double" : ", float");
}

std::string image_tag(const Image& image, const std::string& description) {
    return fmt::format("<img width=\"{}\" height=\"{}\" alt=\"{}\" src=\"data:image/png;base64,{}\">", image.width,
                       image.height, escaped(description), escaped(image.png));
}

double Shown::rmse(const Entry& entry) const {
    return entry.error.rmse + (tight ? 0 : scene->reference.remainder.rms);
}

double Shown::max(const Entry& entry) const {
    return entry.error.max + (tight ? 0 : scene->reference.remainder.max);
}

double Shown::p999(const Entry& entry) const {
    return entry.error.p999 + (tight ? 0 : scene->reference.remainder.max);
}

std::vector<Shown> all_shown(const std::vector<Record>& records) {
    std::vector<Shown> all;
    for (const Record& record : records)
        for (const SceneRecord& scene : record.scenes) {
            Shown shown;
            shown.record = &record;
            shown.scene = &scene;
            size_t same = 0;
            for (const Record& other : records)
                for (const SceneRecord& one : other.scenes) same += one.name == scene.name ? 1 : 0;
            shown.title = same > 1 ? fmt::format("{} · {}", scene.name, record.text("backend")) : scene.name;
            shown.id = fmt::format("scene{}", all.size() + 1);
            for (const Entry& entry : record.entries) {
                if (entry.scene != scene.name) continue;
                shown.entries.push_back(&entry);
                if (shown.smallest_error == 0 || entry.error.rmse < shown.smallest_error)
                    shown.smallest_error = entry.error.rmse;
            }
            shown.tight = 16 * scene.reference.remainder.rms <= shown.smallest_error;
            all.push_back(std::move(shown));
        }
    return all;
}

}  // namespace cistula::report
