// Which GPUs a request chooses, and what a build without them says.
#include "sequence/backends.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "apps/common/command_line.h"
#include "testing/support/expect_error.h"

namespace cistula {
namespace {

std::vector<int> picked(const DeviceChoice& choice, const std::vector<CudaDevice>& present) {
    std::vector<int> indices;
    for (const CudaDevice& device : pick_devices(choice, present)) indices.push_back(device.index);
    return indices;
}

TEST(Backends, DevicesAreThoseThatWereChosenAndCanBeUsed) {
    const std::vector<CudaDevice> present = {{0, "Old", 6, 1, size_t{1} << 30, 8, "capability 6.1 is below 7.5"},
                                             {1, "New", 9, 0, size_t{3} << 29, 132, ""},
                                             {2, "New", 9, 0, size_t{3} << 29, 132, ""}};
    EXPECT_EQ(picked({true, {}}, present), (std::vector<int>{1, 2}));
    EXPECT_EQ(picked({false, {2, 1}}, present), (std::vector<int>{2, 1}));
    EXPECT_ERROR(picked({false, {1, 3}}, present), ExitCode::device,
                 "--device 3: there is no such GPU; this machine has 0, 1, 2");
    EXPECT_ERROR(picked({}, present), ExitCode::device, "--device 0: Old cannot be used: capability 6.1 is below 7.5");
    EXPECT_ERROR(picked({true, {}}, {present[0]}), ExitCode::device,
                 "--device all: no GPU can be used; 0: Old: capability 6.1 is below 7.5");
    EXPECT_ERROR(picked({true, {}}, {}), ExitCode::device, "--device all: this machine has no GPU");
    EXPECT_ERROR(picked({}, {}), ExitCode::device, "--device 0: there is no such GPU; this machine has none");
    EXPECT_EQ(list_devices_text(present),
              "0: Old, capability 6.1, 1.0 GiB, 8 multiprocessors; cannot be used: capability 6.1 is below 7.5\n"
              "1: New, capability 9.0, 1.5 GiB, 132 multiprocessors\n"
              "2: New, capability 9.0, 1.5 GiB, 132 multiprocessors\n");
    EXPECT_EQ(list_devices_text({}), "no GPU\n");
}

TEST(Backends, EmbreeUsesNoDevice) {
    const ChosenDevices none = choose_devices(Backend::embree, {true, {}});
    EXPECT_TRUE(none.options.devices.empty() && none.names.empty() && none.driver.empty());
}

TEST(Backends, WithoutCudaThereIsNothingInstead) {
    if (has_cuda_backend()) GTEST_SKIP() << "this build has the CUDA backend";
    const std::string message = "--backend cuda: this build has no CUDA backend; --backend embree renders on the CPU";
    EXPECT_ERROR(choose_devices(Backend::cuda, {}), ExitCode::device, message);
    EXPECT_ERROR(make_renderer<float>(Backend::cuda, nullptr, {}), ExitCode::device, message);
    EXPECT_ERROR(make_renderer<double>(Backend::cuda, nullptr, {}), ExitCode::device, message);
    EXPECT_EQ(list_devices_text(), "no GPU: this build has no CUDA backend\n");
}

TEST(Backends, WithOneKernelThereIsNothingInstead) {
    if (!has_cuda_backend() || CISTULA_EVERY_KERNEL) GTEST_SKIP() << "this build has every kernel, or none";
    const std::string message =
        "this build has one kernel of many, to see that it compiles, and uses no GPU; make with CUDA=yes, or CMake "
        "with "
        "-DCISTULA_EVERY_KERNEL=ON, builds all; --backend embree renders on the CPU";
    EXPECT_ERROR(choose_devices(Backend::cuda, {}), ExitCode::device, message);
    EXPECT_ERROR(make_renderer<float>(Backend::cuda, compile_scene<float>(SceneDescription()), {}), ExitCode::device,
                 message);
    EXPECT_EQ(with_options(list_devices_text()), message + "\n");
}

}  // namespace
}  // namespace cistula
