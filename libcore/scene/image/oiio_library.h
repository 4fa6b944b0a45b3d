// The module that uses OpenImageIO, as a library that is loaded when a picture or a view needs it.
#pragma once

#include <filesystem>
#include <string>

#include "scene/image/oiio_module.h"

namespace cistula {

/// The module's functions. It is loaded from that directory at the first call, and stays loaded. Throws
/// std::runtime_error with what needs it, `users`, where it cannot be loaded, and where the build has none
/// (CISTULA_WITH_OIIO=OFF); std::bad_alloc where `ulimit -v` leaves too little for it.
const OiioModule& load_oiio(const std::filesystem::path& directory, const std::string& users);

}  // namespace cistula
