// All golden images against a backend of this machine.
#pragma once

#include "options.h"

namespace cistula {

/// Renders every scene of the folder, prints a table (unless quiet), writes --json. True where the integers of every
/// film and every float are those of the golden images. Throws Error (file, device).
bool run_golden(const CompareOptions& options);

}  // namespace cistula
