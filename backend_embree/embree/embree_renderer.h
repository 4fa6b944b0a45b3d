// The CPU backend: Embree finds the candidates, libcore decides the hits, TBB spreads the tiles.
#pragma once

#include <memory>
#include <string>

#include "scene/compile/compiled_scene.h"
#include "scene/film/renderer.h"

namespace cistula {

struct EmbreeOptions {
    std::string device_config;  // for rtcNewDevice, e.g. "isa=avx2"; never changes the image
    int tree_quality = 1;       // 0 quick, 1 high; never changes the image
    bool always_tree = false;   // a tree even where a plain loop over up to 16 primitives would do; for tests
};

/// Threads: those of the TBB arena or global_control that the caller set up. Throws Error (device) where Embree fails.
template <class Real>
std::unique_ptr<Renderer> make_embree_renderer(std::shared_ptr<const CompiledScene<Real>> scene,
                                               const EmbreeOptions& options = {});

/// A renderer over a ConstantScene, as kernels run it: masks reach the primitives' tests. Null where the scene fits
/// into none.
template <class Real>
std::unique_ptr<Renderer> make_constant_renderer(std::shared_ptr<const CompiledScene<Real>> scene);

/// A renderer over Embree's own triangles, solids of planes too: another image, approximate at edges and where bodies
/// touch, its hits in float whatever Real is. For previews and comparisons (native_intersector.h).
template <class Real>
std::unique_ptr<Renderer> make_native_renderer(std::shared_ptr<const CompiledScene<Real>> scene,
                                               const EmbreeOptions& options = {});

/// libcore's own intersectors: the oracle (brute) and the path that the GPU runs (bvh; the scene must have its tree,
/// see build_primitive_tree).
enum class HostIntersector { brute, bvh };
template <class Real>
std::unique_ptr<Renderer> make_host_renderer(std::shared_ptr<const CompiledScene<Real>> scene,
                                             HostIntersector intersector);

}  // namespace cistula
