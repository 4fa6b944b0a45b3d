#include "image/reader/reader_process.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <new>
#include <stdexcept>
#include <system_error>
#include <thread>

#include "image/reader/reader_reply.h"

namespace cistula {
namespace {

std::string error_text(int error_number) {
    return std::generic_category().message(error_number);
}

/// What a child's files and signals are; frees what the C functions allocate.
struct SpawnSettings {
    posix_spawn_file_actions_t files;
    posix_spawnattr_t attributes;

    explicit SpawnSettings(int socket) {
        posix_spawn_file_actions_init(&files);
        posix_spawn_file_actions_adddup2(&files, socket, reader_socket);
        for (int stream = 0; stream < reader_socket; ++stream)
            posix_spawn_file_actions_addopen(&files, stream, "/dev/null", O_RDWR, 0);
        posix_spawn_file_actions_addclosefrom_np(&files, reader_socket + 1);
        // A process group of its own: what a terminal interrupts is this process, which then ends the child.
        posix_spawnattr_init(&attributes);
        posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
        posix_spawnattr_setpgroup(&attributes, 0);
        sigset_t signals;
        sigemptyset(&signals);
        posix_spawnattr_setsigmask(&attributes, &signals);
        sigfillset(&signals);
        posix_spawnattr_setsigdefault(&attributes, &signals);
    }
    ~SpawnSettings() {
        posix_spawnattr_destroy(&attributes);
        posix_spawn_file_actions_destroy(&files);
    }
    SpawnSettings(const SpawnSettings&) = delete;
    SpawnSettings& operator=(const SpawnSettings&) = delete;
};

/// Waits for a child that is about to end; false if it does not within two seconds, or if it is not known.
bool has_ended(pid_t child, int& status) {
    for (int wait = 0; wait < 200; ++wait) {
        const pid_t got = waitpid(child, &status, WNOHANG);
        if (got == child) return true;
        if (got < 0 && errno != EINTR) return false;
        std::this_thread::sleep_for(std::chrono::milliseconds(wait < 10 ? 1 : 10));
    }
    return false;
}

std::string what_ended(int status, const std::string& program) {
    if (WIFSIGNALED(status)) {
        const int number = WTERMSIG(status);
        if (number == SIGXCPU) return "decoding it takes more processor time than is allowed; the file is damaged";
        return "its decoder was ended by signal " + std::to_string(number) + " (" + strsignal(number) +
               "); the file is damaged";
    }
    if (WEXITSTATUS(status) == reader_wrong_protocol) return program + " belongs to another version of Cistula";
    if (WEXITSTATUS(status) == 127) return program + " cannot be started; are the libraries that it needs installed?";
    return "its decoder ended with exit code " + std::to_string(WEXITSTATUS(status)) + "; the file is damaged";
}

}  // namespace

ReaderProcess::ReaderProcess(const std::string& users) : program_(reader_path(users)) {
    int ends[2];
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0)
        throw std::runtime_error(program_ + " cannot be started: " + error_text(errno));
    socket_ = ends[0];
    const SpawnSettings settings(ends[1]);
    char* const arguments[] = {program_.data(), const_cast<char*>(reader_protocol), nullptr};
    const int failure =
        posix_spawn(&child_, program_.c_str(), &settings.files, &settings.attributes, arguments, environ);
    close(ends[1]);
    if (failure == 0) return;
    close(socket_);
    throw std::runtime_error(program_ + " cannot be started: " + error_text(failure));
}

ReaderProcess::~ReaderProcess() {
    close(socket_);
    if (child_ < 0 || waitpid(child_, nullptr, WNOHANG) != 0) return;  // it has ended, or is not ours any more
    kill(child_, SIGKILL);
    while (waitpid(child_, nullptr, 0) < 0 && errno == EINTR) {
    }
}

void ReaderProcess::send(const void* from, size_t size) {
    const auto* bytes = static_cast<const char*>(from);
    while (size > 0) {
        const ssize_t sent = ::send(socket_, bytes, size, MSG_NOSIGNAL);
        if (sent < 0 && errno == EINTR) continue;
        if (sent <= 0) fail_ended();
        bytes += sent;
        size -= static_cast<size_t>(sent);
    }
}

void ReaderProcess::receive(void* to, size_t size, Clock::time_point end) {
    auto* bytes = static_cast<char*>(to);
    while (size > 0) {
        const auto left = std::chrono::ceil<std::chrono::milliseconds>(end - Clock::now()).count();
        pollfd wait = {socket_, POLLIN, 0};
        const int ready = left > 0 ? poll(&wait, 1, static_cast<int>(std::min<int64_t>(left, 1 << 30))) : 0;
        if (ready < 0 && errno == EINTR) continue;
        if (ready == 0) throw ReaderBroken("decoding it takes more time than is allowed; the file is damaged");
        const ssize_t got = recv(socket_, bytes, size, MSG_DONTWAIT);
        if (got < 0 && (errno == EINTR || errno == EAGAIN)) continue;
        if (got <= 0) fail_ended();
        bytes += got;
        size -= static_cast<size_t>(got);
    }
}

void ReaderProcess::fail_ended() {
    int status = 0;
    if (!has_ended(child_, status)) throw ReaderBroken("its decoder ended in an unknown way; the file is damaged");
    child_ = -1;
    if (WIFEXITED(status) && WEXITSTATUS(status) == reader_out_of_memory) throw std::bad_alloc();
    throw ReaderBroken(what_ended(status, program_));
}

}  // namespace cistula
