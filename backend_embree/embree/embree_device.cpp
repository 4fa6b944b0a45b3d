#include "backend_embree/embree/embree_device.h"

#include <new>
#include <stdexcept>

#include "scene/base/error.h"

namespace cistula {
namespace {

void require_none(RTCError error, const std::string& doing, const std::string& reason) {
    if (error == RTC_ERROR_NONE) return;
    if (error == RTC_ERROR_OUT_OF_MEMORY) throw std::bad_alloc();
    const std::string message =
        "Embree: " + doing + " failed with error " + std::to_string(int(error)) + (reason.empty() ? "" : ", " + reason);
    if (error == RTC_ERROR_UNKNOWN) throw std::runtime_error(message);
    throw Error(ExitCode::device, message);
}

}  // namespace

EmbreeDevice::EmbreeDevice(const std::string& config) : device_(rtcNewDevice(config.c_str())) {
    if (!device_) {
        const std::string doing = "making a device for \"" + config + "\"";
        require_none(rtcGetDeviceError(nullptr), doing, "");
        throw Error(ExitCode::device, "Embree: " + doing + " failed");
    }
    rtcSetDeviceErrorFunction(
        device_.get(),
        [](void* self, RTCError, const char* reason) {
            if (reason) static_cast<EmbreeDevice*>(self)->reason_ = reason;
        },
        this);
    rtcSetDeviceMemoryMonitorFunction(
        device_.get(),
        [](void* self, ssize_t bytes, bool) {
            static_cast<EmbreeDevice*>(self)->memory_ += bytes;
            return true;
        },
        this);
}

void EmbreeDevice::check(const char* doing) const {
    require_none(rtcGetDeviceError(device_.get()), doing, reason_);
}

}  // namespace cistula
