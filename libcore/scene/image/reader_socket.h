// What the program that reads pictures says and hears over its socket.
#pragma once

#include <cstddef>
#include <string>

#include "scene/image/reader_wire.h"

namespace cistula {

/// Fills `size` bytes at `to` with what the other process says; ends this one if that has ended.
void receive(void* to, size_t size);

void send_part(ReplyKind kind, const void* from, size_t size);

/// Says why a file cannot be read.
void send_failure(const std::string& reason);

/// Sends whole texels, in parts of the largest size.
void send_samples(const void* from, size_t texels, size_t texel_bytes);

}  // namespace cistula
