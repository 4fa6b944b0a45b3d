// The most memory that compiling a large mesh takes, its description and all temporary arrays included.
#include <sys/resource.h>

#include <gtest/gtest.h>

#include "scene/compile/compiled_scene.h"
#include "testing/support/run_program.h"
#include "testing/support/scene_samples.h"

namespace cistula {
namespace {

double peak_bytes() {
    rusage usage;
    getrusage(RUSAGE_SELF, &usage);
    return 1024.0 * static_cast<double>(usage.ru_maxrss);
}

/// The peak only grows: float comes first, and double needs more.
TEST(CompileMemory, StaysUnderTheBytesPerTriangleThatAreAllowed) {
    if (needs_all_memory) GTEST_SKIP() << "the sanitizer's own memory would be counted";
    const double before = peak_bytes();
    SceneDescription scene = samples::empty_scene();
    samples::add_object(scene, bumpy_sphere(600000));
    const auto count = static_cast<double>(std::get<TrianglesObject>(scene.objects[0].shape).triangles.size());
    {
        const auto compiled = compile_scene<float>(scene);
        EXPECT_EQ(compiled->solids[0].kind, SolidKind::mesh);
        EXPECT_LT((peak_bytes() - before) / count, 160);
        EXPECT_LT(static_cast<double>(compiled->memory()) / count, 70);
    }
    const auto compiled = compile_scene<double>(scene);
    EXPECT_LT((peak_bytes() - before) / count, 240);
    EXPECT_LT(static_cast<double>(compiled->memory()) / count, 130);
}

}  // namespace
}  // namespace cistula
