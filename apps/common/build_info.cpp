#include "apps/common/build_info.h"

namespace cistula {

const char* build_flags() {
    return CISTULA_BUILD_FLAGS;
}

const char* build_commit() {
    return CISTULA_BUILD_COMMIT;
}

}  // namespace cistula
