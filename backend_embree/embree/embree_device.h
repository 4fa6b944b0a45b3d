// Embree's device, with its memory counted and its errors turned into Error.
#pragma once

#include <atomic>
#include <string>

#include "scene/trees/embree_handles.h"

namespace cistula {

class EmbreeDevice {
  public:
    /// Makes a device. Throws Error (device) if Embree does not accept the configuration, and as check() does.
    explicit EmbreeDevice(const std::string& config);
    EmbreeDevice(const EmbreeDevice&) = delete;
    EmbreeDevice& operator=(const EmbreeDevice&) = delete;

    RTCDevice get() const { return device_.get(); }
    size_t memory() const { return size_t(memory_.load()); }  // bytes that the device holds now

    /// Throws if anything has failed since the last call: Error (device), std::bad_alloc, or std::runtime_error for
    /// what is not Embree's own, as a thread that cannot be started. `doing` names the operation for the message.
    void check(const char* doing) const;

  private:
    std::atomic<ssize_t> memory_{0};  // declared first: the device counts in it until it is destroyed
    std::string reason_;              // in words, of the last error
    DevicePointer device_;
};

}  // namespace cistula
