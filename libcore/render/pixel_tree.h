// A pixel's ray trees in detail: the rays, what they hit, what each added to the pixel's sums. In scene units in either
// precision; sums are the pixel's integers.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "cistula/geometry/hit.h"
#include "render/record/film.h"

namespace cistula {

using FixedColor = std::array<int64_t, 3>;

enum class BranchKind { primary, mirrored, transmitted };

/// How a branch ends. `dropped`: the stack of branches was full, or the ray was inside more solids than it can list;
/// the pixel is flagged.
enum class BranchEnd { surface, light, background, pruned, cut, dropped };

struct FaceMet {
    uint32_t solid = 0;
    uint32_t face = 0;      // face of a convex solid, or number of the triangle in its object
    bool triangle = false;  // `face` is a triangle
    bool round = false;     // the solid is a sphere, a disk or a plane, which has no faces
    CrossingKind crossing = CrossingKind::enter;
    double distance = 0;  // from the start of the branch
};

/// A face crossed without shading: its material is clear, or it lies inside a medium of higher priority.
struct FacePassed : FaceMet {
    bool inside = false;  // inside a medium of higher priority
};

enum class LightFate {
    adds,
    behind,   // the face looks away from the light, or the light lies in its plane
    nothing,  // the light is black there
    shadow,   // no channel arrives
};

struct LightContribution {
    uint32_t light = 0;
    LightFate fate = LightFate::adds;
    double cosine = 0;  // N.L
    double distance = 0;
    glm::dvec3 unshadowed{0};       // contribution to the local term if nothing blocked it
    glm::dvec3 arrives{1};          // transmittance, per channel
    std::vector<uint32_t> through;  // solids on the way that attenuate the light, in their order; at most 8
    FixedColor adds{};
};

struct PixelSurface : FaceMet {
    uint32_t material = 0;
    double t = 0;               // along the ray's line, which starts at its last refraction or reflection
    std::vector<FaceMet> also;  // other crossings that rounding cannot tell from this one
    glm::dvec3 point{0}, normal{0}, color{0};  // normal: toward the viewer; color: texture included
    std::optional<glm::dvec3> face_normal;     // of a smooth mesh, whose normal is another
    std::vector<uint32_t> before, beyond;      // solids around the point on either side, highest priority first
    double index_before = 1, index_beyond = 1;
    double cosine = 1;  // of the angle between ray and normal
    bool bends = false;
    bool total = false;
    double bent_cosine = 1;          // the cosine on the other side, where the ray is refracted
    double fresnel = -1;             // reflectance; -1: not evaluated
    double local = 0, mirrored = 0;  // shares
    glm::dvec3 through{0};
    glm::dvec3 ambient{0};  // ambient part of the local term
    FixedColor ambient_adds{};
    std::vector<LightContribution> lights;  // one for each light of the scene, where local is above 0
};

struct PixelBranch {
    BranchKind kind = BranchKind::primary;
    BranchEnd end = BranchEnd::background;
    int depth = 0;  // number of surfaces above it
    glm::dvec3 weight{1};
    glm::dvec3 arriving{1};  // the branch's weight after absorption on the way
    glm::dvec3 origin{0}, direction{0};
    double distance = 0;  // to its end; infinity: the background
    std::vector<FacePassed> passed;
    uint32_t visible_light = 0;           // with BranchEnd::light
    PixelSurface surface;                 // with BranchEnd::surface
    FixedColor adds{}, adds_below{};      // by the branch itself; by all branches below it
    FixedColor ledger{}, ledger_below{};  // error of the branch if pruned or cut; of those below
    std::vector<uint32_t> children;       // the reflected one first
};

struct SampleTree {
    int row = 0;
    int column = 0;
    std::vector<PixelBranch> branches;  // the primary ray first, children after their parents
    PixelRecord record;
    PixelRays rays;
};

/// What bounds the work on a pixel's trees.
struct PixelTreeLimits {
    size_t branches = size_t{1} << 18;  // of all samples; some 1 KB each
    StopSignal stop = {};
};

struct PixelTree {
    std::vector<SampleTree> samples;
    Film film;                       // the pixel as the renderer gives it; its sums are those of the trees
    std::vector<std::string> crowd;  // the solids that a ray was inside, where they were more than it can list
};

}  // namespace cistula
