// cistula-read-picture: reads pictures for another process, which starts it (reader_process.h), each by a fork of its
// own, so that a picture that makes a library crash or take memory or time without end harms nothing else.
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <filesystem>
#include <new>
#include <string>
#include <string_view>

#include "scene/base/file_bytes.h"
#include "scene/image/exr.h"
#include "scene/image/file_colors.h"
#include "scene/image/icc_profile.h"
#include "scene/image/oiio_library.h"
#include "scene/image/reader_limits.h"
#include "scene/image/reader_socket.h"
#include "scene/image/reader_wire.h"
#include "scene/image/stated_colors.h"
#include "scene/image/stored_answer.h"
#include "scene/image/texture_limits.h"

namespace cistula {
namespace {

/// The answer with a texture.
class Answer {
  public:
    /// `stated`: what the picture's header says of its colors.
    Answer(const ReadRequest& request, const MemoryLimit& memory, std::optional<FileColors> stated)
        : request_(request), memory_(memory), stated_(std::move(stated)) {
        allow_seconds_for(request_, 0);
    }

    /// Why a picture of this size is refused; empty if it is not, and then it may take the time for its size.
    std::string size_problem(int64_t width, int64_t height) const {
        std::string problem = texture_size_problem(width, height, request_.left, request_.limit);
        if (problem.empty())
            allow_seconds_for(request_, texel_bytes * static_cast<uint64_t>(width) * static_cast<uint64_t>(height));
        return problem;
    }

    /// Says what a file says of its colors.
    void colors(const FileColors& colors) const {
        ReplyColors reply = {};
        if (colors.chromaticities)
            std::copy(colors.chromaticities->begin(), colors.chromaticities->end(), reply.chromaticities);
        reply.has_chromaticities = colors.chromaticities.has_value();
        reply.is_aces = colors.is_aces;
        reply.is_half = colors.is_half;
        reply.names_profile = !colors.profile.empty();
        std::string bytes(reinterpret_cast<const char*>(&reply), sizeof reply);
        bytes.append(colors.profile.empty() ? colors.id : colors.profile, 0, largest_reply_id);
        send_part(ReplyKind::colors, bytes.data(), bytes.size());
    }

    /// Says what a profile says, where the header does not come before it.
    void profile(std::string_view bytes) const {
        if (!stated_) colors(colors_of_profile(bytes));
    }

    bool begin(int64_t width, int64_t height, uint32_t channels, OiioSamples type) {
        if (stated_) colors(*stated_);
        if (const std::string problem = size_problem(width, height); !problem.empty()) {
            send_failure(problem);
            return false;
        }
        const ReplySize size = {static_cast<uint32_t>(width), static_cast<uint32_t>(height), channels,
                                static_cast<uint32_t>(type)};
        texel_ = channels * size.sample_bytes;
        send_part(ReplyKind::size, &size, sizeof size);
        return true;
    }

    void samples(const void* from, size_t texels) const { send_samples(from, texels, texel_); }

    /// Says why the picture cannot be read.
    void fail(const std::string& reason) const { fail_answer(memory_, reason); }

  private:
    const ReadRequest& request_;
    const MemoryLimit& memory_;
    const std::optional<FileColors> stated_;
    size_t texel_ = 0;
};

OiioHost host_of(Answer& answer, uint64_t left) {
    return {&answer,
            left,
            [](void* self, const void* bytes, size_t count) noexcept {
                static_cast<Answer*>(self)->profile({static_cast<const char*>(bytes), count});
            },
            [](void* self, int64_t width, int64_t height, uint32_t channels, OiioSamples type) noexcept {
                return static_cast<Answer*>(self)->begin(width, height, channels, type);
            },
            [](void* self, const void* from, size_t texels) noexcept {
                static_cast<const Answer*>(self)->samples(from, texels);
            },
            [](void* self, const char* reason) noexcept { static_cast<const Answer*>(self)->fail(reason); }};
}

void answer_exr(const std::string& path, Answer& answer) {
    ColorPicture picture;
    FileColors colors;
    try {
        picture = read_exr_texture(
            path, [&](int64_t width, int64_t height) { return answer.size_problem(width, height); }, &colors);
    } catch (const std::bad_alloc&) {
        errno = ENOMEM;
        return answer.fail("decoding it takes more memory than is allowed");
    } catch (const std::exception& error) {
        const std::string_view message = error.what();
        const std::string before = path + ": cannot read: ";  // which the other process says, too
        return answer.fail(std::string(message.starts_with(before) ? message.substr(before.size()) : message));
    }
    answer.colors(colors);
    if (answer.begin(picture.width, picture.height, 3, OiioSamples::float32))
        answer.samples(picture.texels.data(), picture.texels.size());
}

/// Answers within the limits, and ends this process. `oiio`: null for an EXR.
[[noreturn]] void answer_and_end(const std::string& path, const ReadRequest& request, const MemoryLimit& memory,
                                 const OiioModule* oiio) {
    limit(RLIMIT_AS, memory.bytes);
    if (memory.is_inherited) std::set_new_handler(end_out_of_memory);
    errno = 0;
    if (request.kind == ReadKind::stored) {
        answer_stored(path, request, memory, *oiio);
        _exit(0);
    }
    const bool is_exr = request.kind == ReadKind::exr_texture;
    Answer answer(request, memory, is_exr ? std::nullopt : stated_colors(path));
    if (is_exr) {
        answer_exr(path, answer);
    } else {
        const OiioHost host = host_of(answer, request.left);
        oiio->read(path.c_str(), &host);
    }
    _exit(0);
}

/// The directory of this program, in which the module for OpenImageIO lies.
std::filesystem::path own_directory() {
    std::error_code failure;
    return std::filesystem::read_symlink("/proc/self/exe", failure).parent_path();
}

/// Ends this process if the one that started it has ended, or ends.
void end_with(pid_t parent) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != parent) _exit(0);
}

/// Ends as a child process has ended, unless that was well.
void end_like(int status, const MemoryLimit& memory) {
    if (WIFSIGNALED(status)) {
        const int number = WTERMSIG(status);  // libraries abort, or use the null pointer that they got for memory
        if (memory.is_inherited && (number == SIGABRT || number == SIGSEGV || number == SIGBUS)) end_out_of_memory();
        limit(RLIMIT_CORE, 0);
        std::signal(number, SIG_DFL);
        raise(number);
    }
    if (status != 0) _exit(WIFEXITED(status) ? WEXITSTATUS(status) : 1);
}

/// Answers one request by a process of its own, so that what a picture breaks there harms no other picture. Libraries
/// are loaded before, once.
void answer_one() {
    ReadRequest request;
    receive(&request, sizeof request);
    std::string path(request.path_size, '\0');
    receive(path.data(), path.size());
    const OiioModule* oiio = nullptr;
    try {
        if (request.kind == ReadKind::texture) oiio = &load_oiio(own_directory(), "formats other than EXR and .data");
        if (request.kind == ReadKind::stored) oiio = &load_oiio(own_directory(), "formats other than EXR");
    } catch (const std::bad_alloc&) {
        end_out_of_memory();
    } catch (const std::exception& error) {
        return send_failure(error.what());
    }
    const MemoryLimit memory = memory_limit(request);
    const pid_t self = getpid(), child = fork();
    if (child == 0) {
        end_with(self);
        answer_and_end(path, request, memory, oiio);
    }
    if (child < 0 && errno == ENOMEM) end_out_of_memory();
    if (child < 0) return send_failure("no process can be started to decode it");
    int status = 0;
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    end_like(status, memory);
}

}  // namespace
}  // namespace cistula

int main(int count, char** arguments) {
    using namespace cistula;
    if (count != 2 || std::string_view(arguments[1]) != reader_protocol) {
        std::fputs("cistula-read-picture: is started by programs that read textures, and does nothing by itself\n",
                   stderr);
        return reader_wrong_protocol;
    }
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
    prctl(PR_SET_DUMPABLE, 0);  // no core file of a crash that is expected
    limit(RLIMIT_FSIZE, 0);
    for (;;) answer_one();
}
