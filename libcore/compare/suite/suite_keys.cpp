#include "compare/suite/suite_keys.h"

#include <algorithm>

#include "cistula/model/lattice_settings.h"
#include "render/picture_size.h"
#include "sequence/frame_list.h"

namespace cistula {
namespace {

constexpr double most = 1e30;

constexpr std::string_view precision_choices[] = {"auto", "float", "double"};
constexpr std::string_view bits_choices[] = {"float", "half"};
constexpr std::string_view background_choices[] = {"opaque", "transparent"};
constexpr std::string_view backend_choices[] = {"embree", "cuda"};
constexpr std::string_view space_choices[] = {"lin_rec709_scene",  "lin_ap1_scene",   "lin_ap0_scene",
                                              "lin_rec2020_scene", "lin_p3d65_scene", "lin_adobergb_scene"};

constexpr Key whole(std::string_view name, double low, double high) {
    return {name, KeyType::whole, {low, high}, {}, false, {}};
}
constexpr Key number(std::string_view name, Range range, std::string_view fallback = {}) {
    return {name, KeyType::number, range, fallback, false, {}};
}
constexpr Key text(std::string_view name) {
    return {name, KeyType::text, {}, {}, false, {}};
}
constexpr Key choice(std::string_view name, std::span<const std::string_view> choices, std::string_view fallback) {
    return {name, KeyType::choice, {}, fallback, false, choices};
}
constexpr Key other(std::string_view name, bool required = false) {
    return {name, KeyType::other, {}, {}, required, {}};
}

constexpr Key suite_list[] = {text("$schema"), other("defaults"), other("cases", true)};

// Those that belong to one case come first; `defaults` has the others.
constexpr size_t own_keys = 5;
constexpr Key case_list[] = {
    other("name", true),
    text("golden"),
    other("hash"),
    other("film_hash"),
    other("recorded"),
    text("scene"),
    other("frames"),
    other("resolution"),
    other("crop"),
    whole("supersample", 1, 64),
    whole("depth", 1, 1024),
    number("cutoff", {0, most}),
    number("target_error", {0, most, true}),
    whole("max_samples", least_lattice_samples, lattice_samples),
    choice("precision", precision_choices, "\"auto\""),
    text("layers"),
    choice("bits", bits_choices, "\"float\""),
    choice("background", background_choices, "\"opaque\""),
    choice("colorspace", space_choices, "\"lin_rec709_scene\""),
    other("z_far"),
    other("thresholds"),
    other("backends"),
    other("tags"),
};

constexpr Key thresholds_list[] = {
    number("fail", {0, most}),
    number("failpercent", {0, 100}, "0"),
    number("hardfail", {0, most}),
};

constexpr Key recorded_list[] = {
    text("version"),
    {"precision", KeyType::choice, {}, {}, false, std::span(precision_choices).subspan(1)},
};

}  // namespace

constexpr KeyTable suite_keys{"suite", suite_list};
constexpr KeyTable suite_case_keys{"case", case_list};
constexpr KeyTable suite_defaults_keys{"defaults", std::span(case_list).subspan(own_keys)};
constexpr KeyTable suite_thresholds_keys{"thresholds", thresholds_list};
constexpr KeyTable suite_recorded_keys{"recorded", recorded_list};

constexpr Key suite_width_key = whole("resolution", 1, largest_side);
constexpr Key suite_offset_key = whole("crop", 0, largest_side - 1);
constexpr Key suite_frame_key = whole("frames", 0, largest_frame);
constexpr Key suite_backend_key = choice("backends", backend_choices, {});

std::span<const KeyTable* const> all_suite_tables() {
    static constexpr const KeyTable* tables[] = {&suite_keys, &suite_case_keys, &suite_defaults_keys,
                                                 &suite_thresholds_keys, &suite_recorded_keys};
    return tables;
}

bool is_suite_name(std::string_view text) {
    const auto is_plain = [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
    };
    return !text.empty() && is_plain(text[0]) && std::all_of(text.begin(), text.end(), [&](char c) {
        return is_plain(c) || suite_name_signs.find(c) != suite_name_signs.npos;
    });
}

}  // namespace cistula
