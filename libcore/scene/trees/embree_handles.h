// Embree's headers (version 3 or 4) and owning handles to its objects.
#pragma once

#include <memory>

#if defined(CISTULA_EMBREE_MAJOR) && CISTULA_EMBREE_MAJOR >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#include <string>
#endif

namespace cistula {

struct ReleaseEmbree {
    void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
    void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
    void operator()(RTCGeometry geometry) const { rtcReleaseGeometry(geometry); }
    void operator()(RTCBVH bvh) const { rtcReleaseBVH(bvh); }
};
using DevicePointer = std::unique_ptr<RTCDeviceTy, ReleaseEmbree>;
using ScenePointer = std::unique_ptr<RTCSceneTy, ReleaseEmbree>;
using GeometryPointer = std::unique_ptr<RTCGeometryTy, ReleaseEmbree>;
using BvhPointer = std::unique_ptr<RTCBVHTy, ReleaseEmbree>;

/// Makes a device. Throws as check_embree() does.
DevicePointer make_embree_device(const std::string& config);

/// Throws if anything has failed on this thread since the last call: std::bad_alloc, Error (device) with the name of
/// the operation, `doing`, or std::runtime_error for what is not Embree's own, as a thread that cannot be started.
void check_embree(RTCDevice device, const std::string& doing);

}  // namespace cistula
