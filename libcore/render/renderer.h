// The interface that backends offer to programs.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "render/finished_tiles.h"
#include "render/pixel_tree.h"
#include "render/record/film.h"
#include "scene/description/camera_path.h"
#include "scene/description/description.h"

namespace cistula {

struct FrameSettings {
    int full_width = 640;
    int full_height = 480;
    PixelRect crop;       // the pixels to render; the whole frame: {0, 0, full_width, full_height}
    int supersample = 1;  // k: a k x k grid of samples per pixel
    int depth = 4;        // 1 to 1,024
    double cutoff = 0;    // error budget per pixel in the scene's radiance units
    double target_error =
        0;  // above 0: adaptive sampling on the 16 x 16 lattice; a quarter of it is the budget for the cutoff
    int max_samples = 256;  // per pixel, with a target error: 5 to 256
    KeptParts parts;        // of the film's pixels; with a target error all are kept
    LayerRequest layers;    // by the renderers of the backends, and "bvh"
    uint32_t effects = 0;   // mask to run; 0: the smallest that contains what the scene requires
    int tile = 16;          // side of a tile in pixels; never changes the image
    int lanes = 0;          // rays traced at once on the host, at most; 0: as many as can be. Never changes the image

    bool operator==(const FrameSettings&) const = default;

    /// Sets a frame of this size, without a crop.
    void set_size(int width, int height) {
        full_width = width;
        full_height = height;
        crop = {0, 0, width, height};
    }

    bool adaptive() const { return target_error > 0; }
    /// Samples along a pixel's side, or the side of the lattice of adaptive sampling.
    int grid() const { return adaptive() ? 16 : supersample; }
    double truncation() const { return adaptive() ? target_error / 4 : cutoff; }
    KeptParts kept_parts() const { return adaptive() ? KeptParts() : parts; }
};

/// A scene's own settings: the size and the samples of its film, its depth and its cutoff, without a crop.
FrameSettings frame_settings(const SceneDescription& scene);

/// State shared between the rendering threads and an observer; all members may be read at any time.
struct RenderProgress {
    std::atomic<uint64_t> pixels_done{0};
    std::atomic<uint64_t> rays{0};
    /// Set it to make the render return soon. On its own cache line, since every ray tree reads it.
    alignas(64) std::atomic<bool> stop{false};
    FinishedTiles tiles;  // by renderers on the host; others fill a film when it is done
};

/// Times of the last frame in seconds, of the slowest device that took part.
struct RenderTimes {
    double kernel = 0;    // devices computing pixels
    double transfer = 0;  // from the end of that until the film is complete
};

/// The first crossings of rays, entry i that of ray i, in scene coordinates. Those of rays that meet nothing: infinity,
/// -1, zeros.
struct RayHits {
    std::vector<double> distance;           // from the ray's origin
    std::vector<int32_t> object, material;  // by the numbers of `names`
    std::vector<int32_t> face;              // face of a convex solid, or number of the triangle in its object
    std::vector<CrossingKind> crossing;     // enter: the ray comes from outside; leave: from inside
    std::vector<glm::dvec3> point, normal;  // geometric, unit, toward the origin
    std::vector<glm::dvec2> uv;             // texture coordinates, where the material has a texture
    std::shared_ptr<const LayerNames> names;
};

/// Renders frames of one scene in one precision, and answers questions about it. Not thread-safe: one call at a time.
class Renderer {
  public:
    virtual ~Renderer() = default;

    /// Fills `film`. Returns false if it was stopped; the film is then incomplete. Throws Error.
    virtual bool render(const CameraFrame& camera, const FrameSettings& settings, Film& film,
                        RenderProgress& progress) = 0;

    /// What rays meet first, in any order of the rays the same bits. Visible lights are not met. Directions have any
    /// length. Where a ray starts on a face, rounding decides whether it meets that. Throws Error (usage) with the
    /// number of the first ray that is none: not finite, or without a direction.
    virtual RayHits intersect(std::span<const glm::dvec3> origins, std::span<const glm::dvec3> directions);

    /// The share of light, per channel, that passes from one point to another as a shadow ray's does: straight, through
    /// what is transparent. A light on faces, as the end of a segment, is not shaded by them. Throws as intersect()
    /// does.
    virtual std::vector<glm::dvec3> transmittance(std::span<const glm::dvec3> from, std::span<const glm::dvec3> to);

    /// The ray trees of pixel (x, y) of the frame; settings.crop is ignored. Throws std::logic_error if the trees do
    /// not give the renderer's result for that pixel bit for bit, and Error as a render does; `failed` where there are
    /// more branches than the limits allow.
    virtual PixelTree pixel_tree(const CameraFrame& camera, const FrameSettings& settings, int x, int y,
                                 const PixelTreeLimits& limits = {});

    /// Announces a frame that is to be rendered after the next one and those announced before it, so that a device can
    /// start it early. A wrong announcement costs time and nothing else.
    virtual void expect(const CameraFrame&, const FrameSettings&) {}

    /// How many frames after the next one are worth announcing.
    virtual size_t frames_ahead() const { return 1; }

    /// The mask of effects that the last render used.
    virtual uint32_t effects() const = 0;

    /// The maximum number of rays that the last render traced at once.
    virtual int lanes() const { return 1; }

    /// What found the last render's hits: "lanes", "embree", "bvh", "brute" or "cuda".
    virtual std::string intersector() const = 0;

    /// Times of the last frame for backends with devices of their own; zeros for others.
    virtual RenderTimes times() const { return {}; }

    /// Remarks on the last frame for the user, one line each, such as that it was split for lack of memory.
    virtual std::vector<std::string> notes() const { return {}; }

    /// Memory of geometry, trees and shading data in bytes.
    virtual size_t memory() const = 0;
};

/// Renders a frame; again with larger tables of objects where a pixel shows more than they hold, which the settings
/// then keep for the next frame. False if it was stopped; the film is then incomplete.
bool render_frame(Renderer& renderer, const CameraFrame& camera, FrameSettings& settings, Film& film,
                  RenderProgress& progress);

/// The reason why a film with these flags (RenderFlag bits) is unreliable, for a message; empty for 0. `crowd`: of a
/// PixelTree.
std::string describe_flags(uint32_t flags, const std::vector<std::string>& crowd = {});

}  // namespace cistula
