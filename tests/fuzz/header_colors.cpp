// What headers of pictures say of colors: PNG, Radiance, TIFF, WebP, DPX, Cineon, TGA.
#include <stdexcept>

#include "checks.h"
#include "image/color/stated_colors.h"
#include "target.h"

FUZZ_TARGET(header_colors) {
    using namespace cistula;
    const fuzz::MemoryFile memory(data, size);
    const std::optional<FileColors> colors = stated_colors(memory.path());
    if (!colors) return 0;
    try {
        file_encoding("", *colors, false);
        fuzz::require(colors->profile.empty());
    } catch (const std::runtime_error& refused) {
        fuzz::check_line(refused.what());
    }
    return 0;
}
