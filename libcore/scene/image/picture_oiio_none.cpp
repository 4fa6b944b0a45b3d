#include "scene/image/picture_oiio.h"

#include "scene/base/error.h"

namespace cistula {

ColorPicture oiio_read(const std::string& path) {
    throw Error(
        ExitCode::file,
        path + ": this build has no OpenImageIO (CISTULA_WITH_OIIO=OFF); EXR and .data are read by every build");
}

}  // namespace cistula
