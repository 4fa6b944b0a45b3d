#include "image/reader/reader_answer.h"

#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <string_view>
#include <utility>

#include "image/color/stated_colors.h"
#include "image/reader/texture_limits.h"

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

void send_part(ReplyKind kind, const void* from, size_t size) {
    const ReplyHead head = {kind, static_cast<uint32_t>(size)};
    send(&head, sizeof head);
    send(from, size);
}

/// Begins a part with a record; texts follow.
template <class Record>
std::string bytes_of(const Record& record) {
    return {reinterpret_cast<const char*>(&record), sizeof record};
}

void append(std::string& bytes, std::string_view text, size_t most = largest_reply_id) {
    bytes += text.substr(0, most);
    bytes += '\0';
}

}  // namespace

void end_out_of_memory() {
    _exit(reader_out_of_memory);
}

void receive(void* to, size_t size) {
    for (auto* bytes = static_cast<char*>(to); size > 0;) {
        const ssize_t got = read(reader_socket, bytes, size);
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0) _exit(0);
        bytes += got;
        size -= static_cast<size_t>(got);
    }
}

void send_failure(const std::string& reason) {
    send_part(ReplyKind::failed, reason.data(), std::min<size_t>(reason.size(), largest_reply_part));
}

Answer::Answer(const ReadRequest& request, const MemoryLimit& memory, std::optional<FileColors> stated)
    : request_(request), memory_(memory), stated_(std::move(stated)), left_(request.left) {
    allow_seconds_for(0);
}

void Answer::allow_seconds_for(uint64_t bytes) const {
    limit(RLIMIT_CPU, static_cast<uint64_t>(seconds_for(static_cast<int>(request_.seconds), bytes)));
}

std::string Answer::size_problem(int64_t width, int64_t height, uint64_t texel) const {
    std::string problem = cistula::size_problem(is_texture(), width, height, texel, left_, request_.limit);
    if (problem.empty())
        allow_seconds_for(request_.left - left_ + texel * static_cast<uint64_t>(width) * static_cast<uint64_t>(height));
    return problem;
}

bool Answer::picture(const OiioPicture& picture) {
    const StoredTypeFacts& facts = facts_of(picture.type);
    const uint64_t texel = is_texture() ? texel_bytes : uint64_t{picture.channels} * facts.value_bytes;
    if (const std::string problem = size_problem(picture.width, picture.height, texel); !problem.empty()) {
        send_failure(problem);
        return false;
    }
    left_ -= texel * static_cast<uint64_t>(picture.width) * static_cast<uint64_t>(picture.height);
    texel_ = size_t{picture.channels} * facts.sample_bytes;
    std::string bytes = bytes_of(
        ReplyPicture{picture.x, picture.y, picture.display_x, picture.display_y, static_cast<uint32_t>(picture.width),
                     static_cast<uint32_t>(picture.height), static_cast<uint32_t>(picture.display_width),
                     static_cast<uint32_t>(picture.display_height), picture.level, picture.channels, picture.type, 0});
    append(bytes, picture.format);
    for (uint32_t channel = 0; channel < picture.channels; ++channel) append(bytes, picture.names[channel]);
    send_part(ReplyKind::picture, bytes.data(), bytes.size());
    if (stated_) colors(*stated_);
    return true;
}

void Answer::colors(const FileColors& colors) const {
    ReplyColors reply = {};
    if (colors.chromaticities)
        std::copy(colors.chromaticities->begin(), colors.chromaticities->end(), reply.chromaticities);
    std::copy(colors.factors.begin(), colors.factors.end(), reply.factors);
    reply.has_chromaticities = colors.chromaticities.has_value();
    reply.is_aces = colors.is_aces;
    reply.is_half = colors.is_half;
    reply.names_profile = !colors.profile.empty();
    std::string bytes = bytes_of(reply);
    bytes.append(colors.profile.empty() ? colors.id : colors.profile, 0, largest_reply_id);
    send_part(ReplyKind::colors, bytes.data(), bytes.size());
}

void Answer::profile(std::string_view bytes) const {
    if (!stated_) colors(colors_of_profile(bytes));
}

void Answer::attribute(const char* name, const char* type, const char* text) const {
    std::string bytes;
    append(bytes, name);
    append(bytes, type);
    append(bytes, text, largest_reply_part / 2);
    send_part(ReplyKind::attribute, bytes.data(), bytes.size());
}

void Answer::samples(const void* from, size_t texels) const {
    const size_t most = largest_reply_part / texel_;
    for (const auto* bytes = static_cast<const char*>(from); texels > 0;) {
        const size_t count = std::min(texels, most);
        send_part(ReplyKind::samples, bytes, count * texel_);
        bytes += count * texel_;
        texels -= count;
    }
}

void Answer::end() const {
    send_part(ReplyKind::end, nullptr, 0);
}

void Answer::fail(const std::string& reason) const {
    if (memory_.is_inherited && errno == ENOMEM) end_out_of_memory();  // whatever a library makes of it
    send_failure(reason);
}

}  // namespace cistula
