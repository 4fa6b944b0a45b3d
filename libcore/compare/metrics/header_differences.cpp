#include "compare/metrics/picture_pairs.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "base/fnv128.h"
#include "base/shown_text.h"

namespace cistula {
namespace {

constexpr const char* none = "(none)";

/// The part of a long text around the place where it differs from another.
std::string excerpt(const std::string& text, const std::string& other) {
    constexpr size_t before = 20;
    constexpr size_t most = 120;
    if (text.size() <= most) return text;
    const auto place = std::mismatch(text.begin(), text.end(), other.begin(), other.end()).first;
    const auto differs = static_cast<size_t>(place - text.begin());
    const size_t start = differs < most - before ? 0 : differs - before;
    return fmt::format("{}{}{}", start > 0 ? "..." : "", text.substr(start, most),
                       start + most < text.size() ? "..." : "");
}

std::string attribute_line(const PicturePair& pair, const std::string& name, const StoredAttribute* a,
                           const StoredAttribute* b) {
    std::string first = a ? a->text : none;
    std::string second = b ? b->text : none;
    if (a && b && a->type != b->type) {
        first = fmt::format("{} ({})", excerpt(first, second), a->type);
        second = fmt::format("{} ({})", excerpt(second, a->text), b->type);
    } else if (a && b && first == second) {  // as NaNs with other bits
        const auto hash = [](const StoredAttribute& attribute) {
            Fnv128 sum;
            sum.add_bytes(attribute.value.data(), attribute.value.size());
            return sum.hex();
        };
        first = fmt::format("{} bytes, hash {}", a->value.size(), hash(*a));
        second = fmt::format("{} bytes, hash {}", b->value.size(), hash(*b));
    }
    return fmt::format("{}{}: {} / {}", pair.subject(), name, excerpt(first, second), excerpt(second, first));
}

std::string type_text(const StoredChannel& channel) {
    std::string type(type_name(channel.type));
    if (channel.x_sampling == 1 && channel.y_sampling == 1) return type;
    return fmt::format("{}, a value for {}x{} pixels", type, channel.x_sampling, channel.y_sampling);
}

}  // namespace

std::vector<std::string> differing_windows(const PicturePair& pair) {
    std::vector<std::string> lines;
    const auto add = [&](const char* what, const PixelRect& a, const PixelRect& b) {
        if (a != b) lines.push_back(fmt::format("{}{}: {} / {}", pair.subject(), what, format_rect(a), format_rect(b)));
    };
    add("data window", pair.a->data, pair.b->data);
    add("display window", pair.a->display, pair.b->display);
    return lines;
}

std::vector<std::string> differing_attributes(const PicturePair& pair) {
    const auto &first = pair.a->attributes, &second = pair.b->attributes;
    std::vector<std::string> lines;
    if (pair.a->name != pair.b->name)
        lines.push_back(fmt::format("{}name of the part: {} / {}", pair.subject(),
                                    pair.a->name.empty() ? none : pair.a->name,
                                    pair.b->name.empty() ? none : pair.b->name));
    std::set<std::string> names;
    for (const auto* attributes : {&first, &second})
        for (const auto& entry : *attributes) names.insert(entry.first);
    for (const std::string& name : names) {
        const auto a = first.find(name);
        const auto b = second.find(name);
        const bool in_first = a != first.end();
        const bool in_second = b != second.end();
        if (in_first && in_second && a->second == b->second) continue;
        lines.push_back(attribute_line(pair, name, in_first ? &a->second : nullptr, in_second ? &b->second : nullptr));
    }
    return lines;
}

std::vector<std::string> differing_packing(const PicturePair& pair) {
    std::vector<std::string> lines;
    for (const auto& [what, how] : pair.a->packing) {
        const auto other = pair.b->packing.find(what);
        if (other != pair.b->packing.end() && other->second != how)
            lines.push_back(fmt::format("{}{}: {} / {}", pair.subject(), what, how, other->second));
    }
    return lines;
}

std::string differing_type(const PicturePair& pair, const StoredChannel& a, const StoredChannel& b) {
    const std::string first = type_text(a);
    const std::string second = type_text(b);
    return first == second ? "" : fmt::format("channel {}: {} / {}", pair.shown(a.name), first, second);
}

}  // namespace cistula
