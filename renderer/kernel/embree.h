#pragma once

// The only place that includes Embree: version 4 where it is installed, else 3.13. What differs
// between the two is settled here, so that the sources beside it know one Embree.

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <memory>
#include <type_traits>

namespace rapport::kernel::embree {

#if RTC_VERSION_MAJOR >= 4
using Context = RTCRayQueryContext;
inline void initialise(Context& context) { rtcInitRayQueryContext(&context); }
inline void intersect(RTCScene scene, Context& context, RTCRayHit& ray) {
    RTCIntersectArguments arguments;
    rtcInitIntersectArguments(&arguments);
    arguments.context = &context;
    rtcIntersect1(scene, &ray, &arguments);
}
/// Of those that are marked by −1 in `valid`.
inline void intersect8(const int* valid, RTCScene scene, Context& context, RTCRayHit8& rays) {
    RTCIntersectArguments arguments;
    rtcInitIntersectArguments(&arguments);
    arguments.context = &context;
    arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
    rtcIntersect8(valid, scene, &rays, &arguments);
}
#else
using Context = RTCIntersectContext;
inline void initialise(Context& context) { rtcInitIntersectContext(&context); }
inline void intersect(RTCScene scene, Context& context, RTCRayHit& ray) {
    rtcIntersect1(scene, &context, &ray);
}
inline void intersect8(const int* valid, RTCScene scene, Context& context, RTCRayHit8& rays) {
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    rtcIntersect8(valid, scene, &context, &rays);
}
#endif

struct Release {
    void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
    void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
    void operator()(RTCGeometry geometry) const { rtcReleaseGeometry(geometry); }
};
using Device = std::unique_ptr<std::remove_pointer_t<RTCDevice>, Release>;
using Scene = std::unique_ptr<std::remove_pointer_t<RTCScene>, Release>;
using Geometry = std::unique_ptr<std::remove_pointer_t<RTCGeometry>, Release>;

/// A device; throws std::runtime_error where Embree refuses to run on this machine.
Device make_device();
Scene make_scene(RTCDevice device);
Geometry make_geometry(RTCDevice device, RTCGeometryType type);
/// Throws what Embree has complained of on this thread since the last call: std::bad_alloc for
/// lack of memory, else std::runtime_error.
void check(RTCDevice device);

/// A ray as Embree takes it, that has hit nothing yet. The mask is set because version 4 sees only
/// geometries that share a bit with it.
inline RTCRay make_ray(float ox, float oy, float oz, float dx, float dy, float dz, float tnear,
                       float tfar) {
    RTCRay ray;
    ray.org_x = ox;
    ray.org_y = oy;
    ray.org_z = oz;
    ray.tnear = tnear;
    ray.dir_x = dx;
    ray.dir_y = dy;
    ray.dir_z = dz;
    ray.time = 0;
    ray.tfar = tfar;
    ray.mask = ~0u;
    ray.id = 0;
    ray.flags = 0;
    return ray;
}

inline RTCRayHit make_ray_hit(const RTCRay& ray) {
    RTCRayHit result;
    result.ray = ray;
    result.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    result.hit.primID = RTC_INVALID_GEOMETRY_ID;
    result.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    return result;
}

} // namespace rapport::kernel::embree
