// The answer of the program that reads pictures with all of a file, as it stands.
#pragma once

#include <string>

#include "scene/image/oiio_module.h"
#include "scene/image/reader_limits.h"
#include "scene/image/reader_wire.h"

namespace cistula {

void answer_stored(const std::string& path, const ReadRequest& request, const MemoryLimit& memory,
                   const OiioModule& oiio);

}  // namespace cistula
