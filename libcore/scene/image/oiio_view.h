// The part for views of the module that uses OpenImageIO, which passes them on to OpenColorIO.
#pragma once

#include "scene/image/oiio_module.h"

namespace cistula {

/// The functions of OiioModule of these names.
OiioView* open_view(const char* config, const char* name, const OiioViewHost* host) noexcept;
const char* assumed_space(const OiioView* view) noexcept;
bool apply_view(const OiioView* view, float* rgb, size_t count) noexcept;
void close_view(OiioView* view) noexcept;

}  // namespace cistula
