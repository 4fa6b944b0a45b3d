// What the program that reads pictures says and hears over its socket, and the limits within which it does.
#pragma once

#include <sys/resource.h>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>

#include "image/color/file_colors.h"
#include "image/reader/oiio_module.h"
#include "image/reader/reader_wire.h"

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

/// Ends this process because it was given too little memory.
[[noreturn]] void end_out_of_memory();

/// Fills `size` bytes at `to` with what the other process says; ends this one if that has ended.
void receive(void* to, size_t size);

/// Says why a file cannot be read.
void send_failure(const std::string& reason);

/// An answer in work.
class Answer {
  public:
    /// `stated`: what the picture's header says of its colors, if that is no ICC profile.
    Answer(const ReadRequest& request, const MemoryLimit& memory, std::optional<FileColors> stated);

    /// Why a picture of this size is refused; empty if it is not, and then it may take the time for its size.
    std::string size_problem(int64_t width, int64_t height, uint64_t texel) const;

    /// Begins a picture. False: it is refused, which has been said.
    bool picture(const OiioPicture& picture);

    /// Says what a file says of its colors.
    void colors(const FileColors& colors) const;

    /// Says what an ICC profile says, unless the header has stated something.
    void profile(std::string_view bytes) const;

    void attribute(const char* name, const char* type, const char* text) const;

    /// Sends the next texels of the picture.
    void samples(const void* from, size_t texels) const;

    void end() const;

    /// Says why the file cannot be read, or ends this process where it was given too little memory.
    void fail(const std::string& reason) const;

    bool is_texture() const { return request_.kind != ReadKind::stored; }
    uint64_t left() const { return left_; }

  private:
    void allow_seconds_for(uint64_t bytes) const;

    const ReadRequest& request_;
    const MemoryLimit& memory_;
    const std::optional<FileColors> stated_;
    uint64_t left_;
    size_t texel_ = 0;  // bytes of a texel as it is sent
};

}  // namespace cistula
