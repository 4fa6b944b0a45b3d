// What --pixel prints: a pixel's ray trees, for people and for programs.
#pragma once

#include <string>

#include "options.h"
#include "scene/compile/scene_names.h"
#include "scene/film/pixel_tree.h"

namespace cistula {

struct PixelReport {
    const RenderOptions& options;
    const SceneDescription& scene;
    const SceneNames& names;
    const FrameSettings& settings;
    const CameraFrame& camera;
    const PixelTree& tree;
    std::string scene_hash;
};

/// The middle sample's tree, a line for each other sample, the totals. Verbose: all trees, and nothing folded.
std::string pixel_text(const PixelReport& report, bool verbose);

/// All of it; docs/programs.md names the keys.
std::string pixel_json(const PixelReport& report);

/// The names of the enumerations.
const char* name_of(BranchKind kind);
const char* name_of(BranchEnd end);
const char* name_of(CrossingKind crossing);
const char* name_of(LightFate fate);

/// The radiance of one sample, in the scene's units.
glm::dvec3 radiance_of(const FixedColor& sum, const Film& film);

/// Between two directions, from its cosine.
double degrees_of(double cosine);

/// What the image shows of the pixel: the value of one of its channels, "R" or "error.G" or "Z".
float shown(const PixelReport& report, const std::string& channel);

/// 0 for one sample; the one nearest the pixel's center of several.
size_t middle_sample(int supersample);

/// Rays of all samples of the pixel.
RayCounts rays_of(const PixelTree& tree);

}  // namespace cistula
