#include "compare/suite/suite_keys.h"

#include <algorithm>

#include "cistula/model/lattice_settings.h"
#include "render/picture_size.h"
#include "sequence/frame_list.h"
#include "sequence/render_request.h"

namespace cistula {
namespace {

constexpr double most = 1e30;
constexpr std::string_view precision_choices[] = {"float", "double"};

constexpr Key suite_list[] = {{"$schema", KeyType::text}, {"defaults"}, {"cases", KeyType::other, {}, {}, true}};

// Those that belong to one case come first; `defaults` has the others.
constexpr size_t own_keys = 7;

std::span<const Key> case_list() {
    static const std::vector<Key> list = [] {
        std::vector<Key> keys = {{"name", KeyType::other, {}, {}, true},
                                 {"golden", KeyType::text},
                                 {"hash"},
                                 {"film_hash"},
                                 {"recorded"},
                                 {"rendered", KeyType::text},
                                 {"command"}};
        for (const RequestKey& key : request_keys())
            if (key.in_suite) keys.push_back(key);
        keys.insert(keys.end(), {{"thresholds"}, {"backends"}, {"tags"}});
        return keys;
    }();
    return list;
}

constexpr Key thresholds_list[] = {
    {"fail", KeyType::number, {0, most}},     {"failpercent", KeyType::number, {0, 100}, "0"},
    {"hardfail", KeyType::number, {0, most}}, {"failflip", KeyType::number, {0, 1}},
    {"failssim", KeyType::number, {-1, 1}},   {"allow_nonfinite", KeyType::boolean, {}, "false"},
};

constexpr Key recorded_list[] = {
    {"version", KeyType::text},
    {"precision", KeyType::choice, {}, {}, false, precision_choices},
};

}  // namespace

constexpr KeyTable suite_keys{"suite", suite_list};
const KeyTable suite_case_keys{"case", case_list()};
const KeyTable suite_defaults_keys{"defaults", case_list().subspan(own_keys)};
constexpr KeyTable suite_thresholds_keys{"thresholds", thresholds_list};
constexpr KeyTable suite_recorded_keys{"recorded", recorded_list};
constexpr Key suite_backend_key{"backends", KeyType::choice, {}, {}, false, backend_names};

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
