#include "backend_embree/embree/embree_device.h"

#include "scene/base/error.h"

namespace cistula {

EmbreeDevice::EmbreeDevice(const std::string& config) : device_(rtcNewDevice(config.c_str())) {
    if (!device_) throw Error(ExitCode::device, "Embree: no device for \"" + config + "\"");
    rtcSetDeviceMemoryMonitorFunction(
        device_.get(),
        [](void* self, ssize_t bytes, bool) {
            static_cast<EmbreeDevice*>(self)->memory_ += bytes;
            return true;
        },
        this);
}

void EmbreeDevice::check(const char* doing) const {
    if (const RTCError error = rtcGetDeviceError(device_.get()); error != RTC_ERROR_NONE)
        throw Error(ExitCode::device,
                    std::string("Embree: ") + doing + " failed with error " + std::to_string(int(error)));
}

}  // namespace cistula
