// Transfer of a part to the device and of its results back.
#include "apps/render_verify/device_run.h"

#include <algorithm>

#include "backend_cuda/host/cuda_resources.h"
#include "scene/compile/compiled_scene.h"
#include "scene/compile/scene_arena.h"

namespace cistula::verify {
namespace {

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

}  // namespace cistula::verify
