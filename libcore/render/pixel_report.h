// The output of --pixel: a pixel's ray trees as text and as JSON.
#pragma once

#include <string>

#include "render/pixel_tree.h"
#include "render/record/film_picture.h"
#include "render/renderer.h"
#include "scene/compile/scene_names.h"

namespace cistula {

struct PixelReport {
    int x, y;  // from the top left of the full frame
    Precision precision;
    std::string scene;  // SceneDescription::source
    SceneNames names;
    FrameSettings settings;
    CameraFrame camera;
    PixelTree tree;
    std::string scene_hash;
    std::string flaws;  // why the pixel cannot be trusted; empty: it can
};

/// The report as text: the middle sample's tree, a line for each other sample, the totals. Verbose: all trees, nothing
/// folded.
std::string pixel_text(PixelReport report, bool verbose);

/// The whole report as JSON; docs/programs/pixel.md documents the keys.
std::string pixel_json(const PixelReport& report);

/// The name of an enumerator.
const char* name_of(BranchKind kind);
const char* name_of(BranchEnd end);
const char* name_of(CrossingKind crossing);
const char* name_of(LightFate fate);

/// The radiance of one sample, in the scene's units.
glm::dvec3 radiance_of(const FixedColor& sum, const Film& film);

/// The angle in degrees between two directions, from its cosine.
double degrees_of(double cosine);

/// The value of one of the pixel's channels in the image: "R", "error.G", "Z", ...
float shown(const PixelReport& report, const std::string& channel);

/// Index of the sample nearest to the pixel's center; 0 for one sample.
size_t middle_sample(int supersample);

/// Ray counts of all samples.
RayCounts rays_of(const PixelTree& tree);

}  // namespace cistula
