// Embree's errors as exceptions.
#pragma once

#include <string>

#include "scene/trees/embree_handles.h"

namespace cistula {

/// Makes a device. Throws as check_embree() does.
DevicePointer make_embree_device(const std::string& config);

/// Throws if anything has failed on this thread since the last call: std::bad_alloc, Error (device) with the name of
/// the operation, `doing`, or std::runtime_error for what is not Embree's own, as a thread that cannot be started.
void check_embree(RTCDevice device, const std::string& doing);

}  // namespace cistula
