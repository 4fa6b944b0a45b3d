#include "scene/picture_oiio.h"

#include "scene/error.h"

namespace cistula {
namespace {

[[noreturn]] void refuse(const std::string& path) {
    throw Error(
        ExitCode::file,
        path + ": this build has no OpenImageIO (CISTULA_WITH_OIIO=OFF); EXR and .data are read by every build");
}

}  // namespace

ColorPicture oiio_read(const std::string& path) {
    refuse(path);
}

void oiio_write(const std::string& path, uint32_t, uint32_t, const std::vector<uint8_t>&) {
    refuse(path);
}

}  // namespace cistula
