// The end of a program whose memory runs out: one line and exit code 1, on whatever thread and in whatever code.
#pragma once

#include <exception>
#include <string>

namespace cistula {

/// From now on the program ends as end_out_of_memory() says where operator new fails, rather than throw through code
/// that is not made for it: threads and destructors of libraries, modules while they are loaded; and where a library
/// uses the null pointer that it got for memory. It ends in one line, too, where an exception is not caught. Programs
/// call it before the first static constructor.
void end_when_out_of_memory();

/// Sets what the line says: "NAME: out of memory; ADVICE". Only one thread does.
void set_out_of_memory_line(const std::string& name, const std::string& advice);

/// Writes the line to standard error, removes the files that are being written, and ends the program with exit code 1.
/// Allocates nothing and runs no destructor. `threads`: what is lacking may be the right to start threads.
[[noreturn]] void end_out_of_memory(bool threads = false) noexcept;

/// Makes the stack of the main thread, which calls it, as large as the program needs: where memory is limited and the
/// stack cannot grow, a signal would end the program.
void reserve_stack();

/// Ends the program so if this is how a library or the system says that memory is lacking or no thread can be started.
void end_if_out_of_memory(const std::exception& error) noexcept;

/// Makes the calling thread the one whose error is told: others that end the program wait from now on.
void claim_end() noexcept;

}  // namespace cistula
