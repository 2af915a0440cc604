#include "renderer/scene/light/area_light.h"

#include "renderer/core/warp.h"

#include <algorithm>
#include <limits>

namespace rapport {

AreaLight::AreaLight(const TriangleMesh& mesh, const Rgb& radiance, bool two_sided)
    : radiance_(radiance), two_sided_(two_sided) {
    std::vector<float> areas;
    for (const glm::uvec3& t : mesh.triangles) {
        const glm::vec3 corner = mesh.positions[t.x];
        const glm::vec3 edge1 = mesh.positions[t.y] - corner, edge2 = mesh.positions[t.z] - corner;
        const glm::vec3 cross = glm::cross(edge1, edge2);
        const float length = glm::length(cross);
        if (!(length > 0))
            continue;
        triangles_.push_back({corner, edge1, edge2, cross / length});
        areas.push_back(length / 2);
    }
    if (areas.empty())
        return;
    by_area_.emplace(areas);
    area_ = static_cast<float>(by_area_->total());
}

std::optional<LightSample> AreaLight::sample(const glm::vec3& from, const glm::vec2& u) const {
    if (!by_area_)
        return std::nullopt;
    // The place within the chosen triangle's share of [0, 1) is uniform again and serves as the
    // triangle's own first number.
    const auto choice = by_area_->sample(u.x);
    const double place = choice.x * static_cast<double>(triangles_.size());
    const size_t index = std::min(static_cast<size_t>(place), triangles_.size() - 1);
    const Triangle& triangle = triangles_[index];
    const glm::vec3 weight =
        square_to_triangle(glm::vec2(static_cast<float>(place - static_cast<double>(index)), u.y));
    const glm::vec3 point = triangle.corner + weight.y * triangle.edge1 + weight.z * triangle.edge2;
    const glm::vec3 offset = point - from;
    const float distance = glm::length(offset);
    const float density = pdf(offset, triangle.normal);
    if (!(distance > 0) || !(density < std::numeric_limits<float>::infinity()))
        return std::nullopt;
    const glm::vec3 direction = offset / distance;
    const Rgb radiance = emitted(triangle.normal, -direction);
    if (radiance == Rgb(0))
        return std::nullopt;
    return LightSample{direction, distance, radiance, density, false};
}

float AreaLight::power() const {
    return static_cast<float>(kPi) * area_ * luminance(radiance_) * (two_sided_ ? 2.0f : 1.0f);
}

Rgb AreaLight::emitted(const glm::vec3& normal, const glm::vec3& direction) const {
    return two_sided_ || glm::dot(normal, direction) > 0 ? radiance_ : Rgb(0);
}

float AreaLight::pdf(const glm::vec3& offset, const glm::vec3& normal) const {
    // distance² / (area · |cosθ|), with cosθ = offset·normal / distance
    const float distance2 = glm::dot(offset, offset);
    const float projected = std::abs(glm::dot(offset, normal));
    return distance2 * std::sqrt(distance2) / (area_ * projected);
}

} // namespace rapport
