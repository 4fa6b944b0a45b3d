#include "scene/image/stored_answer.h"

#include <string_view>

#include "scene/image/reader_socket.h"
#include "scene/image/texture_limits.h"

namespace cistula {
namespace {

/// The answer in work.
class StoredAnswer {
  public:
    StoredAnswer(const ReadRequest& request, const MemoryLimit& memory)
        : request_(request), memory_(memory), left_(request.left) {
        allow_seconds_for(request_, 0);
    }

    bool picture(const OiioPicture& picture) {
        const uint64_t texel = uint64_t{picture.channels} * value_bytes(picture.type);
        const std::string problem = stored_size_problem(picture.width, picture.height, texel, left_, request_.limit);
        if (!problem.empty()) {
            send_failure(problem);
            return false;
        }
        left_ -= texel * static_cast<uint64_t>(picture.width) * static_cast<uint64_t>(picture.height);
        allow_seconds_for(request_, request_.left - left_);
        texel_ = picture.channels * sample_bytes(picture.type);
        const ReplyPicture reply = {picture.x,
                                    picture.y,
                                    picture.display_x,
                                    picture.display_y,
                                    static_cast<uint32_t>(picture.width),
                                    static_cast<uint32_t>(picture.height),
                                    static_cast<uint32_t>(picture.display_width),
                                    static_cast<uint32_t>(picture.display_height),
                                    picture.level,
                                    picture.channels,
                                    picture.type,
                                    0};
        std::string bytes(reinterpret_cast<const char*>(&reply), sizeof reply);
        append(bytes, picture.format);
        for (uint32_t channel = 0; channel < picture.channels; ++channel) append(bytes, picture.names[channel]);
        send_part(ReplyKind::picture, bytes.data(), bytes.size());
        return true;
    }

    void attribute(const char* name, const char* type, const char* text) const {
        std::string bytes;
        append(bytes, name);
        append(bytes, type);
        append(bytes, text, largest_reply_part / 2);
        send_part(ReplyKind::attribute, bytes.data(), bytes.size());
    }

    void samples(const void* from, size_t texels) const { send_samples(from, texels, texel_); }

    void fail(const std::string& reason) const { fail_answer(memory_, reason); }

  private:
    static void append(std::string& bytes, std::string_view text, size_t most = largest_reply_id) {
        bytes += text.substr(0, most);
        bytes += '\0';
    }

    const ReadRequest& request_;
    const MemoryLimit& memory_;
    uint64_t left_;
    size_t texel_ = 0;
};

}  // namespace

void answer_stored(const std::string& path, const ReadRequest& request, const MemoryLimit& memory,
                   const OiioModule& oiio) {
    StoredAnswer answer(request, memory);
    const OiioStoredHost host = {
        &answer,
        request.left,
        [](void* self, const OiioPicture* picture) noexcept {
            return static_cast<StoredAnswer*>(self)->picture(*picture);
        },
        [](void* self, const char* name, const char* type, const char* text) noexcept {
            static_cast<const StoredAnswer*>(self)->attribute(name, type, text);
        },
        [](void* self, const void* from, size_t texels) noexcept {
            static_cast<const StoredAnswer*>(self)->samples(from, texels);
        },
        [](void* self, const char* reason) noexcept { static_cast<const StoredAnswer*>(self)->fail(reason); }};
    if (oiio.read_stored(path.c_str(), &host)) send_part(ReplyKind::end, nullptr, 0);
}

}  // namespace cistula
