#include "scene/image/stored_reader.h"

#include <new>
#include <stdexcept>

#include "scene/base/file_bytes.h"
#include "scene/image/exr.h"
#include "scene/image/reader_process.h"
#include "scene/image/stored_exr.h"
#include "scene/image/stored_reply.h"

namespace cistula {

StoredReader::StoredReader(const TextureLimits& limits) : limits_(limits), left_(limits.bytes) {}

StoredReader::~StoredReader() = default;

StoredFile StoredReader::read(const std::string& path) {
    if (regular_file_size(path) == 0) throw file_error(path, "read", std::string("it is empty; give a picture"));
    if (lower_extension(path) == ".exr" || read_file_start(path, 4) == exr_magic) return read_stored_exr(path);
    try {
        return read_in_child(path);
    } catch (const PictureRefused& refused) {
        throw file_error(path, "read", std::string(refused.what()));
    } catch (const std::bad_alloc&) {
        process_.reset();  // it may be in the middle of an answer
        throw;
    } catch (const std::runtime_error& broken) {
        process_.reset();
        throw file_error(path, "read", std::string(broken.what()));
    }
}

StoredFile StoredReader::read_in_child(const std::string& path) {
    if (!process_) process_ = std::make_unique<ReaderProcess>("pictures other than EXR");
    const auto start = ReaderProcess::Clock::now();
    const ReadRequest request = {left_,
                                 limits_.bytes,
                                 ReadKind::stored,
                                 static_cast<uint32_t>(limits_.seconds),
                                 static_cast<uint32_t>(path.size()),
                                 0};
    process_->send(&request, sizeof request);
    process_->send(path.data(), path.size());
    uint64_t bytes = 0;
    auto end = start + patience(limits_.seconds);
    const Receive receive = [&](void* to, size_t size) { process_->receive(to, size, end); };
    return receive_stored(receive, left_, [&](uint64_t more) {
        bytes += more;
        end = start + patience(seconds_for(limits_.seconds, bytes));
    });
}

}  // namespace cistula
