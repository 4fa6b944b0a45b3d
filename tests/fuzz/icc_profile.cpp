// ICC profiles of pictures.
#include "image/color/stated_colors.h"

#include <stdexcept>

#include "checks.h"
#include "target.h"

FUZZ_TARGET(icc_profile) {
    using namespace cistula;
    const FileColors colors = colors_of_profile({reinterpret_cast<const char*>(data), size});
    fuzz::require(colors.id.empty() != colors.profile.empty());
    fuzz::require(colors.profile.size() <= 80);
    try {
        file_encoding("", colors, false);
        fuzz::require(!colors.id.empty());
    } catch (const std::runtime_error& refused) {
        fuzz::require(!colors.profile.empty());
        for (const char* c = refused.what(); *c; ++c) fuzz::require(static_cast<unsigned char>(*c) >= 0x20);
    }
    return 0;
}
