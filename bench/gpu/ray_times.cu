// The ray benchmark's kernels: those that are timed read a ray, trace it and write what it found.
#include "backend_cuda/host/cuda_check.h"
#include "backend_cuda/kernels/kernel_parts.cuh"
#include "bench/gpu/ray_kernels.h"

namespace cistula::bench {
namespace {

__device__ inline uint32_t ray_index() {
    return blockIdx.x * unsigned(block_rays) + threadIdx.x;
}

template <class Real>
__global__ void __launch_bounds__(block_rays) make_primary_rays(const __grid_constant__ RayJob<Real> job) {
    job.arrays.primary[ray_index()] = primary_ray_of<Real>(job.scene, job.frame, ray_index());
}

template <class Real>
__global__ void __launch_bounds__(block_rays) make_further_rays(const __grid_constant__ RayJob<Real> job) {
    const uint32_t i = ray_index();
    further_rays_of(job.scene, job.arrays.primary[i], job.arrays.primary_hits[i], i, job.arrays.bounced[i],
                    job.arrays.shadow[i]);
}

template <class Real>
__global__ void __launch_bounds__(block_rays)
    find_hits(const __grid_constant__ SceneView<Real> scene, const StoredRay<Real>* rays, StoredHit<Real>* hits) {
    hits[ray_index()] = closest_hit_of(scene, rays[ray_index()]);
}

// With the registers of the frame's kernels: left to itself, ptxas takes fewer and spills.
template <class Real>
__global__ void __launch_bounds__(block_rays, least_blocks<Real>(adaptive_shape, DevicePath::tree))
    find_light(const __grid_constant__ SceneView<Real> scene, const StoredRay<Real>* rays, uint8_t* light) {
    light[ray_index()] = light_of(scene, rays[ray_index()]);
}

template <class Real>
const void* kernel_of(RayStep step) {
    switch (step) {
        case RayStep::primary_rays:
            return reinterpret_cast<const void*>(&make_primary_rays<Real>);
        case RayStep::further_rays:
            return reinterpret_cast<const void*>(&make_further_rays<Real>);
        case RayStep::light:
            return reinterpret_cast<const void*>(&find_light<Real>);
        default:
            return reinterpret_cast<const void*>(&find_hits<Real>);
    }
}

}  // namespace

template <class Real>
void launch_rays(RayStep step, const RayJob<Real>& job, cudaStream_t stream) {
    static_assert(ray_count % block_rays == 0);
    constexpr unsigned grid = ray_count / block_rays, block = block_rays;
    const RayArrays<Real>& a = job.arrays;
    switch (step) {
        case RayStep::primary_rays:
            make_primary_rays<<<grid, block, 0, stream>>>(job);
            break;
        case RayStep::primary_hits:
            find_hits<<<grid, block, 0, stream>>>(job.scene, a.primary, a.primary_hits);
            break;
        case RayStep::further_rays:
            make_further_rays<<<grid, block, 0, stream>>>(job);
            break;
        case RayStep::bounced_hits:
            find_hits<<<grid, block, 0, stream>>>(job.scene, a.bounced, a.bounced_hits);
            break;
        case RayStep::light:
            find_light<<<grid, block, 0, stream>>>(job.scene, a.shadow, a.light);
            break;
    }
    check_cuda(cudaGetLastError(), "launch of the ray benchmark");
}

template <class Real>
KernelFacts ray_kernel_facts(RayStep step) {
    const void* kernel = kernel_of<Real>(step);
    cudaFuncAttributes attributes;
    CISTULA_CUDA_CHECK(cudaFuncGetAttributes(&attributes, kernel));
    KernelFacts facts;
    facts.registers = attributes.numRegs;
    facts.local_bytes = attributes.localSizeBytes;
    facts.block_rays = block_rays;
    CISTULA_CUDA_CHECK(cudaOccupancyMaxActiveBlocksPerMultiprocessor(&facts.blocks, kernel, block_rays, 0));
    return facts;
}

template void launch_rays(RayStep, const RayJob<float>&, cudaStream_t);
template void launch_rays(RayStep, const RayJob<double>&, cudaStream_t);
template KernelFacts ray_kernel_facts<float>(RayStep);
template KernelFacts ray_kernel_facts<double>(RayStep);

}  // namespace cistula::bench
