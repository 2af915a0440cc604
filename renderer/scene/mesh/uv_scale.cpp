#include "renderer/scene/mesh/uv_scale.h"

#include <algorithm>
#include <cmath>

namespace rapport {

double metres_per_uv(const IndexedMesh& mesh) {
    std::vector<std::pair<double, double>> scales; // and the area that has it
    double total = 0;
    for (size_t t = 0; t < mesh.uv_index.size(); ++t) {
        const glm::uvec3 p = mesh.position_index[t], c = mesh.uv_index[t];
        const glm::dvec3 corner = mesh.positions[p.x];
        const glm::dvec2 uv = mesh.uvs[c.x];
        const glm::dvec2 a = glm::dvec2(mesh.uvs[c.y]) - uv, b = glm::dvec2(mesh.uvs[c.z]) - uv;
        const double area = glm::length(glm::cross(glm::dvec3(mesh.positions[p.y]) - corner,
                                                   glm::dvec3(mesh.positions[p.z]) - corner));
        const double uv_area = std::abs(a.x * b.y - a.y * b.x);
        if (!(area > 0 && uv_area > 0))
            continue;
        scales.emplace_back(std::sqrt(area / uv_area), area);
        total += area;
    }
    std::ranges::sort(scales);
    double below = 0;
    for (const auto& [scale, area] : scales)
        if ((below += area) >= total / 2)
            return scale;
    return 0;
}

} // namespace rapport
