// Conversion of a film's integer sums to the channels of a file; lists of layers by name, as --layers takes them:
// path,Z,N.
#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "image/color/color_space.h"
#include "image/picture/picture.h"
#include "render/record/film.h"
#include "render/record/film_layers.h"

namespace cistula {

/// The optional channels of a file, besides R, G, B and A, and how values are given.
struct OutputChannels {
    bool half =
        false;  // R G B A, coverage, error.* and N.* in half precision; id, samples, cost and Z are always float
    bool error = false;
    bool id = false;
    bool samples = false;
    bool cost = false;
    bool z = false;
    bool normal = false;
    bool coverage = false;
    bool position = false;
    bool uv = false;
    bool albedo = false;
    bool depth_ray = false;
    bool material_id = false;
    bool path[path_layer_count] = {};            // by PathLayer
    bool light = false;                          // light layers: all, or these alone
    std::vector<std::string> light_layers = {};  // by their names without "Combined_"
    bool object_mattes = false;
    bool material_mattes = false;
    bool light_mattes = false;
    bool transparent = false;           // samples that meet nothing add nothing to R, G, B and A
    float z_far = 1e10f;                // Z where there is nothing
    const ColorSpace* space = nullptr;  // of R, G, B and error.*; null: that of scenes, lin_rec709_scene
    Compression compression = Compression::zip;
    float dwa_level = 45;
};

/// A layer's name, the group that asks for it too, and its member.
struct NamedLayer {
    std::string_view name, group;
    bool OutputChannels::*wanted;
};
/// All but those by path; of light layers one asks for all.
inline constexpr NamedLayer named_layers[] = {{"P", "data", &OutputChannels::position},
                                              {"uv", "data", &OutputChannels::uv},
                                              {"albedo", "data", &OutputChannels::albedo},
                                              {"N", "data", &OutputChannels::normal},
                                              {"Z", "data", &OutputChannels::z},
                                              {"depth_ray", "data", &OutputChannels::depth_ray},
                                              {"coverage", "data", &OutputChannels::coverage},
                                              {"id", "data", &OutputChannels::id},
                                              {"material_id", "data", &OutputChannels::material_id},
                                              {"samples", "data", &OutputChannels::samples},
                                              {"cost", "data", &OutputChannels::cost},
                                              {"error", "data", &OutputChannels::error},
                                              {"light", "light", &OutputChannels::light},
                                              {"CryptoObject", "cryptomatte", &OutputChannels::object_mattes},
                                              {"CryptoMaterial", "cryptomatte", &OutputChannels::material_mattes},
                                              {"CryptoLight", "cryptomatte", &OutputChannels::light_mattes}};

/// The names of path layers, in the order of PathLayer.
inline constexpr const char* path_layer_names[path_layer_count] = {"emission", "background", "ambient",     "diffuse",
                                                                   "specular", "reflection", "transmission"};

/// The layers, and the parts of pixels, that a film needs for these channels.
LayerRequest layers_for(const OutputChannels& channels);
KeptParts parts_for(const OutputChannels& channels);

/// The attribute that says how many light layers the scene has.
inline constexpr const char* light_layer_count = "cistula:lightLayers";

/// The largest finite number in half precision.
inline constexpr float largest_half = 65504;

/// All channels of a file. R G B: mean radiance. A: 1, or, if the background is transparent, as coverage: the share of
/// samples that hit anything; radiance is premultiplied then. error.R error.G error.B: bound
/// on the error from pruned and cut branches and from whole units of the sums, rounded up so that it stays a bound in
/// the file's precision. id: 1 + solid, or 1 + solids + visible light; 0 for none. samples: per pixel. cost: rays. Z:
/// distance along the view axis, z_far for none. N.X N.Y N.Z: unit normal in world axes, 0 for none. Values of half
/// channels that are over largest_half become that, and are added to `clamped`; such an error.* is no bound. The data
/// window is the film's rectangle. Attributes: chromaticities and colorInteropID of the color space;
/// cistula:background, cistula:zFar and, with dwaa and dwab, cistula:dwaLevel, where they are not the defaults; with
/// light layers their number in the scene, cistula:lightLayers, of which the file may have some;
/// acesImageContainerFlag (set_container_flag).
LayeredPicture to_layers(const Film& film, const OutputChannels& channels, uint64_t* clamped = nullptr);

/// All channels of a file as to_layers gives them, but that values are made as they are written, and counted in
/// `clamped` each time. `film` and `clamped` must outlive them.
LayeredPicture channels_of(const Film& film, const OutputChannels& channels, std::atomic<uint64_t>* clamped = nullptr);

/// States that a file of this picture alone is a container of SMPTE ST 2065-4: R, G, B and A alone, in half, of
/// ACES2065-1, not compressed. Takes the statement away from any other.
void set_container_flag(LayeredPicture& picture);

/// The mean radiance in the film's rectangle; `transparent`: of the samples that hit anything, with their share as
/// alpha.
ColorPicture to_color(const Film& film, bool transparent = false);

/// 128-bit FNV-1a of the image as 32 hexadecimal digits: over the radiance, hits and samples of every pixel, lowest
/// byte first, in pixel order. Nothing else enters, so films with equal hashes hold the same picture.
std::string film_hash(const Film& film);

/// The channels with the layers of a list of layers and groups of layers (docs/programs/layers.md), and no others.
/// Throws Error (usage) with the nearest name for an unknown one, but for light layers, which depend on the scene.
OutputChannels parse_layers(std::string_view text, OutputChannels channels = {});

/// Throws Error (usage) for a light layer that the scene does not have, with those that it has.
void require_light_layers(const OutputChannels& channels, const LayerNames& names);

}  // namespace cistula
