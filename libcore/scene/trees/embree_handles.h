// Embree's headers (version 3 or 4) and owning handles to its objects.
#pragma once

#include <memory>

#if defined(CISTULA_EMBREE_MAJOR) && CISTULA_EMBREE_MAJOR >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
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

}  // namespace cistula
