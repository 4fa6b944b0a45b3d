// Compiling a scene can be stopped, wherever it is.
#include <chrono>
#include <thread>

#include <gtest/gtest.h>

#include "scene/compile/compiled_scene.h"
#include "scene/compile/scene_source.h"
#include "testing/support/scene_samples.h"

namespace cistula {
namespace {

SceneDescription large_scene() {
    SceneDescription scene = samples::empty_scene();
    samples::add_object(scene, bumpy_sphere(330'000));
    return scene;
}

TEST(CompileStop, BeforeItBegins) {
    const SceneDescription scene = large_scene();
    std::atomic<bool> stop{false};
    SceneSource source = gather_scene(scene, stop);
    stop = true;
    samples::expect_error([&] { compile_scene<float>(std::move(source)); }, ExitCode::interrupted, "interrupted");
    samples::expect_error([&] { gather_scene(scene, stop); }, ExitCode::interrupted, "interrupted");
    MeshObject mesh;
    mesh.file = "missing.ply";
    SceneDescription of_file = samples::empty_scene();
    samples::add_object(of_file, mesh);
    samples::expect_error([&] { load_assets(of_file, stop); }, ExitCode::interrupted, "interrupted");
}

TEST(CompileStop, InTheMiddle) {
    const SceneDescription scene = large_scene();
    const auto start = std::chrono::steady_clock::now();
    compile_scene<double>(scene);
    const auto whole = std::chrono::steady_clock::now() - start;
    for (const int part : {200, 16, 8, 4}) {
        std::atomic<bool> stop{false};
        std::thread other([&] {
            std::this_thread::sleep_for(whole / part);
            stop = true;
        });
        samples::expect_error([&] { compile_scene<double>(scene, stop); }, ExitCode::interrupted, "interrupted");
        other.join();
    }
    EXPECT_NO_THROW(compile_scene<double>(scene)) << "the builder of trees is whole again";
}

}  // namespace
}  // namespace cistula
