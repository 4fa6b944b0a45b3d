// The CPU backend: Embree finds candidates, libcore decides the hits, and TBB distributes the tiles.
#pragma once

#include <memory>
#include <string>

#include "render/renderer.h"
#include "render/scene.h"

namespace cistula {

struct EmbreeOptions {
    std::string device_config;  // for rtcNewDevice, e.g. "isa=avx2"; never changes the image
    int tree_quality = 1;       // 0 quick, 1 high; never changes the image
    bool always_tree = false;   // trace one ray after the other, through Embree's tree; for tests
};

/// The CPU renderer, and what it tells of rays and pixels. It uses the threads of the TBB arena or global_control that
/// the caller set up. Throws Error (device) if Embree fails.
template <class Real>
std::unique_ptr<Renderer> make_embree_renderer(std::shared_ptr<const CompiledScene<Real>> scene,
                                               const EmbreeOptions& options = {});

std::unique_ptr<Renderer> make_embree_renderer(const Scene& scene, const EmbreeOptions& options = {});

}  // namespace cistula
