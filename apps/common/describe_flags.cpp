#include "apps/common/describe_flags.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <vector>

#include "cistula/geometry/ray.h"
#include "cistula/model/pixel_record.h"
#include "scene/base/shown_text.h"
#include "scene/compile/overlaps.h"

namespace cistula {
namespace {

/// A sentence's part on solids that are more than a ray can list, with their names where they are found.
std::string too_many_solids(const SceneDescription& scene) {
    const auto compiled = compile_scene<double>(scene);
    std::vector<std::string> names;
    for (const uint32_t solid : find_nested(*compiled)) names.push_back(one_line(compiled->solid_names[solid]));
    return fmt::format("a ray was inside more than {} solids at once, which is all it can list{}; take some away",
                       InteriorList::capacity, names.empty() ? "" : fmt::format(": {}", fmt::join(names, ", ")));
}

}  // namespace

std::string describe_flags(uint32_t flags, const SceneDescription& scene) {
    std::vector<std::string> parts;
    if (flags & flag_not_finite) parts.push_back("a radiance was infinite or not a number");
    if (flags & flag_media_overflow) parts.push_back(too_many_solids(scene));
    if (flags & flag_stack_overflow) parts.push_back("a ray's tree had more branches waiting than there is room for");
    if (flags & flag_too_many_crossings) parts.push_back("a straight ray crossed more faces than the limit");
    if (flags & flag_objects_overflow) parts.push_back("a pixel showed more objects than its table holds");
    return fmt::format("{}", fmt::join(parts, "; "));
}

}  // namespace cistula
