// Finds the module for OpenImageIO and loads it, once; a program that needs no such picture never pays for it.
#pragma once

#include <string>

#include "scene/image/picture_oiio_module.h"

namespace cistula {

/// The module, which stays until the program ends. It is looked for on the search path of the program's libraries (its
/// RUNPATH among them), then in the program's own directory and in ../lib/cistula and ../lib beside it.
/// Throws Error(ExitCode::file) about the picture `path`, with the loader's reason, where there is none that can be
/// loaded.
const OiioModule& load_oiio_module(const std::string& path);

}  // namespace cistula
