#include "compare/metrics/picture_pairs.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

namespace cistula {
namespace {

std::string level_text(const StoredPicture& picture) {
    return picture.is_whole() ? "" : fmt::format("level {},{}", picture.x_level, picture.y_level);
}

/// The levels of a part.
struct Part {
    std::string name;
    std::vector<const StoredPicture*> levels;

    const StoredPicture* level(const StoredPicture& like) const {
        for (const StoredPicture* picture : levels)
            if (picture->x_level == like.x_level && picture->y_level == like.y_level) return picture;
        return nullptr;
    }
};

std::vector<Part> parts_of(const StoredFile& file) {
    std::vector<Part> parts;
    for (const StoredPicture& picture : file.pictures) {
        if (picture.is_whole()) parts.push_back({picture.name, {}});
        parts.back().levels.push_back(&picture);
    }
    return parts;
}

bool has_all_names(const std::vector<Part>& parts) {
    return std::none_of(parts.begin(), parts.end(), [](const Part& part) { return part.name.empty(); });
}

/// Names by which parts are matched: their own, or numbers; a name that is there twice is numbered too.
std::vector<std::string> keys_of(const std::vector<Part>& parts, bool by_name) {
    std::vector<std::string> keys;
    std::map<std::string, int> used;
    for (size_t i = 0; i < parts.size(); ++i) {
        std::string key = by_name ? parts[i].name : std::to_string(i + 1);
        if (const int times = ++used[key]; times > 1) key += fmt::format(" ({})", times);
        keys.push_back(std::move(key));
    }
    return keys;
}

void add_lone(PicturePairs& result, const StoredPicture* picture, const std::string& key, const char* where) {
    const PicturePair pair{picture, picture, key};
    result.unpaired.push_back({pair, fmt::format("{}only in the {}", pair.subject(), where)});
}

void pair_levels(PicturePairs& result, const Part& a, const Part& b, const std::string& key) {
    for (const StoredPicture* level : a.levels) {
        if (const StoredPicture* other = b.level(*level))
            result.pairs.push_back({level, other, key});
        else
            add_lone(result, level, key, "first");
    }
    for (const StoredPicture* level : b.levels)
        if (!a.level(*level)) add_lone(result, level, key, "second");
}

}  // namespace

std::string PicturePair::subject() const {
    std::string text = part.empty() ? "" : "part " + part;
    if (const std::string level = level_text(*a); !level.empty()) text += (text.empty() ? "" : ", ") + level;
    return text.empty() ? text : text + ": ";
}

std::string PicturePair::shown(const std::string& channel) const {
    const std::string name = name_in_part(part, channel);
    const std::string level = level_text(*a);
    return level.empty() ? name : fmt::format("{} ({})", name, level);
}

PicturePairs pair_pictures(const StoredFile& a, const StoredFile& b) {
    const std::vector<Part> first = parts_of(a);
    const std::vector<Part> second = parts_of(b);
    PicturePairs result;
    if (first.size() == 1 && second.size() == 1) {
        pair_levels(result, first[0], second[0], "");
        return result;
    }
    const bool by_name = has_all_names(first) && has_all_names(second);
    const std::vector<std::string> first_keys = keys_of(first, by_name);
    const std::vector<std::string> second_keys = keys_of(second, by_name);
    auto last = second_keys.begin();
    for (size_t i = 0; i < first.size(); ++i) {
        const auto partner = std::find(second_keys.begin(), second_keys.end(), first_keys[i]);
        if (partner == second_keys.end()) {
            add_lone(result, first[i].levels.front(), first_keys[i], "first");
            continue;
        }
        result.is_other_order |= partner < last;
        last = partner;
        pair_levels(result, first[i], second[static_cast<size_t>(partner - second_keys.begin())], first_keys[i]);
    }
    for (size_t i = 0; i < second.size(); ++i)
        if (std::find(first_keys.begin(), first_keys.end(), second_keys[i]) == first_keys.end())
            add_lone(result, second[i].levels.front(), second_keys[i], "second");
    return result;
}

}  // namespace cistula
