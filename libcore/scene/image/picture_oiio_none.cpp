#include "scene/image/picture_oiio.h"

#include "scene/base/error.h"

namespace cistula {

ColorPicture oiio_read(const std::string& path) {
    throw Error(ExitCode::file,
                path +
                    ": this build has no OpenImageIO (CISTULA_WITH_OIIO=OFF), which reads formats other than EXR "
                    "and .data; `make build` installs it (Debian: libopenimageio-dev) and builds with it");
}

}  // namespace cistula
