#include "scene/image/picture_oiio.h"

namespace cistula {

std::string load_oiio() {
    return "this build has no OpenImageIO (CISTULA_WITH_OIIO=OFF), which reads formats other than EXR and .data; `make "
           "build` installs it (Debian: libopenimageio-dev) and builds with it";
}

bool oiio_read(const std::string&, const OiioHost& host) {
    host.failed(host.self, load_oiio().c_str());
    return false;
}

}  // namespace cistula
