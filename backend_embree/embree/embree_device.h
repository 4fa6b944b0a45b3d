// Embree's device: what it allocates is counted, its errors become ours.
#pragma once

#include <atomic>
#include <string>

#include "scene/trees/embree_handles.h"

namespace cistula {

class EmbreeDevice {
  public:
    /// Throws Error (device) where Embree does not know the configuration.
    explicit EmbreeDevice(const std::string& config);
    EmbreeDevice(const EmbreeDevice&) = delete;
    EmbreeDevice& operator=(const EmbreeDevice&) = delete;

    RTCDevice get() const { return device_.get(); }
    size_t memory() const { return size_t(memory_.load()); }  // bytes that it holds now

    /// Throws Error (device) where anything has failed since the last call; `doing` says what was done.
    void check(const char* doing) const;

  private:
    std::atomic<ssize_t> memory_{0};  // first, since the device counts in it until it is gone
    DevicePointer device_;
};

}  // namespace cistula
