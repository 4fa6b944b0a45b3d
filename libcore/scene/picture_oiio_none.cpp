#include "scene/picture_oiio.h"

#include "scene/error.h"

namespace cistula {

ColorPicture oiio_read(const std::string& path) {
    throw Error(
        ExitCode::file,
        path + ": this build has no OpenImageIO (CISTULA_WITH_OIIO=OFF); EXR and .data are read by every build");
}

}  // namespace cistula
