// What --explain tells of a scene, and the words for what makes a frame untrustworthy.
#include "apps/render/explain.h"

#include <gtest/gtest.h>

#include "cistula/transport/ray_tree.h"
#include "render/renderer.h"
#include "testing/support/scene.h"

namespace cistula {
namespace {

TEST(Explain, NamesWhatIsNeededWhatRunsAndWhatIsLeftOut) {
    std::vector<EffectReason> reasons;
    for (int i = 0; i < effect_count; ++i)
        reasons.push_back(
            {1u << i, (1u << i) == effect_diffuse, (1u << i) == effect_diffuse ? "material clay" : "no reason"});
    const std::string table = explain_table("s.json", {reasons, {"a and b overlap"}}, Backend::cuda);
    EXPECT_NE(table.find("diffuse              yes     in        material clay\n"), std::string::npos) << table;
    EXPECT_NE(table.find("fresnel              no      left out  no reason\n"), std::string::npos) << table;
    EXPECT_NE(table.find("7 sets of effects for which code is compiled, number 1 runs"), std::string::npos) << table;
    const std::string on_cpu = explain_table("s.json", {reasons, {}}, Backend::embree);
    EXPECT_NE(on_cpu.find("4 sets of effects for which code is compiled, number 1 runs"), std::string::npos) << on_cpu;
    EXPECT_NE(on_cpu.find("transmission         no      in        no reason\n"), std::string::npos) << on_cpu;
    EXPECT_EQ(table.find("cost"), std::string::npos) << table;
    EXPECT_NE(table.find("\na and b overlap\n"), std::string::npos) << table;
    const EffectCosts costs{12.5, 7, {{effect_diffuse, 0.25}}};
    const std::string measured = explain_table("s.json", {reasons, {}}, Backend::cuda, &costs);
    EXPECT_NE(measured.find("diffuse              yes     in        25.0 %   material clay\n"), std::string::npos)
        << measured;
    EXPECT_NE(measured.find("fresnel              no      left out  -        no reason\n"), std::string::npos)
        << measured;
    EXPECT_NE(measured.find("7 frames of 12.5 ms"), std::string::npos) << measured;
}

TEST(RenderFlags, EveryFlagHasItsWords) {
    EXPECT_EQ(describe_flags(flag_not_finite), "a radiance was infinite or not a number");
    EXPECT_EQ(
        describe_flags(flag_not_finite | flag_media_overflow, {"a", "b\nc"}),
        "a radiance was infinite or not a number; a ray was inside more than 8 solids at once, which is all it can "
        "list: a, b\\nc; take some away");
    EXPECT_EQ(describe_flags(flag_media_overflow),
              "a ray was inside more than 8 solids at once, which is all it can list; take some away");
    for (const RenderFlag flag : {flag_stack_overflow, flag_too_many_crossings, flag_objects_overflow})
        EXPECT_FALSE(describe_flags(flag).empty());
}

}  // namespace
}  // namespace cistula
