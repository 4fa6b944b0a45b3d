// What the program that reads pictures may take, and how it ends where that is not enough.
#pragma once

#include <sys/resource.h>

#include <algorithm>
#include <cstdint>
#include <string>

#include "scene/image/reader_wire.h"

namespace cistula {

/// Limits a resource from now on; a lower limit of the other process stays.
template <class Resource>
void limit(Resource resource, uint64_t most) {
    rlimit limits = {};
    if (getrlimit(resource, &limits) != 0) return;
    limits.rlim_cur = std::min<rlim_t>(limits.rlim_max, most);
    setrlimit(resource, &limits);
}

/// The address space that decoding may take; `is_inherited`: the process that started this one allows no more.
struct MemoryLimit {
    uint64_t bytes;
    bool is_inherited;
};

MemoryLimit memory_limit(const ReadRequest& request);

/// Ends this process because it was given too little memory.
[[noreturn]] void end_out_of_memory();

/// Limits the processor time to that for a picture with so many bytes of texels.
void allow_seconds_for(const ReadRequest& request, uint64_t bytes);

/// Says why a file cannot be read, or ends this process where it was given too little memory.
void fail_answer(const MemoryLimit& memory, const std::string& reason);

}  // namespace cistula
