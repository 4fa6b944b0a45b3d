#include "apps/common/progress_record.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include <nlohmann/json.hpp>

#include "base/shown_text.h"

namespace cistula {
namespace {

using Json = nlohmann::ordered_json;

std::string line_of(const Json& json) {
    return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

/// The share of the sequence's frames that is rendered.
double film_fraction(const ProgressState& state) {
    return std::min((static_cast<double>(state.index) + state.fraction) / static_cast<double>(state.count), 1.0);
}

std::string openjd_progress(double fraction) {
    return fmt::format("openjd_progress: {:.2f}", 100 * fraction);
}

std::string openjd_event(const EventRecord& event, const ProgressState& state) {
    const std::string_view name = event.event;
    if (name == "frame") return openjd_progress(film_fraction(state)) + "\nopenjd_status: " + progress_line(state);
    if (name == "snapshot") return "openjd_status: " + message_line("snapshot: " + event.file);
    if (name == "end") return openjd_progress(1) + "\nopenjd_status: " + event.text;
    return "";
}

}  // namespace

std::string event_record(ProgressStyle style, const EventRecord& event, const ProgressState& state) {
    if (style == ProgressStyle::openjd) return openjd_event(event, state);
    if (style != ProgressStyle::json) return "";
    Json json = {{"event", event.event}};
    const std::string_view name = event.event;
    if (event.frame >= 0) json["frame"] = event.frame;
    if (name == "begin" || name == "frame") {
        if (name == "frame") json["index"] = state.index;
        json["frames"] = state.count;
    }
    if (event.fraction >= 0) json["fraction"] = event.fraction;
    if (!event.file.empty()) json["file"] = event.file;
    if (!event.text.empty()) json["text"] = event.text;
    if (name == "read") {
        json["files"] = Json::array();
        for (const std::string& file : event.files) json["files"].push_back(utf8_name(file));
    }
    return line_of(json);
}

std::string state_record(ProgressStyle style, const ProgressState& state) {
    if (style == ProgressStyle::openjd)
        return openjd_progress(film_fraction(state)) + "\nopenjd_status: " + progress_line(state);
    if (style != ProgressStyle::json) return "";
    const double left = remaining_seconds(state);
    Json json = {{"event", "progress"},
                 {"frame", state.frame},
                 {"fraction", state.fraction},
                 {"film_fraction", film_fraction(state)},
                 {"rays_per_second", state.rays_per_second},
                 {"eta", nullptr}};
    if (left >= 0) json["eta"] = left;
    return line_of(json);
}

std::string failure_record(ProgressStyle style, const std::string& message, ExitCode code) {
    if (style == ProgressStyle::openjd)
        return (code == ExitCode::target ? "openjd_status: " : "openjd_fail: ") + message_line(message);
    if (style != ProgressStyle::json) return "";
    return line_of(Json{{"event", "error"}, {"text", message}, {"exit_code", static_cast<int>(code)}});
}

}  // namespace cistula
