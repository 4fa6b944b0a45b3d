// A pixel's ray trees as values: which rays, what they met, what each added to the pixel's sums. In scene units,
// whatever the precision; sums are the pixel's integers.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "cistula/geometry/hit.h"
#include "scene/film/film.h"

namespace cistula {

using FixedColor = std::array<int64_t, 3>;

enum class BranchKind { primary, mirrored, transmitted };

/// What became of a branch. `dropped`: there was no room for it, and the pixel is flagged.
enum class BranchEnd { surface, light, background, pruned, cut, dropped };

struct FaceMet {
    uint32_t solid = 0;
    uint32_t face = 0;      // of a convex solid; else the number of the triangle in its object
    bool triangle = false;  // the latter
    CrossingKind crossing = CrossingKind::enter;
    double distance = 0;  // from where the branch starts
};

/// A face with nothing to shade: of a clear material, or inside a medium of higher priority.
struct FacePassed : FaceMet {
    bool inside = false;  // the latter
};

enum class LightFate {
    adds,
    behind,   // the face looks away from it, or the light lies in its plane
    nothing,  // its light is black there
    shadow,   // no channel arrives
};

struct LightShare {
    uint32_t light = 0;
    LightFate fate = LightFate::adds;
    double cosine = 0;  // N.L
    double distance = 0;
    glm::dvec3 unshadowed{0};       // what it would add to the local term
    glm::dvec3 arrives{1};          // transmittance, per channel
    std::vector<uint32_t> through;  // solids on the way that take light away, in their order; at most 8
    FixedColor adds{};
};

struct PixelSurface : FaceMet {
    uint32_t material = 0;
    double t = 0;                              // along the line, which starts where it last bent or was mirrored
    std::vector<FaceMet> also;                 // other crossings that rounding cannot tell apart from this one
    glm::dvec3 point{0}, normal{0}, color{0};  // the normal toward the viewer; the color with its texture
    std::vector<uint32_t> before, beyond;      // solids around, that of the highest priority first
    double index_before = 1, index_beyond = 1;
    double cosine = 1;  // of the angle between ray and normal
    bool bends = false, total = false;
    double bent_cosine = 1;          // the same on the other side, where it bends
    double fresnel = -1;             // reflectance; -1: not asked for
    double local = 0, mirrored = 0;  // shares
    glm::dvec3 through{0};
    glm::dvec3 ambient{0};  // of the local term
    FixedColor ambient_adds{};
    std::vector<LightShare> lights;  // all of the scene, where local is above 0
};

struct PixelBranch {
    BranchKind kind = BranchKind::primary;
    BranchEnd end = BranchEnd::background;
    int depth = 0;  // surfaces above it
    glm::dvec3 weight{1};
    glm::dvec3 arriving{1};  // the weight less what is absorbed on the way
    glm::dvec3 origin{0}, direction{0};
    double distance = 0;  // to what it ends on; infinity: the background
    std::vector<FacePassed> passed;
    uint32_t seen_light = 0;              // with BranchEnd::light
    PixelSurface surface;                 // with BranchEnd::surface
    FixedColor adds{}, adds_below{};      // by itself; by all branches below it
    FixedColor ledger{}, ledger_below{};  // of a branch that is pruned or cut; of those below
    std::vector<uint32_t> children;       // the mirrored one first
};

struct SampleTree {
    int row = 0, column = 0;
    std::vector<PixelBranch> branches;  // the primary ray first, children after their parents
    PixelRecord record;
    PixelRays rays;
};

struct PixelTree {
    std::vector<SampleTree> samples;
    Film film;  // of this pixel alone, by the renderer; its sums are those of the trees
};

}  // namespace cistula
