// The part for files as they stand of the module that uses OpenImageIO.
#pragma once

#include "scene/image/oiio_module.h"

namespace cistula {

/// OiioModule::read_stored.
bool read_stored(const char* path, const OiioStoredHost* host) noexcept;

}  // namespace cistula
