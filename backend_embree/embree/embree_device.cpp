#include "backend_embree/embree/embree_device.h"

#include <new>
#include <stdexcept>

#include "scene/base/error.h"

namespace cistula {
namespace {

thread_local std::string last_reason;  // of Embree's last error on this thread, in words

/// Throws if there is an error; `doing` names the operation for the message. Errors that are not Embree's own, as of a
/// thread that cannot be started, are std::runtime_error.
void require_none(RTCError error, const std::string& doing) {
    if (error == RTC_ERROR_NONE) return;
    if (error == RTC_ERROR_OUT_OF_MEMORY) throw std::bad_alloc();
    const std::string message =
        "Embree: " + doing + " failed with error " + std::to_string(int(error)) + ": " + last_reason;
    if (error == RTC_ERROR_UNKNOWN) throw std::runtime_error(message);
    throw Error(ExitCode::device, message);
}

}  // namespace

EmbreeDevice::EmbreeDevice(const std::string& config) : device_(rtcNewDevice(config.c_str())) {
    if (!device_) {
        const std::string doing = "making a device for \"" + config + "\"";
        require_none(rtcGetDeviceError(nullptr), doing);
        throw Error(ExitCode::device, "Embree: " + doing + " failed");
    }
    rtcSetDeviceErrorFunction(
        device_.get(), [](void*, RTCError, const char* reason) { last_reason = reason ? reason : ""; }, nullptr);
    rtcSetDeviceMemoryMonitorFunction(
        device_.get(),
        [](void* self, ssize_t bytes, bool) {
            static_cast<EmbreeDevice*>(self)->memory_ += bytes;
            return true;
        },
        this);
}

void EmbreeDevice::check(const char* doing) const {
    require_none(rtcGetDeviceError(device_.get()), doing);
}

}  // namespace cistula
