#include "scene/trees/embree_handles.h"

#include <new>
#include <stdexcept>

#include "base/error.h"

namespace cistula {
namespace {

thread_local std::string last_reason;  // of Embree's last error on this thread, in words

}  // namespace

DevicePointer make_embree_device(const std::string& config) {
    DevicePointer device(rtcNewDevice(config.c_str()));
    if (!device) {
        const std::string doing = "making a device for \"" + config + "\"";
        check_embree(nullptr, doing);
        throw Error(ErrorKind::device, "Embree: " + doing + " failed");
    }
    rtcSetDeviceErrorFunction(
        device.get(), [](void*, RTCError, const char* reason) { last_reason = reason ? reason : ""; }, nullptr);
    return device;
}

void check_embree(RTCDevice device, const std::string& doing) {
    const RTCError error = rtcGetDeviceError(device);
    if (error == RTC_ERROR_NONE) return;
    if (error == RTC_ERROR_OUT_OF_MEMORY) throw std::bad_alloc();
    const std::string message =
        "Embree: " + doing + " failed with error " + std::to_string(int(error)) + ": " + last_reason;
    if (error == RTC_ERROR_UNKNOWN) throw std::runtime_error(message);
    throw Error(ErrorKind::device, message);
}

}  // namespace cistula
