// Raw pictures, .data.
#include "checks.h"
#include "image/picture/raw_picture.h"
#include "target.h"

FUZZ_TARGET(data) {
    using namespace cistula;
    const fuzz::MemoryFile file(data, size);
    try {
        const ColorPicture picture = read_raw_picture(file.path());
        fuzz::require(picture.width > 0 && picture.height > 0);
        fuzz::require(picture.texels.size() == static_cast<size_t>(picture.width) * picture.height);
        fuzz::require(4 * picture.texels.size() + 8 == size);
        for (const glm::vec3& texel : picture.texels)
            for (int c = 0; c < 3; ++c) fuzz::require(texel[c] >= 0 && texel[c] <= 1);
    } catch (const Error& error) {
        fuzz::check_error(error, ErrorKind::file);
    }
    return 0;
}
