#include "render/record/frame_header.h"

#include <algorithm>
#include <array>
#include <map>
#include "base/fnv128.h"

namespace cistula {
namespace {

constexpr const char* proven_truncation = "cistula:provenTruncation";
constexpr const char* checked_pixels = "cistula:checkedPixels";
constexpr const char* off_pixels = "cistula:offPixels";

using Row = double[4];

std::vector<float> to_floats(const Row (&rows)[4]) {
    std::vector<float> values;
    for (const Row& row : rows)
        for (const double value : row) values.push_back(static_cast<float>(value));
    return values;
}

/// Hash of the camera in double; it also covers what the float matrices round away.
std::string camera_hash(const Camera& camera) {
    Fnv128 hash;
    for (const Vec3<double>* v : {&camera.position, &camera.forward, &camera.right, &camera.up})
        for (const double value : {v->x, v->y, v->z}) hash.add(value);
    hash.add(camera.tan_half_width);
    return hash.hex();
}

}  // namespace

std::vector<float> world_to_camera(const Camera& camera) {
    const Vec3<double>&r = camera.right, &u = camera.up, &f = camera.forward;
    const Row rows[4] = {
        {r.x, u.x, f.x, 0},
        {r.y, u.y, f.y, 0},
        {r.z, u.z, f.z, 0},
        {-dot(camera.position, r), -dot(camera.position, u), -dot(camera.position, f), 1},
    };
    return to_floats(rows);
}

std::vector<float> world_to_ndc(const Camera& camera, int width, int height) {
    const double half_across = 2 * camera.tan_half_width;
    const double half_down = half_across * height / width;
    const Vec3<double>& f = camera.forward;
    const Vec3<double> x = camera.right / half_across + 0.5 * f;
    const Vec3<double> y = 0.5 * f - camera.up / half_down;
    const double depth = -dot(camera.position, f);
    const Row rows[4] = {
        {x.x, y.x, f.x, f.x},
        {x.y, y.y, f.y, f.y},
        {x.z, y.z, f.z, f.z},
        {-dot(camera.position, x), -dot(camera.position, y), depth - 1, depth},
    };
    return to_floats(rows);
}

Attributes header_attributes(const FrameHashes& hashes, const FrameSettings& settings, Precision precision,
                             const CameraFrame& camera) {
    Attributes attributes = {
        {"cistula:cameraHash", camera_hash(camera.camera)},
        {"cistula:cutoff", settings.truncation()},
        {"cistula:depth", settings.depth},
        {"cistula:frame", camera.frame},
        {"cistula:precision", std::string(precision_name(precision))},
        {"cistula:sceneHash", hashes.of(camera.frame)},
        {"cistula:supersample", settings.grid()},
        {"cistula:time", camera.time},
        {"cistula:version", std::string(CISTULA_VERSION)},
        {"imageCounter", camera.frame},
        {"worldToCamera", world_to_camera(camera.camera)},
        {"worldToNDC", world_to_ndc(camera.camera, settings.full_width, settings.full_height)},
    };
    const float width = static_cast<float>(2 * camera.camera.tan_half_width);
    if (width != 1) attributes["screenWindowWidth"] = static_cast<double>(width);  // without it, files say 1
    if (settings.adaptive()) {
        attributes["cistula:maxSamples"] = settings.max_samples;
        attributes["cistula:targetError"] = settings.target_error;
    }
    return attributes;
}

void add_film_attributes(const FilmDescription& film, Attributes& attributes) {
    if (film.rate > 0) attributes["framesPerSecond"] = Ratio{film.rate, static_cast<unsigned>(film.rate_divisor)};
    if (!film.owner.empty()) attributes["owner"] = film.owner;
    if (!film.comments.empty()) attributes["comments"] = film.comments;
}

Attributes header_attributes(const Film& film, const FilmDescription& description, const FrameHashes& hashes,
                             const FrameSettings& settings, Precision precision, const CameraFrame& camera) {
    Attributes attributes = header_attributes(hashes, settings, precision, camera);
    add_film_attributes(description, attributes);
    if (settings.adaptive()) add_target_attributes(target_report(film, settings), attributes);
    return attributes;
}

void add_target_attributes(const TargetReport& report, Attributes& attributes) {
    attributes[proven_truncation] = report.worst_truncation;
    attributes[checked_pixels] = static_cast<int>(report.checked);
    attributes[off_pixels] = static_cast<int>(report.off);
}

Attributes without_target_attributes(Attributes attributes) {
    for (const char* result : {proven_truncation, checked_pixels, off_pixels}) attributes.erase(result);
    return attributes;
}

void join_target_attributes(const Attributes& more, Attributes& attributes) {
    for (auto& [name, value] : attributes) {
        const auto other = more.find(name);
        if (other == more.end() || other->second.index() != value.index()) continue;
        if (name == proven_truncation)
            value = std::max(std::get<double>(value), std::get<double>(other->second));
        else if (name == checked_pixels || name == off_pixels)
            value = std::get<int>(value) + std::get<int>(other->second);
    }
}

bool is_same_image(const LayeredPicture& picture, const LayeredPicture& expected) {
    const auto windows = [](const LayeredPicture& p) {
        return std::array{p.width, p.height, p.x, p.y, p.display_width, p.display_height};
    };
    const auto channels = [](const LayeredPicture& p) {
        std::map<std::string, bool> names;
        for (const LayeredPicture::Channel& channel : p.channels) names[channel.name] = channel.half;
        return names;
    };
    return windows(picture) == windows(expected) && picture.compression == expected.compression &&
           channels(picture) == channels(expected) &&
           without_target_attributes(picture.attributes) == expected.attributes;
}

}  // namespace cistula
