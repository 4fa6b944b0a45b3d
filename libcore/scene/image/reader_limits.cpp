#include "scene/image/reader_limits.h"

#include <unistd.h>

#include <cerrno>

#include "scene/base/machine_memory.h"
#include "scene/image/reader_socket.h"
#include "scene/image/texture_limits.h"

namespace cistula {

MemoryLimit memory_limit(const ReadRequest& request) {
    constexpr uint64_t beside_texels = 1 << 30;
    const uint64_t own = address_space() + beside_texels + 2 * request.left;
    rlimit inherited = {};
    if (getrlimit(RLIMIT_AS, &inherited) == 0 && inherited.rlim_cur < own) return {inherited.rlim_cur, true};
    return {own, false};
}

void end_out_of_memory() {
    _exit(reader_out_of_memory);
}

void allow_seconds_for(const ReadRequest& request, uint64_t bytes) {
    limit(RLIMIT_CPU, static_cast<uint64_t>(seconds_for(static_cast<int>(request.seconds), bytes)));
}

void fail_answer(const MemoryLimit& memory, const std::string& reason) {
    if (memory.is_inherited && errno == ENOMEM) end_out_of_memory();  // whatever a library makes of it
    send_failure(reason);
}

}  // namespace cistula
