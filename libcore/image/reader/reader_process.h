// A child process that runs the program that reads pictures.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>

namespace cistula {

/// The running program; it ends with the object, and with the thread that made the object. It has its streams on
/// /dev/null and of this process's files only its end of a socket.
class ReaderProcess {
  public:
    using Clock = std::chrono::steady_clock;

    /// Starts it; `users` need it, for the message where it is not found. Throws std::runtime_error.
    explicit ReaderProcess(const std::string& users);
    ~ReaderProcess();
    ReaderProcess(const ReaderProcess&) = delete;
    ReaderProcess& operator=(const ReaderProcess&) = delete;

    /// Says `size` bytes. Throws ReaderBroken with how the program ended, where it has ended, and std::bad_alloc where
    /// that was for want of memory.
    void send(const void* from, size_t size);

    /// Receives exactly `size` bytes. Throws as send() does if the program ends before, and ReaderBroken if the time is
    /// over.
    void receive(void* to, size_t size, Clock::time_point end);

  private:
    /// Throws std::bad_alloc, or ReaderBroken with what became of the program, which has closed its socket.
    [[noreturn]] void fail_ended();

    std::string program_;
    int socket_ = -1;
    pid_t child_ = -1;
};

/// The path of cistula-read-picture. It is searched where the dynamic linker searches the libraries of whatever this
/// code is linked to (its RUNPATH among them), then in the directory of the library that contains this code and in
/// ../lib/cistula and ../lib beside it, then likewise by the running program. Throws std::runtime_error that names
/// these directories, and what needs it, `users`.
std::string reader_path(const std::string& users);

}  // namespace cistula
