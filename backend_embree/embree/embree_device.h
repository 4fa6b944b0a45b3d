// Embree's device, with its memory counted and its errors turned into Error.
#pragma once

#include <atomic>
#include <string>

#include "scene/trees/embree_handles.h"

namespace cistula {

class EmbreeDevice {
  public:
    /// Makes a device. Throws Error (device) if Embree does not accept the configuration.
    explicit EmbreeDevice(const std::string& config);
    EmbreeDevice(const EmbreeDevice&) = delete;
    EmbreeDevice& operator=(const EmbreeDevice&) = delete;

    RTCDevice get() const { return device_.get(); }
    size_t memory() const { return size_t(memory_.load()); }  // bytes that the device holds now

    /// Throws Error (device) or std::bad_alloc if anything has failed since the last call; `doing` is for the message.
    void check(const char* doing) const;

  private:
    std::atomic<ssize_t> memory_{0};  // declared first: the device counts in it until it is destroyed
    DevicePointer device_;
};

}  // namespace cistula
