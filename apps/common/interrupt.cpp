#include "apps/common/interrupt.h"

#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <iterator>

#include "apps/common/command_line.h"
#include "base/atomic_file.h"
#include "sequence/snapshots.h"

namespace cistula {
namespace {

// State for the signal handler, which may only use lock-free atomics, _exit, write and sigaction.
std::atomic<std::atomic<bool>*> watched{nullptr};
static_assert(std::atomic<std::atomic<bool>*>::is_always_lock_free && std::atomic<bool>::is_always_lock_free);

constexpr int signals[] = {SIGINT, SIGTERM, SIGHUP, SIGPIPE};
constexpr size_t signal_count = std::size(signals);
struct sigaction previous[signal_count];
char program_name[64];

void on_signal(int number, siginfo_t* info, void*) {
    if (number == SIGPIPE && info->si_pid == getpid()) return;  // by a write of this process, which fails
    std::atomic<bool>* const stop = watched;
    if (stop != nullptr && !stop->exchange(true)) return;
    remove_temporaries();
    if (stop == nullptr) {
        static constexpr char message[] = ": interrupted\n";
        (void)!write(STDERR_FILENO, program_name, strlen(program_name));
        (void)!write(STDERR_FILENO, message, sizeof message - 1);
    }
    _exit(static_cast<int>(ExitCode::interrupted));
}

}  // namespace

InterruptGuard::InterruptGuard(const char* program) {
    strncpy(program_name, program, sizeof program_name - 1);
    struct sigaction action = {};
    action.sa_sigaction = on_signal;
    action.sa_flags = SA_RESTART | SA_SIGINFO;
    sigemptyset(&action.sa_mask);
    for (size_t i = 0; i < signal_count; ++i) {
        sigaction(signals[i], nullptr, &previous[i]);
        // A signal ignored by the parent (nohup, a shell's background job) stays ignored.
        if (previous[i].sa_handler != SIG_IGN) sigaction(signals[i], &action, nullptr);
    }
}

InterruptGuard::~InterruptGuard() {
    for (size_t i = 0; i < signal_count; ++i) sigaction(signals[i], &previous[i], nullptr);
}

StopOnInterrupt::StopOnInterrupt(std::atomic<bool>& stop) {
    watched = &stop;
}

StopOnInterrupt::~StopOnInterrupt() {
    watched = nullptr;
}

namespace {

std::atomic<SnapshotRequests*> asked{nullptr};
struct sigaction user_action_before;

void on_user_signal(int) {
    const int kept = errno;
    if (SnapshotRequests* const requests = asked) requests->ask();
    errno = kept;
}

}  // namespace

UserSignal::UserSignal(SnapshotRequests& requests) {
    asked = &requests;
    struct sigaction action = {};
    action.sa_handler = on_user_signal;
    action.sa_flags = SA_RESTART;
    sigemptyset(&action.sa_mask);
    sigaction(SIGUSR1, &action, &user_action_before);
}

UserSignal::~UserSignal() {
    sigaction(SIGUSR1, &user_action_before, nullptr);
    asked = nullptr;
}

}  // namespace cistula
