// The course work's kernel: a thread a pixel, striding over the picture where the grid is smaller. Compiled with nvcc's
// defaults, as such a program is: contraction to fused multiply-adds stays on, which Cistula's own kernels do without.
#include <cuda_runtime.h>

#include "base/error.h"
#include "bench/seed_baseline_run.h"

namespace cistula::seed {
namespace {

constexpr int block_side = 16;

void check(cudaError_t result, const char* call) {
    if (result == cudaSuccess) return;
    std::string message = std::string(call) + ": " + cudaGetErrorString(result);
    if (result == cudaErrorNoDevice || result == cudaErrorInsufficientDriver)
        message += "; runs on the GPU need an NVIDIA GPU with a driver that is new enough, --cpu needs neither";
    throw Error(ErrorKind::device, message);
}
#define SEED_CHECK(call) check(call, #call)

template <int depth>
__global__ void render(Scene scene, View view, Pixel* pixels) {
    const int step_x = static_cast<int>(gridDim.x * blockDim.x);
    const int step_y = static_cast<int>(gridDim.y * blockDim.y);
    for (int y = static_cast<int>(blockIdx.y * blockDim.y + threadIdx.y); y < view.height; y += step_y)
        for (int x = static_cast<int>(blockIdx.x * blockDim.x + threadIdx.x); x < view.width; x += step_x)
            pixels[static_cast<size_t>(y) * view.width + x] = pixel<depth>(scene, view, x, y);
}

using Kernel = void (*)(Scene, View, Pixel*);

Kernel kernel_of(int depth) {
    switch (depth) {
        case 1:
            return render<1>;
        case 2:
            return render<2>;
        case 4:
            return render<4>;
        case 8:
            return render<8>;
    }
    throw Error(ErrorKind::usage, "no kernel was compiled for depth " + std::to_string(depth));
}

template <class T>
class Buffer {
  public:
    explicit Buffer(size_t size) { SEED_CHECK(cudaMalloc(&data_, (size > 0 ? size : 1) * sizeof(T))); }
    explicit Buffer(const std::vector<T>& values) : Buffer(values.size()) {
        SEED_CHECK(cudaMemcpy(data_, values.data(), values.size() * sizeof(T), cudaMemcpyHostToDevice));
    }
    ~Buffer() { cudaFree(data_); }
    Buffer(const Buffer&) = delete;
    Buffer& operator=(const Buffer&) = delete;
    T* data() const { return data_; }

  private:
    T* data_ = nullptr;
};

class Event {
  public:
    Event() { SEED_CHECK(cudaEventCreate(&event_)); }
    ~Event() { cudaEventDestroy(event_); }
    Event(const Event&) = delete;
    Event& operator=(const Event&) = delete;
    void record() { SEED_CHECK(cudaEventRecord(event_)); }
    double milliseconds_since(const Event& start) const {
        SEED_CHECK(cudaEventSynchronize(event_));
        float time = 0;
        SEED_CHECK(cudaEventElapsedTime(&time, start.event_, event_));
        return time;
    }

  private:
    cudaEvent_t event_ = nullptr;
};

std::string version_text(int version) {
    return std::to_string(version / 1000) + "." + std::to_string(version % 1000 / 10);
}

}  // namespace

DeviceDescription describe_device() {
    int count = 0;
    SEED_CHECK(cudaGetDeviceCount(&count));
    SEED_CHECK(cudaSetDevice(0));
    cudaDeviceProp properties;
    SEED_CHECK(cudaGetDeviceProperties(&properties, 0));
    int driver = 0;
    int runtime = 0;
    SEED_CHECK(cudaDriverGetVersion(&driver));
    SEED_CHECK(cudaRuntimeGetVersion(&runtime));
    const std::string compiler = "nvcc " + std::to_string(__CUDACC_VER_MAJOR__) + "." +
                                 std::to_string(__CUDACC_VER_MINOR__) + "." + std::to_string(__CUDACC_VER_BUILD__);
    return {properties.name, properties.major, properties.minor, version_text(driver), version_text(runtime), compiler};
}

DeviceRun render_on_device(int depth, int grid, int warm_ups, int repetitions, const OwnedScene& owned,
                           const View& view) {
    const Buffer<Triangle> triangles(owned.triangles);
    const Buffer<Uv> uvs(owned.uvs);
    const Buffer<Material> materials(owned.materials);
    const Buffer<Light> lights(owned.lights);
    const Buffer<Vec> texels(owned.texels);
    const size_t size = static_cast<size_t>(view.width) * static_cast<size_t>(view.height);
    const Buffer<Pixel> pixels(size);
    Scene scene = owned.view();
    scene.triangles = triangles.data();
    scene.uvs = uvs.data();
    scene.materials = materials.data();
    scene.lights = lights.data();
    scene.texels = texels.data();

    const Kernel kernel = kernel_of(depth);
    DeviceRun run;
    const dim3 blocks(static_cast<unsigned>(grid), static_cast<unsigned>(grid)), threads(block_side, block_side);
    Event start, end;
    for (int i = 0; i < warm_ups + repetitions; ++i) {
        start.record();
        kernel<<<blocks, threads>>>(scene, view, pixels.data());
        check(cudaGetLastError(), "launch of the kernel");
        end.record();
        const double time = end.milliseconds_since(start);
        if (i >= warm_ups) run.time.runs.push_back(time);
    }
    run.pixels.resize(size);
    SEED_CHECK(cudaMemcpy(run.pixels.data(), pixels.data(), size * sizeof(Pixel), cudaMemcpyDeviceToHost));
    return run;
}

}  // namespace cistula::seed
