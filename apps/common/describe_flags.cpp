#include "apps/common/describe_flags.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <vector>

#include "cistula/model/pixel_record.h"

namespace cistula {

std::string describe_flags(uint32_t flags) {
    std::vector<std::string> parts;
    if (flags & flag_not_finite) parts.push_back("a radiance was infinite or not a number");
    if (flags & flag_media_overflow) parts.push_back("a ray was inside more solids at once than it can list");
    if (flags & flag_stack_overflow) parts.push_back("a ray's tree had more branches waiting than there is room for");
    if (flags & flag_too_many_crossings) parts.push_back("a straight ray crossed more faces than the limit");
    if (flags & flag_objects_overflow) parts.push_back("a pixel showed more objects than its table holds");
    return fmt::format("{}", fmt::join(parts, "; "));
}

}  // namespace cistula
