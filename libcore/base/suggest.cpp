#include "base/suggest.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace cistula {
namespace {

constexpr size_t longest_compared = 64;  // distances take time quadratic in the length

/// What other programs call an option, a key or a layer, and names here, the likelier first. Options go by their keys.
constexpr std::pair<std::string_view, std::string_view> synonyms[] = {
    {"size", "res"},         {"size", "width"},
    {"size", "radius"},      {"resolution", "res"},
    {"resolution", "width"}, {"width", "res"},
    {"height", "res"},       {"fps", "frames_per_second"},
    {"spp", "supersample"},  {"samples", "supersample"},
    {"max_depth", "depth"},  {"bounces", "depth"},
    {"ior", "index"},        {"shininess", "exponent"},
    {"intensity", "color"},  {"lookat", "target"},
    {"look_at", "target"},   {"depth", "Z"},
    {"normal", "N"},         {"normals", "N"},
};

/// A name as a key: "max_depth" for "--Max-Depth".
std::string as_key(std::string_view name) {
    if (name.starts_with("--")) name.remove_prefix(2);
    std::string key = lower_case(std::string(name.substr(0, longest_compared)));
    std::replace(key.begin(), key.end(), '-', '_');
    return key;
}

/// The known name by which another program's goes here, or "".
std::string_view translated(std::string_view name, const std::vector<std::string_view>& known) {
    const std::string key = as_key(name);
    for (const auto& [other, ours] : synonyms)
        if (other == key)
            for (const std::string_view candidate : known)
                if (candidate == ours || (candidate.starts_with("--") && candidate.substr(2) == ours)) return candidate;
    return {};
}

/// The edit distance, but less where only case differs or the candidate goes on after the name.
size_t distance_to(std::string_view candidate, std::string_view name) {
    if (lower_case(std::string(name)) == lower_case(std::string(candidate))) return 0;
    if (name.size() >= 3 && candidate.starts_with(name)) return 1;
    return edit_distance(name, candidate);
}

}  // namespace

size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<size_t> before(b.size() + 1), above(b.size() + 1), row(b.size() + 1);
    for (size_t j = 0; j <= b.size(); ++j) above[j] = j;
    for (size_t i = 1; i <= a.size(); ++i) {
        row[0] = i;
        for (size_t j = 1; j <= b.size(); ++j) {
            row[j] = std::min({above[j] + 1, row[j - 1] + 1, above[j - 1] + (a[i - 1] != b[j - 1])});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                row[j] = std::min(row[j], before[j - 2] + 1);
        }
        std::swap(before, above);
        std::swap(above, row);
    }
    return above[b.size()];
}

std::string suggestion(std::string_view name, const std::vector<std::string_view>& known, std::string_view plural) {
    if (known.empty()) return fmt::format("there are no {}", plural);
    std::string_view nearest = translated(name, known);
    size_t least = std::max<size_t>(2, name.size() / 3) + 1;
    if (nearest.empty() && name.size() <= longest_compared) {
        for (const std::string_view candidate : known) {
            if (candidate.size() > longest_compared) continue;
            const size_t distance = distance_to(candidate, name);
            if (distance < least && distance < candidate.size()) {
                least = distance;
                nearest = candidate;
            }
        }
    }
    if (!nearest.empty()) return fmt::format("did you mean '{}'?", one_line(nearest));
    constexpr size_t most_listed = 16;
    std::string list;
    for (size_t i = 0; i < known.size() && i < most_listed; ++i)
        list += (i ? ", " : "") + first_characters(known[i], longest_compared);
    return fmt::format("known {}: {}{}", plural, list, known.size() > most_listed ? ", ..." : "");
}

std::string nearest_first(std::string_view name, const std::vector<std::string_view>& known, std::string_view plural) {
    if (known.empty()) return fmt::format("there are no {}", plural);
    constexpr size_t most_listed = 64;
    std::vector<std::pair<double, std::string_view>> by_distance;  // as a share of the longer name
    const std::string wanted = lower_case(std::string(name.substr(0, longest_compared)));
    const std::string_view meant = translated(name, known);
    for (const std::string_view candidate : known) {
        const std::string other = lower_case(std::string(candidate.substr(0, longest_compared)));
        const auto longer = static_cast<double>(std::max({wanted.size(), other.size(), size_t{1}}));
        const double distance = static_cast<double>(edit_distance(wanted, other)) / longer;
        by_distance.emplace_back(candidate == meant ? -1 : distance, candidate);
    }
    std::stable_sort(by_distance.begin(), by_distance.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    std::string list;
    for (size_t i = 0; i < by_distance.size() && i < most_listed; ++i)
        list += (i ? ", " : "") + first_characters(by_distance[i].second, longest_compared);
    const std::string rest = known.size() > most_listed ? fmt::format(", ... ({} in all)", known.size()) : "";
    return fmt::format("the {} are: {}{}", plural, list, rest);
}

std::string_view scene_key_of_option(std::string_view name) {
    const std::string key = as_key(name);
    for (const auto& [other, ours] : synonyms)
        if (other == key && ours.size() > 1) return ours;
    return {};
}

}  // namespace cistula
