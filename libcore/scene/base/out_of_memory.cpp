#include "scene/base/out_of_memory.h"

#include <pthread.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <new>
#include <stdexcept>
#include <string_view>
#include <system_error>

#include "scene/base/atomic_file.h"
#include "scene/base/error.h"

namespace cistula {
namespace {

struct Words {
    char name[32], advice[300];
};

// Two in turn, so that those in use stay whole while the others are written.
constinit Words all_words[2] = {{"cistula", "allow it more"}, {}};
constinit std::atomic<const Words*> words = all_words;
constinit std::atomic<pthread_t> ender{};  // the thread that ends the program

[[noreturn]] void end_with(const char* text, const char* more = "") noexcept {
    claim_end();
    AtomicFile::abandon_all();
    char line[500];
    constexpr const char* erase = "\r\033[K";  // the status line
    std::snprintf(line, sizeof line - 1, "%s%s: %s%s", isatty(STDERR_FILENO) ? erase : "", words.load()->name, text,
                  more);
    std::replace(line, line + std::strlen(line), '\n', ' ');
    std::strcat(line, "\n");
    (void)!write(STDERR_FILENO, line, std::strlen(line));
    _exit(static_cast<int>(ExitCode::failed));
}

[[noreturn]] void end_uncaught(const char* reason) noexcept {
    end_with("ended by an error that nothing caught: ", reason);
}

void on_terminate() noexcept {
    try {
        if (const std::exception_ptr failure = std::current_exception()) std::rethrow_exception(failure);
    } catch (const std::exception& error) {
        end_if_out_of_memory(error);
        end_uncaught(error.what());
    } catch (...) {
    }
    end_uncaught("of an unknown kind");
}

struct sigaction fault_action_before;

/// Ends the program where a library uses the null pointer that it got for memory; other faults stay what they are.
void on_fault(int, siginfo_t* fault, void*) {
    constexpr uintptr_t null_page = 1 << 12;
    if (errno == ENOMEM && reinterpret_cast<uintptr_t>(fault->si_addr) < null_page) end_out_of_memory();
    sigaction(SIGSEGV, &fault_action_before, nullptr);  // for the instruction, which runs again
}

bool has_code(const std::exception& error, std::errc code) {
    const auto* of_system = dynamic_cast<const std::system_error*>(&error);
    return of_system && of_system->code() == code;
}

/// Whether a library's error has the text of the system's.
bool says(const std::exception& error, const char* text) {
    const auto* ours = dynamic_cast<const Error*>(&error);
    return (!ours || ours->code() != ExitCode::usage) && std::strstr(error.what(), text) != nullptr;
}

constexpr size_t stack_in_use = 1 << 20;

[[gnu::noinline]] void touch_stack() {
    volatile char room[stack_in_use];
    room[0] = 0;  // the end that is farthest away
    (void)room[0];
}

}  // namespace

void end_when_out_of_memory() {
    std::set_new_handler([] { end_out_of_memory(); });
    std::set_terminate(on_terminate);
    struct sigaction action = {};
    action.sa_sigaction = on_fault;
    action.sa_flags = SA_SIGINFO;
    sigaction(SIGSEGV, &action, &fault_action_before);
}

void set_out_of_memory_line(const std::string& name, const std::string& advice) {
    Words& next = all_words[words == all_words ? 1 : 0];
    std::snprintf(next.name, sizeof next.name, "%s", name.c_str());
    std::snprintf(next.advice, sizeof next.advice, "%s", advice.c_str());
    words = &next;
}

void reserve_stack() {
    rlimit limit = {};
    if (getrlimit(RLIMIT_STACK, &limit) != 0 || limit.rlim_cur < 2 * stack_in_use) return;
    void* const room = mmap(nullptr, stack_in_use, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (room == MAP_FAILED) end_out_of_memory();
    munmap(room, stack_in_use);
    touch_stack();
}

void end_out_of_memory(bool threads) noexcept {
    end_with(threads ? "cannot start a thread, for want of memory or of processes (ulimit -u); " : "out of memory; ",
             words.load()->advice);
}

void end_if_out_of_memory(const std::exception& error) noexcept {
    if (has_code(error, std::errc::resource_unavailable_try_again) || says(error, "Resource temporarily unavailable"))
        end_out_of_memory(true);
    if (dynamic_cast<const std::bad_alloc*>(&error) || dynamic_cast<const std::length_error*>(&error) ||
        has_code(error, std::errc::not_enough_memory) || says(error, "Cannot allocate memory") ||
        // The loader's, for a module; where something else is the reason, it follows.
        std::string_view(error.what()).ends_with("failed to map segment from shared object"))
        end_out_of_memory();
}

void claim_end() noexcept {
    pthread_t none{};
    const pthread_t self = pthread_self();
    if (ender.compare_exchange_strong(none, self) || none == self) return;
    while (true) pause();
}

}  // namespace cistula
