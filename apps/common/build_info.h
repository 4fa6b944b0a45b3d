// Facts about the build, for records.
#pragma once

namespace cistula {

/// The compiler's flags of the build type and of the floating-point contract.
const char* build_flags();

/// `git describe --always --dirty` of the source tree when the build was configured; "unknown" outside a git tree.
const char* build_commit();

}  // namespace cistula
