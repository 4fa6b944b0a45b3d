#include "compare/suite/suite_render.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>
#include <utility>

#include "base/file_bytes.h"
#include "base/option_text.h"
#include "base/timing.h"
#include "compare/metrics/command.h"
#include "image/exr/exr.h"
#include "image/picture/picture_hash.h"
#include "render/record/film_picture.h"
#include "render/record/frame_header.h"
#include "scene/readers/read_scene.h"
#include "sequence/frame_writer.h"
#include "sequence/sequence_loop.h"

namespace cistula {
namespace {

/// A scene on its backend, with what its frames are made of.
struct PreparedCase {
    SuiteCase one;
    SceneDescription scene;
    FrameSettings settings;
    Precision precision = Precision::single_;
    FrameHashes hashes;
    std::unique_ptr<Renderer> renderer;
};

SuiteFrame render_prepared(PreparedCase& prepared, int frame, RenderProgress& progress) {
    const SuiteCase& one = prepared.one;
    const CameraFrame camera = camera_at(prepared.scene.camera, frame);
    SuiteFrame result;
    result.frame = frame;
    Film film;
    bool whole = false;
    FrameSettings settings = prepared.settings;
    result.seconds = seconds_of([&] { whole = render_frame(*prepared.renderer, camera, settings, film, progress); });
    if (!whole) throw Error(ErrorKind::interrupted, "interrupted");
    if (film.flags != 0)
        throw Error(ErrorKind::failed, fmt::format("frame {} cannot be trusted: {}", frame,
                                                   describe_flags(film.flags, *prepared.renderer, prepared.scene,
                                                                  prepared.precision, camera, settings)))
            .at(prepared.scene.source);
    uint64_t clamped = 0;
    LayeredPicture& picture = result.picture;
    picture = to_layers(film, one.channels, &clamped);
    if (clamped > 0) result.notes.push_back("clamped: " + over_largest_half(clamped));
    round_to_stored(picture);
    picture.attributes.merge(
        header_attributes(film, prepared.scene.film, prepared.hashes, prepared.settings, prepared.precision, camera));
    result.film_hash = film_hash(film);
    return result;
}

/// A word of a command with its places for the output and the frame filled.
std::string filled(std::string word, const std::string& output, int frame) {
    const std::pair<std::string, std::string> places[] = {{"{output}", output}, {"{frame}", std::to_string(frame)}};
    for (const auto& [place, text] : places)
        for (size_t at = word.find(place); at != word.npos; at = word.find(place, at + text.size()))
            word.replace(at, place.size(), text);
    return word;
}

LayeredPicture picture_of_command(const SuiteCase& one, const std::string& folder, int frame, StopSignal stop) {
    const TemporaryFolder temporary;
    const std::string output = temporary.file("rendered.exr");
    std::vector<std::string> words;
    for (const std::string& word : one.command) words.push_back(filled(word, output, frame));
    const std::optional<CommandEnd> end = run_command(words, folder, temporary, stop);
    if (!end) throw Error(ErrorKind::failed, words[0] + ": cannot be started", "check the spelling");
    if (end->code != 0)
        throw Error(ErrorKind::failed, fmt::format("{} {}: {}", words[0],
                                                   end->code < 0 ? "was ended by a signal"
                                                                 : fmt::format("ended with exit code {}", end->code),
                                                   end->said.empty() ? "it said nothing" : end->said));
    if (!std::filesystem::exists(output))
        throw Error(ErrorKind::failed, fmt::format("{}: wrote no {{output}}", words[0]));
    return read_exr(output);
}

}  // namespace

SceneDescription read_scene_of(const SuiteCase& one, const std::string& folder) {
    const std::string path = one.scene_path(folder);
    std::error_code error;
    if (std::filesystem::exists(path, error)) check_readable(path);
    return read_scene(path);
}

SuiteScene prepare_foreign(const SuiteCase& one, const std::string& folder, bool run_commands) {
    if (!one.command.empty() && !run_commands)
        fail_usage(fmt::format("its command is not run: {}", fmt::join(one.command, " ")),
                   "`run_commands` runs commands of suites");
    SuiteScene result;
    result.render = [&one, folder](int frame, RenderProgress& progress) {
        SuiteFrame rendered;
        rendered.frame = frame;
        rendered.seconds = seconds_of([&] {
            rendered.picture = one.command.empty() ? read_exr(one.rendered_path(folder, frame))
                                                   : picture_of_command(one, folder, frame, progress.stop);
        });
        return rendered;
    };
    return result;
}

FrameSettings settings_of(const SuiteCase& one, const SceneDescription& scene) {
    try {
        return frame_settings(one, scene);
    } catch (const Error& error) {
        throw error.named(quoted_name).at(one.place);
    }
}

SuiteScene prepare_case(const SuiteCase& one, const std::string& folder, Backend backend, const CudaOptions& cuda,
                        StopSignal stop) {
    SuiteScene result;
    const auto prepared = std::make_shared<PreparedCase>();
    prepared->one = one;
    prepared->scene = read_scene_of(one, folder);
    prepared->settings = settings_of(one, prepared->scene);
    const Scene scene(prepared->scene, one.precision, stop);
    if (!scene.precision_note().empty()) result.notes.push_back(scene.precision_note());
    result.notes.insert(result.notes.end(), scene.warnings().begin(), scene.warnings().end());
    require_light_layers(one.channels, *scene.layer_names());
    result.precision = prepared->precision = scene.precision();
    prepared->hashes = scene.hashes();
    prepared->renderer = make_renderer(backend, scene, cuda);
    result.render = [prepared](int frame, RenderProgress& progress) {
        return render_prepared(*prepared, frame, progress);
    };
    return result;
}

}  // namespace cistula
