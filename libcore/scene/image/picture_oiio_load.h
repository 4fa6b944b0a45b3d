// Loads the module for OpenImageIO when the first picture needs it.
#pragma once

#include <string>

#include "scene/image/picture_oiio_module.h"

namespace cistula {

/// The module, which stays loaded until the program ends. It is searched on the search path of the program's libraries
/// (its RUNPATH among them), then in the program's own directory and in ../lib/cistula and ../lib beside it.
/// Throws Error(ExitCode::file) about the picture `path`, with the loader's reason, if none can be loaded.
const OiioModule& load_oiio_module(const std::string& path);

}  // namespace cistula
