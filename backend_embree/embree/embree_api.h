// A common interface to Embree 3 and 4, which differ in how a query passes its context.
#pragma once

#include "scene/trees/embree_handles.h"

namespace cistula {

#if CISTULA_EMBREE_MAJOR >= 4
using EmbreeContext = RTCRayQueryContext;
inline void embree_init(EmbreeContext& context) {
    rtcInitRayQueryContext(&context);
}
inline void embree_intersect(RTCScene scene, EmbreeContext& context, RTCRayHit& rayhit) {
    RTCIntersectArguments arguments;
    rtcInitIntersectArguments(&arguments);
    arguments.context = &context;
    rtcIntersect1(scene, &rayhit, &arguments);
}
inline void embree_occluded(RTCScene scene, EmbreeContext& context, RTCRay& ray) {
    RTCOccludedArguments arguments;
    rtcInitOccludedArguments(&arguments);
    arguments.context = &context;
    rtcOccluded1(scene, &ray, &arguments);
}
#else
using EmbreeContext = RTCIntersectContext;
inline void embree_init(EmbreeContext& context) {
    rtcInitIntersectContext(&context);
}
inline void embree_intersect(RTCScene scene, EmbreeContext& context, RTCRayHit& rayhit) {
    rtcIntersect1(scene, &context, &rayhit);
}
inline void embree_occluded(RTCScene scene, EmbreeContext& context, RTCRay& ray) {
    rtcOccluded1(scene, &context, &ray);
}
#endif

}  // namespace cistula
