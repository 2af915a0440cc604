#include "renderer/kernel/scene.h"

#include "renderer/kernel/embree.h"

#include <algorithm>
#include <cstring>
#include <stdexcept>

namespace rapport::kernel {
namespace {

/// Not if it is not a number.
bool within(float bound, const glm::vec3& v) {
    return std::abs(v.x) <= bound && std::abs(v.y) <= bound && std::abs(v.z) <= bound;
}

/// What Embree may be asked: it aborts the process on NaN, on far origins and on negative tnear.
bool usable(const Ray& ray) {
    return within(1e18f, ray.org) && within(std::numeric_limits<float>::max(), ray.dir) &&
           !std::isnan(ray.tnear) && std::max(ray.tnear, 0.0f) <= ray.tfar;
}

} // namespace

struct Scene::Implementation {
    embree::Device device = embree::make_device();
    embree::Scene scene = embree::make_scene(device.get());
    glm::vec3 low{std::numeric_limits<float>::infinity()};
    glm::vec3 high{-std::numeric_limits<float>::infinity()};
};

Scene::Scene() : implementation_(std::make_unique<Implementation>()) {
    rtcSetSceneFlags(implementation_->scene.get(), RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(implementation_->scene.get(), RTC_BUILD_QUALITY_HIGH);
}
Scene::~Scene() = default;
Scene::Scene(Scene&&) noexcept = default;
Scene& Scene::operator=(Scene&&) noexcept = default;

uint32_t Scene::add_triangles(std::span<const glm::vec3> positions,
                              std::span<const glm::uvec3> triangles) {
    for (const glm::uvec3& t : triangles)
        if (std::max({t.x, t.y, t.z}) >= positions.size())
            throw std::invalid_argument("a triangle names a vertex that the mesh does not have");
    Implementation& self = *implementation_;
    const embree::Geometry geometry =
        embree::make_geometry(self.device.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
    if (!triangles.empty()) {
        void* vertices =
            rtcSetNewGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                    sizeof(glm::vec3), positions.size());
        void* indices =
            rtcSetNewGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                    sizeof(glm::uvec3), triangles.size());
        embree::check(self.device.get());
        std::memcpy(vertices, positions.data(), positions.size_bytes());
        std::memcpy(indices, triangles.data(), triangles.size_bytes());
    }
    rtcCommitGeometry(geometry.get());
    const uint32_t number = rtcAttachGeometry(self.scene.get(), geometry.get());
    embree::check(self.device.get());
    for (const glm::vec3& p : positions) {
        self.low = glm::min(self.low, p);
        self.high = glm::max(self.high, p);
    }
    return number;
}

void Scene::commit() {
    rtcCommitScene(implementation_->scene.get());
    embree::check(implementation_->device.get());
}

std::optional<Hit> Scene::intersect(const Ray& ray) const {
    if (!usable(ray))
        return std::nullopt;
    embree::Context context;
    embree::initialise(context);
    RTCRayHit query =
        embree::make_ray_hit(embree::make_ray(ray.org.x, ray.org.y, ray.org.z, ray.dir.x, ray.dir.y,
                                              ray.dir.z, std::max(ray.tnear, 0.0f), ray.tfar));
    embree::intersect(implementation_->scene.get(), context, query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID)
        return std::nullopt;
    return Hit{query.ray.tfar,
               query.hit.geomID,
               query.hit.primID,
               query.hit.u,
               query.hit.v,
               glm::normalize(glm::vec3(query.hit.Ng_x, query.hit.Ng_y, query.hit.Ng_z))};
}

Packet<std::optional<Hit>> Scene::intersect(std::span<const Ray> rays) const {
    alignas(32) Packet<int> asked{};
    RTCRayHit8 query;
    for (size_t i = 0; i < rays.size(); ++i) {
        const Ray& ray = rays[i];
        asked[i] = usable(ray) ? -1 : 0;
        query.ray.org_x[i] = ray.org.x;
        query.ray.org_y[i] = ray.org.y;
        query.ray.org_z[i] = ray.org.z;
        query.ray.tnear[i] = std::max(ray.tnear, 0.0f);
        query.ray.dir_x[i] = ray.dir.x;
        query.ray.dir_y[i] = ray.dir.y;
        query.ray.dir_z[i] = ray.dir.z;
        query.ray.time[i] = 0;
        query.ray.tfar[i] = ray.tfar;
        query.ray.mask[i] = ~0u;
        query.ray.id[i] = query.ray.flags[i] = 0;
        query.hit.geomID[i] = query.hit.primID[i] = query.hit.instID[0][i] =
            RTC_INVALID_GEOMETRY_ID;
    }
    embree::Context context;
    embree::initialise(context);
    embree::intersect8(asked.data(), implementation_->scene.get(), context, query);
    Packet<std::optional<Hit>> hits;
    for (size_t i = 0; i < rays.size(); ++i)
        if (asked[i] && query.hit.geomID[i] != RTC_INVALID_GEOMETRY_ID)
            hits[i] = Hit{
                query.ray.tfar[i],
                query.hit.geomID[i],
                query.hit.primID[i],
                query.hit.u[i],
                query.hit.v[i],
                glm::normalize(glm::vec3(query.hit.Ng_x[i], query.hit.Ng_y[i], query.hit.Ng_z[i]))};
    return hits;
}

std::pair<glm::vec3, glm::vec3> Scene::bounds() const {
    return {implementation_->low, implementation_->high};
}

} // namespace rapport::kernel
