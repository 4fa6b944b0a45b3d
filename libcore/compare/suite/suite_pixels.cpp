#include "compare/suite/suite_pixels.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstdlib>
#include <limits>
#include <numeric>

#include "backend_embree/embree/embree_renderer.h"
#include "backend_embree/pixel_tree/embree_pixel_tree.h"
#include "image/picture/picture.h"
#include "image/picture/picture_hash.h"
#include "render/pixel_report.h"
#include "render/record/frame_header.h"
#include "scene/compile/compiled_scene.h"
#include "scene/compile/scene_names.h"
#include "scene/readers/read_scene.h"

namespace cistula {
namespace {

constexpr size_t most_branches = size_t{1} << 14;  // of a pixel that a page tells of

bool has_same(const LayeredPicture& a, const LayeredPicture& b, const char* name) {
    const auto *first = attribute_of<std::string>(a, name), *second = attribute_of<std::string>(b, name);
    return first && second && *first == *second;
}

/// A pixel as it was followed: its trees in words, and a picture of it alone.
struct Followed {
    std::string text;
    LayeredPicture picture;
};

Followed follow_pixel(const SuiteCase& one, const SceneDescription& scene, FrameSettings settings, Precision precision,
                      int frame, const SuitePixel& pixel, StopSignal stop) {
    settings.layers = {};
    const Scene compiled(at_frame(scene, frame), precision, stop);
    const CameraFrame camera = camera_at(scene.camera, frame);
    PixelTree tree =
        make_embree_renderer(compiled)->pixel_tree(camera, settings, pixel.x, pixel.y, {most_branches, stop});
    Followed followed;
    OutputChannels channels;  // R G B A alone, as the case has them
    channels.half = one.channels.half;
    channels.transparent = one.channels.transparent;
    channels.space = one.channels.space;
    followed.picture = to_layers(tree.film, channels);
    round_to_stored(followed.picture);
    followed.text = pixel_text({pixel.x, pixel.y, precision, scene.source, compiled.names(), settings, camera,
                                std::move(tree), compiled.hashes().of(frame), ""},
                               false);
    return followed;
}

/// Whether a followed pixel has the bits of R, G, B and A that a picture has there.
bool gives(const Followed& followed, const LayeredPicture& picture, const SuitePixel& pixel) {
    const auto place = static_cast<size_t>(pixel.y - picture.y) * static_cast<size_t>(picture.width) +
                       static_cast<size_t>(pixel.x - picture.x);
    return std::all_of(followed.picture.channels.begin(), followed.picture.channels.end(), [&](const auto& channel) {
        const LayeredPicture::Channel* of = channel_of(picture, channel.name);
        return of && std::bit_cast<uint32_t>(of->values[place]) == std::bit_cast<uint32_t>(channel.values[0]);
    });
}

/// The settings that the header of a golden image names, and its precision; false if it names too few.
bool read_header(const LayeredPicture& golden, FrameSettings& settings, Precision& precision) {
    RenderRequest named;
    try {
        for (const char* name : {"depth", "supersample", "cutoff", "precision"}) {
            const RequestKey& key = request_key(name);
            key.set(named, attribute_text(golden.attributes.at(std::string(key.attribute))));
        }
    } catch (const std::exception&) {  // it is not there, or out of range
        return false;
    }
    settings.depth = named.frame.depth;
    settings.supersample = named.frame.supersample;
    settings.cutoff = named.frame.cutoff;
    precision = named.precision.value_or(precision);
    return true;
}

void explain_golden(const SuiteCase& one, const SceneDescription& scene, FrameSettings settings, int frame,
                    const LayeredPicture& golden, const LayeredPicture& fresh, const SuitePixel& pixel, StopSignal stop,
                    SuitePixelWhy& why) {
    Precision precision = Precision::single_;
    if (!attribute_of<std::string>(golden, "cistula:sceneHash")) {
        why.golden_note = "only its values are known: its header does not name a scene";
    } else if (!has_same(golden, fresh, "cistula:sceneHash") || !has_same(golden, fresh, "cistula:cameraHash")) {
        why.golden_note = "only its values are known: it shows the scene, or the camera, as it was before a change";
    } else if (attribute_of<double>(golden, "cistula:targetError") || !read_header(golden, settings, precision)) {
        why.golden_note = "only its values are known: its header names no grid of samples to follow";
    } else {
        try {
            Followed followed = follow_pixel(one, scene, settings, precision, frame, pixel, stop);
            if (gives(followed, golden, pixel))
                why.golden = std::move(followed.text);
            else
                why.golden_note =
                    "only its values are known: this version gets others from the scene and the settings that its "
                    "header names";
        } catch (const Error& error) {
            if (error.kind() == ErrorKind::interrupted) throw;
            why.golden_note = fmt::format("only its values are known: {}", error.what());
        }
    }
}

}  // namespace

std::vector<double> pixel_differences(const LayeredPicture& golden, const LayeredPicture& fresh) {
    std::vector<double> differences(static_cast<size_t>(fresh.width) * static_cast<size_t>(fresh.height));
    for (const LayeredPicture::Channel& channel : fresh.channels) {
        const LayeredPicture::Channel* other = channel_of(golden, channel.name);
        for (size_t i = 0; other && i < differences.size(); ++i) {
            const float a = other->values[i];
            const float b = channel.values[i];
            if (std::bit_cast<uint32_t>(a) == std::bit_cast<uint32_t>(b)) continue;
            differences[i] = std::max({differences[i], difference(a, b), std::numeric_limits<double>::denorm_min()});
        }
    }
    return differences;
}

std::vector<SuitePixel> worst_pixels(const LayeredPicture& fresh, const std::vector<double>& differences,
                                     size_t count) {
    constexpr int beside = 8;  // pixels of one fault
    std::vector<size_t> order(differences.size());
    std::iota(order.begin(), order.end(), size_t{0});
    std::erase_if(order, [&](size_t i) { return differences[i] == 0; });
    std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) { return differences[a] > differences[b]; });
    std::vector<SuitePixel> worst;
    for (const size_t i : order) {
        const auto width = static_cast<size_t>(fresh.width);
        const SuitePixel pixel{fresh.x + static_cast<int>(i % width), fresh.y + static_cast<int>(i / width),
                               differences[i]};
        const bool is_near = std::any_of(worst.begin(), worst.end(), [&](const SuitePixel& other) {
            return std::abs(other.x - pixel.x) < beside && std::abs(other.y - pixel.y) < beside;
        });
        if (!is_near) worst.push_back(pixel);
        if (worst.size() == count) break;
    }
    return worst;
}

SuitePixelWhy why_pixel(const SuiteResult& result, const std::string& folder, const LayeredPicture* golden,
                        const LayeredPicture& fresh, const SuitePixel& pixel, StopSignal stop) {
    const SuiteCase& one = *result.of;
    SuitePixelWhy why;
    if (one.is_foreign()) {
        why.fresh_note = "another program rendered it";
        return why;
    }
    if (one.frame.adaptive()) {
        why.fresh_note = "rays of images by a grid of samples are followed, and this is none";
        return why;
    }
    const SceneDescription scene = read_scene_of(one, folder);
    const FrameSettings settings = settings_of(one, scene);
    Followed followed = follow_pixel(one, scene, settings, *result.precision, result.frame, pixel, stop);
    if (!gives(followed, fresh, pixel))
        why.fresh_note =
            fmt::format("the CPU, which is followed here, gets another value than {}", backend_name(result.backend));
    why.fresh = std::move(followed.text);
    if (golden) explain_golden(one, scene, settings, result.frame, *golden, fresh, pixel, stop, why);
    return why;
}

}  // namespace cistula
