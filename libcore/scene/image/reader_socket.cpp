#include "scene/image/reader_socket.h"

#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>

namespace cistula {
namespace {

void send(const void* from, size_t size) {
    for (const auto* bytes = static_cast<const char*>(from); size > 0;) {
        const ssize_t sent = ::send(reader_socket, bytes, size, MSG_NOSIGNAL);
        if (sent < 0 && errno == EINTR) continue;
        if (sent <= 0) _exit(0);
        bytes += sent;
        size -= static_cast<size_t>(sent);
    }
}

}  // namespace

void receive(void* to, size_t size) {
    for (auto* bytes = static_cast<char*>(to); size > 0;) {
        const ssize_t got = read(reader_socket, bytes, size);
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0) _exit(0);
        bytes += got;
        size -= static_cast<size_t>(got);
    }
}

void send_part(ReplyKind kind, const void* from, size_t size) {
    const ReplyHead head = {kind, static_cast<uint32_t>(size)};
    send(&head, sizeof head);
    send(from, size);
}

void send_failure(const std::string& reason) {
    send_part(ReplyKind::failed, reason.data(), std::min<size_t>(reason.size(), largest_reply_part));
}

void send_samples(const void* from, size_t texels, size_t texel_bytes) {
    const size_t most = largest_reply_part / texel_bytes;
    for (const auto* bytes = static_cast<const char*>(from); texels > 0;) {
        const size_t count = std::min(texels, most);
        send_part(ReplyKind::samples, bytes, count * texel_bytes);
        bytes += count * texel_bytes;
        texels -= count;
    }
}

}  // namespace cistula
