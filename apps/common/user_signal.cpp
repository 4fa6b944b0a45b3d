#include "apps/common/user_signal.h"

#include <semaphore.h>
#include <atomic>
#include <cerrno>
#include <csignal>

namespace cistula {
namespace {

sem_t arrived;  // posted by the handler: sem_post is safe there
std::atomic<bool> closed{false};
struct sigaction previous;

void on_signal(int) {
    const int kept = errno;
    sem_post(&arrived);
    errno = kept;
}

}  // namespace

UserSignal::UserSignal() {
    sem_init(&arrived, 0, 0);
    closed = false;
    struct sigaction action = {};
    action.sa_handler = on_signal;
    action.sa_flags = SA_RESTART;
    sigemptyset(&action.sa_mask);
    sigaction(SIGUSR1, &action, &previous);
}

UserSignal::~UserSignal() {
    sigaction(SIGUSR1, &previous, nullptr);
    sem_destroy(&arrived);
}

bool UserSignal::wait() {
    while (sem_wait(&arrived) != 0 && errno == EINTR) {
    }
    while (sem_trywait(&arrived) == 0) {
    }
    return !closed;
}

void UserSignal::close() {
    closed = true;
    sem_post(&arrived);
}

}  // namespace cistula
