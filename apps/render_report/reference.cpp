#include "reference.h"

#include <fmt/format.h>

#include <cstdlib>
#include <cstring>
#include <filesystem>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/file_bytes.h"
#include "base/fnv128.h"
#include "base/machine.h"
#include "base/suggest.h"
#include "base/timing.h"
#include "render/record/frame_header.h"

namespace cistula::report {
namespace {

constexpr double worth_keeping = 1;  // seconds; slower pictures are cached

std::string hash_of(const std::string& bytes) {
    Fnv128 hash;
    hash.add_bytes(bytes.data(), bytes.size());
    return hash.hex();
}

/// Cache key: everything that the picture depends on, including the code.
std::string key_of(const Frames& frames, const std::string& scene_hash, const Setting& setting) {
    const FrameSettings settings = frame_settings(setting, frames.width, frames.height);
    const Attributes attributes = header_attributes(scene_hash, settings, setting.precision, frames.camera);
    return fmt::format("{} {} {}x{} {} {} {}", scene_hash, std::get<std::string>(attributes.at("cistula:cameraHash")),
                       frames.width, frames.height, setting_name(setting), CISTULA_VERSION, build_commit());
}

}  // namespace

std::string default_cache() {
    for (const auto& [variable, below] :
         {std::pair("XDG_CACHE_HOME", "cistula"), std::pair("HOME", ".cache/cistula")}) {
        const char* folder = std::getenv(variable);
        if (folder != nullptr && folder[0] == '/') return std::filesystem::path(folder) / below;
    }
    return {};
}

// File format: one line of JSON with the hash of the rest; then three doubles per pixel in native byte order.
std::string pack_reference(const ReferencePicture& reference, const std::string& key) {
    const Picture& picture = reference.picture;
    std::string pixels(picture.pixels.size() * sizeof(picture.pixels[0]), '\0');
    if (!pixels.empty()) std::memcpy(pixels.data(), picture.pixels.data(), pixels.size());
    const Json head = {{"key", key},
                       {"width", picture.width},
                       {"height", picture.height},
                       {"remainder", reference.record.remainder},
                       {"hash", hash_of(pixels)}};
    return head.dump() + "\n" + pixels;
}

std::optional<ReferencePicture> unpack_reference(const std::string& bytes, const std::string& key) {
    const size_t end = bytes.find('\n');
    if (end == bytes.npos) return std::nullopt;
    const Json head = Json::parse(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(end), nullptr, false);
    const std::string pixels = bytes.substr(end + 1);
    if (!head.is_object() || head.value("key", "") != key || head.value("hash", "") != hash_of(pixels))
        return std::nullopt;
    ReferencePicture reference;
    Picture& picture = reference.picture;
    picture.width = head.value("width", 0);
    picture.height = head.value("height", 0);
    picture.pixels.resize(pixels.size() / sizeof(picture.pixels[0]));
    if (picture.width < 1 || picture.pixels.size() * sizeof(picture.pixels[0]) != pixels.size() ||
        picture.pixels.size() != static_cast<size_t>(picture.width) * static_cast<size_t>(picture.height))
        return std::nullopt;
    std::memcpy(picture.pixels.data(), pixels.data(), pixels.size());
    head.at("remainder").get_to(reference.record.remainder);
    return reference;
}

std::optional<ReferencePicture> reference_picture(Frames& frames, const std::string& scene_hash, const Setting& setting,
                                                  const FrameLimit& limit, const std::string& cache) {
    const std::string key = key_of(frames, scene_hash, setting);
    const std::string file =
        cache.empty() ? "" : (std::filesystem::path(cache) / (hash_of(key) + ".reference")).string();
    ReferencePicture reference;
    std::error_code ignored;
    if (!file.empty() && std::filesystem::exists(file, ignored)) {
        std::optional<ReferencePicture> found;
        const double seconds = seconds_of([&] {
            try {
                found = unpack_reference(read_file(file), key);
            } catch (const Error&) {  // render it again
            }
        });
        if (found) {
            found->record.setting = setting;
            found->record.seconds = seconds;
            found->record.cached = true;
            return found;
        }
    }
    Film film;
    frames.progress.frame(static_cast<uint64_t>(frames.width) * static_cast<uint64_t>(frames.height));
    const std::optional<double> seconds = frames.render_within(limit, setting, film);
    if (!seconds) return std::nullopt;
    reference.record.seconds = *seconds;
    reference.record.setting = setting;
    reference.record.remainder = remainder_of(film);
    reference.picture = resolve_picture(film);
    if (file.empty() || reference.record.seconds < worth_keeping) return reference;
    try {
        std::filesystem::create_directories(cache);
        write_file_atomically(file, pack_reference(reference, key));
    } catch (const std::exception& error) {
        frames.progress.say(
            fmt::format("render-report: warning: a reference was not kept: {}", one_line(error.what())));
    }
    return reference;
}

}  // namespace cistula::report
