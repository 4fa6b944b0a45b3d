// Comparison of a backend of this machine with all golden images.
#pragma once

#include "options.h"

namespace cistula {

/// Renders every scene of the folder, prints a table (unless quiet), writes --json. True if the integers of every film
/// and every float equal those of the golden images. Throws Error (file, device).
bool run_golden(const CompareOptions& options);

}  // namespace cistula
