#include "scene/image/picture_oiio.h"

namespace cistula {

std::string load_oiio() {
    return "this build has no OpenImageIO (CISTULA_WITH_OIIO=OFF); EXR and .data are read by every build";
}

bool oiio_read(const std::string&, const OiioHost& host) {
    host.failed(host.self, load_oiio().c_str());
    return false;
}

}  // namespace cistula
