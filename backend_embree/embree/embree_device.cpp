#include "backend_embree/embree/embree_device.h"

#include "scene/trees/embree_handles.h"

namespace cistula {

EmbreeDevice::EmbreeDevice(const std::string& config) : device_(make_embree_device(config)) {
    rtcSetDeviceMemoryMonitorFunction(
        device_.get(),
        [](void* self, ssize_t bytes, bool) {
            static_cast<EmbreeDevice*>(self)->memory_ += bytes;
            return true;
        },
        this);
}

void EmbreeDevice::check(const char* doing) const {
    check_embree(device_.get(), doing);
}

}  // namespace cistula
