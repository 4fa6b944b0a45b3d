// The kernels that answer questions about rays, a thread each.
#include "backend_cuda/host/cuda_check.h"
#include "backend_cuda/kernels/frame_job.h"
#include "cistula/traversal/bvh.h"

namespace cistula {
namespace {

constexpr unsigned int threads = 128;  // of a block

template <class Real, class Answer>
__global__ void __launch_bounds__(threads)
    answer_queries(const __grid_constant__ SceneView<Real> scene, const RayQuestion* questions, unsigned int count,
                   Answer* answers) {
    const unsigned int i = blockIdx.x * threads + threadIdx.x;
    if (i >= count) return;
    const BvhIntersector<Real> intersector{scene};
    if constexpr (std::is_same_v<Answer, RayAnswer>)
        answers[i] = answer_ray<Real>(intersector, questions[i]);
    else
        answers[i] = answer_segment<Real>(intersector, questions[i]);
}

template <class Real, class Answer>
void launch(const SceneView<Real>& scene, const RayQuestion* questions, unsigned int count, Answer* answers,
            cudaStream_t stream) {
    answer_queries<<<(count + threads - 1) / threads, threads, 0, stream>>>(scene, questions, count, answers);
    CISTULA_CUDA_CHECK(cudaGetLastError());
}

}  // namespace

template <class Real>
void launch_queries(const SceneView<Real>& scene, const RayQuestion* questions, unsigned int count, RayAnswer* answers,
                    cudaStream_t stream) {
    launch(scene, questions, count, answers, stream);
}
template <class Real>
void launch_queries(const SceneView<Real>& scene, const RayQuestion* questions, unsigned int count,
                    Vec3<double>* shares, cudaStream_t stream) {
    launch(scene, questions, count, shares, stream);
}

template void launch_queries(const SceneView<float>&, const RayQuestion*, unsigned int, RayAnswer*, cudaStream_t);
template void launch_queries(const SceneView<double>&, const RayQuestion*, unsigned int, RayAnswer*, cudaStream_t);
template void launch_queries(const SceneView<float>&, const RayQuestion*, unsigned int, Vec3<double>*, cudaStream_t);
template void launch_queries(const SceneView<double>&, const RayQuestion*, unsigned int, Vec3<double>*, cudaStream_t);

}  // namespace cistula
