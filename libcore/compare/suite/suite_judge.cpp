#include "compare/suite/suite_judge.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "compare/metrics/report.h"
#include "image/picture/picture.h"
#include "image/picture/picture_hash.h"

namespace cistula {
namespace {

std::string joined(const std::vector<std::string>& parts, const char* between) {
    return fmt::format("{}", fmt::join(parts, between));
}

std::string window_text(const LayeredPicture& p) {
    const bool whole = p.x == 0 && p.y == 0 && p.width == p.display_width && p.height == p.display_height;
    return whole
               ? fmt::format("{}x{}", p.width, p.height)
               : fmt::format("{}x{} at {},{} of {}x{}", p.width, p.height, p.x, p.y, p.display_width, p.display_height);
}

/// The names of channels that only the first has.
std::vector<std::string> channels_alone(const LayeredPicture& in, const LayeredPicture& other) {
    std::set<std::string> names, others;
    for (const auto& channel : in.channels) names.insert(channel.name);
    for (const auto& channel : other.channels) others.insert(channel.name);
    std::vector<std::string> alone;
    std::set_difference(names.begin(), names.end(), others.begin(), others.end(), std::back_inserter(alone));
    return alone;
}

/// What differs in sizes and layers; empty: nothing.
std::string other_structure(const LayeredPicture& golden, const LayeredPicture& fresh, bool common_channels) {
    std::vector<std::string> parts;
    if (window_text(golden) != window_text(fresh))
        parts.push_back(
            fmt::format("another size: {} in the golden image, {} rendered", window_text(golden), window_text(fresh)));
    if (common_channels) return joined(parts, "; ");
    const auto lacking = channels_alone(golden, fresh);
    const auto added = channels_alone(fresh, golden);
    if (!lacking.empty()) parts.push_back("layers of the golden image alone: " + joined(lacking, ", "));
    if (!added.empty()) parts.push_back("layers that the golden image lacks: " + joined(added, ", "));
    return joined(parts, "; ");
}

/// A picture without its attributes, or without its channels.
LayeredPicture values_of(LayeredPicture picture) {
    picture.attributes.clear();
    return picture;
}
LayeredPicture header_of(const LayeredPicture& picture) {
    LayeredPicture header;
    header.attributes = picture.attributes;
    return header;
}

std::string text_attribute(const LayeredPicture& picture, const char* name) {
    const auto* text = attribute_of<std::string>(picture, name);
    return text ? *text : "";
}

/// "recorded in float by version 0.1.0, rendered in double by 0.2.0", if either differs; unknown ones are empty.
std::string other_origin(const std::string& version, const std::string& precision, const LayeredPicture& fresh) {
    const std::string now_version = text_attribute(fresh, "cistula:version");
    const std::string now_precision = text_attribute(fresh, "cistula:precision");
    const bool other_version = !version.empty() && !now_version.empty() && version != now_version;
    const bool other_precision = !precision.empty() && !now_precision.empty() && precision != now_precision;
    if (!other_version && !other_precision) return "";
    return fmt::format("recorded{}{}, rendered{}{}", other_precision ? " in " + precision : "",
                       other_version ? " by version " + version : "", other_precision ? " in " + now_precision : "",
                       other_version ? " by " + now_version : "");
}

/// The channel that differs most, with its worst pixel; empty if none differs.
std::string worst_channel(const Comparison& comparison) {
    const auto worst = std::max_element(
        comparison.channels.begin(), comparison.channels.end(),
        [](const auto& a, const auto& b) { return a.max < b.max || (a.max == b.max && a.differing < b.differing); });
    if (worst == comparison.channels.end() || worst->differing == 0) return "";
    return fmt::format("; worst: {} at {}", worst->name, worst_text(*worst));
}

/// The comparison of a golden image that is there. With thresholds other programs' pictures need not have all of its
/// channels.
void judge_picture(const LayeredPicture& golden, const LayeredPicture& fresh, StopSignal stop, SuiteResult& result) {
    const Thresholds& thresholds = result.of->thresholds;
    Selection selection;
    selection.common_channels = result.of->is_foreign() && thresholds.any();
    const Comparison comparison = compare_pictures(values_of(golden), values_of(fresh), thresholds, selection, stop);
    const bool holds = passes(comparison, thresholds);
    result.outcome = holds ? Outcome::holds : Outcome::differs;
    if (const std::string other = other_structure(golden, fresh, selection.common_channels); !other.empty())
        result.verdict = other;
    else if (holds)
        result.verdict = comparison.differing() == 0 ? "equal" : verdict(comparison, thresholds);
    else
        result.verdict = verdict(comparison, thresholds) + worst_channel(comparison);
    const Comparison headers = compare_pictures(header_of(golden), header_of(fresh), {});
    for (const std::string& line : headers.header)
        if (!golden.attributes.empty() && !result.of->is_foreign()) result.notes.push_back("header: " + line);
    result.comparison = comparison;
}

}  // namespace

const char* outcome_name(Outcome outcome) {
    constexpr const char* names[] = {"holds", "differs", "missing", "broken", "skipped"};
    return names[static_cast<size_t>(outcome)];
}

bool same_bits(const LayeredPicture& a, const LayeredPicture& b) {
    return passes(compare_pictures(values_of(a), values_of(b), {}), {});
}

void judge(const SuiteFrame& frame, size_t index, const LayeredPicture* golden, StopSignal stop, SuiteResult& result) {
    const SuiteCase& one = *result.of;
    const LayeredPicture& fresh = frame.picture;
    result.width = fresh.width;
    result.height = fresh.height;
    result.seconds = frame.seconds;
    result.film_hash = frame.film_hash;
    result.hash = picture_hash(fresh);
    result.notes.insert(result.notes.end(), frame.notes.begin(), frame.notes.end());
    if (!one.hashes.empty()) result.expected_hash = one.hashes[index];
    if (!one.film_hashes.empty()) result.expected_film_hash = one.film_hashes[index];
    const std::string update = fmt::format("`update` {} records it", one.name);
    std::string origin;
    if (golden) {
        origin = other_origin(text_attribute(*golden, "cistula:version"), text_attribute(*golden, "cistula:precision"),
                              fresh);
        judge_picture(*golden, fresh, stop, result);
    } else if (!one.golden.empty()) {
        result.outcome = Outcome::missing;
        result.verdict = fmt::format("no golden image: {} is not there; {}", result.golden, update);
        return;
    } else if (one.hashes.empty()) {
        result.outcome = Outcome::missing;
        result.verdict = fmt::format("neither \"golden\" nor \"hash\" says what is expected; {}", update);
        return;
    } else {
        origin = other_origin(one.recorded_version,
                              one.recorded_precision ? precision_name(*one.recorded_precision) : "", fresh);
        result.outcome = result.hash == result.expected_hash ? Outcome::holds : Outcome::differs;
        result.verdict = result.outcome == Outcome::holds
                             ? "equal"
                             : fmt::format("the hash is {}, {} is expected", result.hash, result.expected_hash);
    }
    if (!result.expected_film_hash.empty() && result.film_hash != result.expected_film_hash) {
        result.outcome = Outcome::differs;
        result.verdict += fmt::format("; the film's integers differ: film_hash is {}, {} is expected", result.film_hash,
                                      result.expected_film_hash);
    }
    if (origin.empty()) return;
    if (result.failed())
        result.verdict = fmt::format("{}: {}", origin, result.verdict);
    else
        result.notes.insert(result.notes.begin(), origin);
}

}  // namespace cistula
