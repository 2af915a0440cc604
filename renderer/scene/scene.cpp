#include "renderer/scene/scene.h"

#include "renderer/scene/mesh/mesh_operations.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace rapport {
namespace {

template <class T>
T interpolate(const std::vector<T>& values, const glm::uvec3& t, const glm::vec2& b) {
    return (1 - b.x - b.y) * values[t.x] + b.x * values[t.y] + b.y * values[t.z];
}
template <class T> T interpolate(const std::vector<T>& values, const SurfacePoint& point) {
    return interpolate(values, point.surface->mesh->triangles[point.triangle], point.barycentric);
}

float opacity_at(const SurfacePoint& point) {
    const Print& print = point.surface->print;
    if (!print.opacity)
        return 1;
    float share = print.opacity->factor;
    if (print.picture)
        share *= print.picture->alpha(interpolate(point.surface->mesh->uvs, point));
    if (print.vertex_colors)
        share *= interpolate(point.surface->mesh->colors, point).a;
    if (print.opacity->cutoff)
        return share >= *print.opacity->cutoff ? 1 : 0;
    return share;
}

} // namespace

Scene::Scene(std::vector<Surface> surfaces, std::vector<std::shared_ptr<Light>> lights,
             Camera camera, RenderSettings settings)
    : camera(std::move(camera)), settings(std::move(settings)), surfaces_(std::move(surfaces)),
      lights_(std::move(lights)) {
    kernel::Scene kernel;
    for (const Surface& surface : surfaces_)
        kernel.add_triangles(surface.mesh->positions, surface.mesh->triangles);
    kernel.commit();
    const auto [low, high] = kernel.bounds();
    kernel_ = std::make_shared<const kernel::Scene>(std::move(kernel));
    const bool empty = !(low.x <= high.x);
    for (const auto& light : lights_)
        light->prepare(empty ? glm::vec3(0) : 0.5f * (low + high),
                       empty ? 1.0f : std::max(0.5f * glm::length(high - low), 1e-6f));
    light_up();
}

Scene::Scene(const Scene& scene, std::vector<Surface> surfaces,
             std::vector<std::shared_ptr<Light>> lights)
    : camera(scene.camera), settings(scene.settings), surfaces_(std::move(surfaces)),
      lights_(std::move(lights)), kernel_(scene.kernel_) {
    light_up();
}

/// Makes the surfaces shine that do, and works out how lights are chosen.
void Scene::light_up() {
    for (Surface& surface : surfaces_)
        surface.area_light = surface.emission == Rgb(0)
                                 ? nullptr
                                 : std::make_shared<const AreaLight>(
                                       *surface.mesh, surface.emission, surface.two_sided_emission);
    std::vector<const Light*> all;
    for (const auto& light : lights_)
        all.push_back(light.get());
    for (const Surface& surface : surfaces_)
        if (surface.area_light)
            all.push_back(surface.area_light.get());
    double total = 0;
    size_t shining = 0;
    for (const Light* light : all) {
        total += light->power();
        shining += light->power() > 0;
    }
    for (size_t i = 0; i < all.size(); ++i) {
        LightChoice choice{all[i], 0};
        if (all[i]->power() > 0) {
            choice.probability =
                static_cast<float>(0.5 * (1.0 / shining + all[i]->power() / total));
            choices_.push_back(choice);
            probability_[all[i]] = choice.probability;
        }
        if (i < lights_.size())
            distant_lights_.push_back(choice);
    }
}

Frame Scene::shading_frame(const Surface& surface, const kernel::Hit& hit) const {
    const TriangleMesh& mesh = *surface.mesh;
    const glm::uvec3 t = mesh.triangles[hit.primitive];
    glm::vec3 z = hit.geometric_normal;
    if (!mesh.normals.empty()) {
        const glm::vec3 normal = interpolate(mesh.normals, t, {hit.u, hit.v});
        if (const float length = glm::length(normal); length > 0)
            z = normal / length;
    }
    glm::vec3 warp(0);
    if (!mesh.warp.empty())
        warp = interpolate(mesh.warp, t, {hit.u, hit.v});
    else if (!mesh.uvs.empty())
        warp = triangle_warp(mesh, hit.primitive);
    const glm::vec3 y = warp - glm::dot(warp, z) * z;
    const float length2 = glm::dot(y, y);
    // A warp along the normal, or none, gives no direction.
    if (!(length2 > 1e-12f * glm::dot(warp, warp)) ||
        !(length2 < std::numeric_limits<float>::infinity()))
        return Frame::about(z);
    Frame frame;
    frame.z = z;
    frame.y = y / std::sqrt(length2);
    frame.x = glm::cross(frame.y, frame.z);
    return frame;
}

std::optional<SurfacePoint> Scene::intersect(const kernel::Ray& ray) const {
    return past_holes(ray, kernel_->intersect(ray));
}

kernel::Packet<std::optional<SurfacePoint>>
Scene::intersect(std::span<const kernel::Ray> rays) const {
    const kernel::Packet<std::optional<kernel::Hit>> hits = kernel_->intersect(rays);
    kernel::Packet<std::optional<SurfacePoint>> points;
    for (size_t i = 0; i < rays.size(); ++i)
        points[i] = past_holes(rays[i], hits[i]);
    return points;
}

/// What a ray meets that met `hit` first.
std::optional<SurfacePoint> Scene::past_holes(const kernel::Ray& ray,
                                              const std::optional<kernel::Hit>& hit) const {
    if (!hit)
        return std::nullopt;
    SurfacePoint point = surface_point(*hit);
    kernel::Ray rest = ray;
    float gone = 0;
    for (int layer = 0; layer < kMaxLayers && point.opacity == 0; ++layer) {
        const glm::vec3 origin = offset_origin(point, ray.dir);
        const float step = glm::dot(origin - rest.org, ray.dir);
        rest = {origin, ray.dir, 0, rest.tfar - step};
        gone += step;
        const auto next = kernel_->intersect(rest);
        if (!next)
            return std::nullopt;
        point = surface_point(*next);
        point.distance += gone;
    }
    return point;
}

SurfacePoint Scene::surface_point(const kernel::Hit& hit) const {
    const Surface& surface = surfaces_[hit.geometry];
    const TriangleMesh& mesh = *surface.mesh;
    const glm::uvec3 t = mesh.triangles[hit.primitive];
    const glm::vec3 a = mesh.positions[t.x], b = mesh.positions[t.y], c = mesh.positions[t.z];
    SurfacePoint point;
    point.position = (1 - hit.u - hit.v) * a + hit.u * b + hit.v * c;
    point.geometric_normal = hit.geometric_normal;
    point.frame = shading_frame(surface, hit);
    point.surface = &surface;
    point.triangle = hit.primitive;
    point.barycentric = {hit.u, hit.v};
    point.distance = hit.t;
    point.reach = std::max({largest_coordinate(a), largest_coordinate(b), largest_coordinate(c)});
    point.opacity = opacity_at(point);
    return point;
}

Rgb SurfacePoint::reflectance() const {
    const Print& print = surface->print;
    Rgb share(1);
    if (print.picture)
        share = (*print.picture)(interpolate(surface->mesh->uvs, *this));
    if (print.vertex_colors)
        share *= Rgb(interpolate(surface->mesh->colors, *this));
    return share;
}

Frame SurfacePoint::frame_towards(const glm::vec3& eye) const {
    if (glm::dot(eye, frame.z) * glm::dot(eye, geometric_normal) > 0)
        return frame;
    const glm::vec3 z = geometric_normal;
    const glm::vec3 y = frame.y - glm::dot(frame.y, z) * z;
    const float length = glm::length(y);
    if (!(length > 1e-6f))
        return Frame::about(z);
    Frame upright;
    upright.z = z;
    upright.y = y / length;
    upright.x = glm::cross(upright.y, upright.z);
    return upright;
}

Rgb Scene::transmittance(const glm::vec3& from, const glm::vec3& direction, float distance,
                         const Light& light) const {
    Rgb passed(1);
    kernel::Ray ray{from, direction, 0, distance};
    for (int layer = 0; layer < kMaxLayers; ++layer) {
        const std::optional<SurfacePoint> point = intersect(ray);
        if (!point)
            return passed;
        if (point->surface->area_light.get() == &light &&
            ray.tfar - point->distance < 1e-4f * distance)
            return passed;
        if (point->surface->fibres) {
            const auto passage = point->surface->fibres->pass(point->position, direction);
            if (!passage)
                return Rgb(0);
            ray.org = offset_origin(*point, *passage);
            ray.tfar = distance - glm::dot(ray.org - from, direction);
            continue;
        }
        passed *= 1 - point->opacity +
                  point->opacity * point->surface->material->unscattered(
                                       point->frame_towards(-direction).to_local(-direction));
        if (passed == Rgb(0))
            return passed;
        ray.org = offset_origin(*point, direction);
        ray.tfar = distance - glm::dot(ray.org - from, direction);
    }
    return Rgb(0);
}

std::optional<Scene::LightChoice> Scene::choose_light(float u) const {
    if (choices_.empty())
        return std::nullopt;
    for (const LightChoice& choice : choices_) {
        if (u < choice.probability)
            return choice;
        u -= choice.probability;
    }
    return choices_.back(); // what rounding leaves of [0, 1)
}

float Scene::choice_probability(const Light& light) const {
    const auto found = probability_.find(&light);
    return found == probability_.end() ? 0 : found->second;
}

float largest_coordinate(const glm::vec3& place) {
    return std::max({std::abs(place.x), std::abs(place.y), std::abs(place.z)});
}

glm::vec3 offset_origin(const SurfacePoint& point, const glm::vec3& direction) {
    const float distance = 16 * std::numeric_limits<float>::epsilon() * point.reach;
    return point.position + std::copysign(distance, glm::dot(direction, point.geometric_normal)) *
                                point.geometric_normal;
}

glm::vec3 offset_origin(const SurfacePoint& entry, const PlacedFibres::Passage& passage) {
    SurfacePoint exit = entry;
    exit.position = passage.position;
    exit.geometric_normal = passage.normal;
    exit.reach = std::max(entry.reach, largest_coordinate(passage.position));
    return offset_origin(exit, passage.direction);
}

} // namespace rapport
