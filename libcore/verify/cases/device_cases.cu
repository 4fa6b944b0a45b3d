// Functors of rays on devices: kernels, transfer of a part to the device and of its results back.
#include <algorithm>

#include "backend_cuda/host/cuda_resources.h"
#include "scene/compile/compiled_scene.h"
#include "scene/compile/scene_arena.h"
#include "verify/cases/balls/paths.h"
#include "verify/cases/geometry/edges.h"
#include "verify/cases/geometry/special_rays.h"
#include "verify/cases/metamorphic/rays.h"
#include "verify/cases/mirrors/paths.h"
#include "verify/cases/refraction/lines.h"
#include "verify/cases/shadows/local_light.h"
#include "verify/cases/smooth/sides.h"
#include "verify/device_run.h"

namespace cistula::verify {
namespace {

/// Number of threads for the rays of a case, each with its own tally; each takes every 2^16th ray.
constexpr unsigned device_threads = 1u << 16, device_block = 128;

/// The traversal of devices, in functions that kernels call: compiled into each, it would take most of ptxas's time.
template <class Real>
struct CalledTraversal {
    using Media = InteriorList;
    using Scene = SceneView<Real>;
    const SceneView<Real>& scene;

    CISTULA_HD __noinline__ Hit<Real> closest(const Ray<Real>& ray) const {
        return BvhIntersector<Real>{scene}.closest(ray);
    }
    template <class E>
    CISTULA_HD __noinline__ Throughput<Real, E> transmittance(const ShadowRay<Real>& shadow) const {
        return BvhIntersector<Real>{scene}.template transmittance<E>(shadow);
    }
};

template <class Functor, class Real>
__global__ void __launch_bounds__(device_block)
    tally_rays(const __grid_constant__ Setup<Real> setup, const Functor functor, uint64_t place, uint64_t count,
               Tally* out) {
    const uint64_t thread = uint64_t(blockIdx.x) * blockDim.x + threadIdx.x;
    Tally tally;
    for (uint64_t i = thread; i < count; i += device_threads) {
        tally.place = place + i;
        call(functor, setup, CalledTraversal<Real>{setup.scene}, i, tally);
    }
    out[thread] = tally;
}

template <class Functor, class Real>
__global__ void __launch_bounds__(device_block)
    word_rays(const __grid_constant__ Setup<Real> setup, const Functor functor, uint64_t first, uint64_t count,
              uint64_t* out) {
    const uint64_t thread = uint64_t(blockIdx.x) * blockDim.x + threadIdx.x;
    for (uint64_t i = thread; i < count; i += device_threads)
        out[i] = functor.fingerprint(setup, CalledTraversal<Real>{setup.scene}, first + i);
}

constexpr uint64_t words_at_once = uint64_t(1) << 22;

/// A part in the device's memory, with the tree that devices traverse.
template <class Real>
class DeviceSetup {
  public:
    explicit DeviceSetup(const Setup<Real>& here) : setup_(here) {
        const FacetTree<Real> tree = facet_tree(here.scene);
        SceneView<Real> view = here.scene;
        tree.put_into(view);
        const SceneArena<Real> arena(view);
        upload(scene_, arena.bytes().data(), arena.bytes().size());
        upload(points_, here.points.data, here.points.size * sizeof(Vec3<double>));
        upload(numbers_, here.numbers.data, here.numbers.size * sizeof(double));
        setup_.scene = arena.at(scene_.template as<void>());
        setup_.points.data = points_.template as<Vec3<double>>();
        setup_.numbers.data = numbers_.template as<double>();
    }

    const Setup<Real>& setup() const { return setup_; }

  private:
    static void upload(DeviceMemory& memory, const void* from, size_t size) {
        memory.reserve(std::max<size_t>(size, 1));
        if (size != 0) CISTULA_CUDA_CHECK(cudaMemcpy(memory.as<void>(), from, size, cudaMemcpyHostToDevice));
    }

    Setup<Real> setup_;
    DeviceMemory scene_, points_, numbers_;
};

}  // namespace

template <class Real>
Tally tally_on_device(const DeviceMethods<Real>& methods, const std::byte* functor, const Setup<Real>& here,
                      uint64_t place, uint64_t count) {
    const DeviceSetup<Real> there(here);
    DeviceMemory out;
    out.reserve(device_threads * sizeof(Tally));
    methods.tally(functor, there.setup(), place, count, out.as<Tally>());
    CISTULA_CUDA_CHECK(cudaDeviceSynchronize());
    std::vector<Tally> tallies(device_threads);
    CISTULA_CUDA_CHECK(
        cudaMemcpy(tallies.data(), out.as<void>(), device_threads * sizeof(Tally), cudaMemcpyDeviceToHost));
    Tally all;
    for (const Tally& tally : tallies) all.merge(tally);
    return all;
}

template <class Real>
std::vector<uint64_t> words_on_device(const DeviceMethods<Real>& methods, const std::byte* functor,
                                      const Setup<Real>& here, uint64_t count) {
    const DeviceSetup<Real> there(here);
    DeviceMemory out;
    out.reserve(std::max<uint64_t>(std::min(count, words_at_once), 1) * sizeof(uint64_t));
    std::vector<uint64_t> words(count);
    for (uint64_t first = 0; first < count; first += words_at_once) {
        const uint64_t now = std::min(words_at_once, count - first);
        methods.words(functor, there.setup(), first, now, out.as<uint64_t>());
        CISTULA_CUDA_CHECK(cudaDeviceSynchronize());
        CISTULA_CUDA_CHECK(
            cudaMemcpy(words.data() + first, out.as<void>(), now * sizeof(uint64_t), cudaMemcpyDeviceToHost));
    }
    return words;
}

template Tally tally_on_device(const DeviceMethods<float>&, const std::byte*, const Setup<float>&, uint64_t, uint64_t);
template Tally tally_on_device(const DeviceMethods<double>&, const std::byte*, const Setup<double>&, uint64_t,
                               uint64_t);
template std::vector<uint64_t> words_on_device(const DeviceMethods<float>&, const std::byte*, const Setup<float>&,
                                               uint64_t);
template std::vector<uint64_t> words_on_device(const DeviceMethods<double>&, const std::byte*, const Setup<double>&,
                                               uint64_t);

// ---- all functors

template <class Functor, class Real>
DeviceMethods<Real> device_methods() {
    constexpr unsigned blocks = device_threads / device_block;
    DeviceMethods<Real> methods;
    if constexpr (HasWords<Functor>)
        methods.words = [](const std::byte* functor, const Setup<Real>& setup, uint64_t first, uint64_t count,
                           uint64_t* out) {
            word_rays<Functor, Real><<<blocks, device_block>>>(setup, functor_of<Functor>(functor), first, count, out);
            check_cuda(cudaGetLastError(), "word_rays");
        };
    else
        methods.tally = [](const std::byte* functor, const Setup<Real>& setup, uint64_t place, uint64_t count,
                           Tally* out) {
            tally_rays<Functor, Real><<<blocks, device_block>>>(setup, functor_of<Functor>(functor), place, count, out);
            check_cuda(cudaGetLastError(), "tally_rays");
        };
    return methods;
}

#define CISTULA_ON_DEVICES(Functor)                                 \
    template DeviceMethods<float> device_methods<Functor, float>(); \
    template DeviceMethods<double> device_methods<Functor, double>();
CISTULA_ON_DEVICES(balls::Bounces)
CISTULA_ON_DEVICES(balls::Focus)
CISTULA_ON_DEVICES(balls::Outline)
CISTULA_ON_DEVICES(geometry::AxisParallel)
CISTULA_ON_DEVICES(geometry::Coincident)
CISTULA_ON_DEVICES(geometry::Degenerate)
CISTULA_ON_DEVICES(geometry::EdgesFromInside)
CISTULA_ON_DEVICES(geometry::EdgesFromOutside)
CISTULA_ON_DEVICES(geometry::ExtremeRays)
CISTULA_ON_DEVICES(geometry::FacePlanes)
CISTULA_ON_DEVICES(geometry::Fans)
CISTULA_ON_DEVICES(geometry::FarCameras)
CISTULA_ON_DEVICES(geometry::Flawed<geometry::Flaw::contracted_products>)
CISTULA_ON_DEVICES(geometry::Flawed<geometry::Flaw::inclusive_edges>)
CISTULA_ON_DEVICES(geometry::Flawed<geometry::Flaw::unpadded_boxes>)
CISTULA_ON_DEVICES(geometry::NotFiniteRays)
CISTULA_ON_DEVICES(geometry::OnSlabPlanes)
CISTULA_ON_DEVICES(geometry::OriginsOnPlanes)
CISTULA_ON_DEVICES(geometry::OriginsOnTriangles)
CISTULA_ON_DEVICES(geometry::RandomRays)
CISTULA_ON_DEVICES(geometry::SignedZeros)
CISTULA_ON_DEVICES(geometry::Slivers)
CISTULA_ON_DEVICES(geometry::Subnormals)
CISTULA_ON_DEVICES(metamorphic::CellBorders)
CISTULA_ON_DEVICES(metamorphic::FarFloor)
CISTULA_ON_DEVICES(metamorphic::Flips)
CISTULA_ON_DEVICES(metamorphic::Highlights)
CISTULA_ON_DEVICES(metamorphic::IntegerPowers)
CISTULA_ON_DEVICES(metamorphic::RealPowers)
CISTULA_ON_DEVICES(metamorphic::RepeatedTexels)
CISTULA_ON_DEVICES(mirrors::BouncesByEpsilon)
CISTULA_ON_DEVICES(mirrors::BouncesInside)
CISTULA_ON_DEVICES(mirrors::FirstLines)
CISTULA_ON_DEVICES(mirrors::FoldedPath)
CISTULA_ON_DEVICES(mirrors::Lengths)
CISTULA_ON_DEVICES(refraction::AnyAngle)
CISTULA_ON_DEVICES(refraction::BrewsterAngle)
CISTULA_ON_DEVICES(refraction::BrewsterShare)
CISTULA_ON_DEVICES(refraction::CameraInside)
CISTULA_ON_DEVICES(refraction::CriticalAngle)
CISTULA_ON_DEVICES(refraction::CriticalAngleTraced)
CISTULA_ON_DEVICES(refraction::FresnelEqual)
CISTULA_ON_DEVICES(refraction::FresnelGrazing)
CISTULA_ON_DEVICES(refraction::FresnelNormal)
CISTULA_ON_DEVICES(refraction::Grazing)
CISTULA_ON_DEVICES(refraction::MediaSequence)
CISTULA_ON_DEVICES(refraction::Octants)
CISTULA_ON_DEVICES(refraction::PrismDeviation)
CISTULA_ON_DEVICES(refraction::Reversibility)
CISTULA_ON_DEVICES(refraction::SlabDisplacement)
CISTULA_ON_DEVICES(refraction::SlabParallel)
CISTULA_ON_DEVICES(shadows::Falloff)
CISTULA_ON_DEVICES(shadows::FromOutside)
CISTULA_ON_DEVICES(shadows::HalfSpaces)
CISTULA_ON_DEVICES(shadows::LightAtThePoint)
CISTULA_ON_DEVICES(shadows::LightsOnStar)
CISTULA_ON_DEVICES(shadows::LitInFull)
CISTULA_ON_DEVICES(shadows::OwnLight)
CISTULA_ON_DEVICES(shadows::ThroughSheets)
CISTULA_ON_DEVICES(shadows::ThroughSolids)
CISTULA_ON_DEVICES(shadows::VisibleLightTree)
CISTULA_ON_DEVICES(smooth::Sides)

}  // namespace cistula::verify
