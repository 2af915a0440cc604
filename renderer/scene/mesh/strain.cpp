#include "renderer/scene/mesh/strain.h"

#include <algorithm>
#include <cmath>

namespace rapport {
namespace {

constexpr size_t kTriangles = 10'000;

struct Weighed {
    double value, area;
};

Strain::Range middle_of(std::vector<Weighed> values) {
    std::ranges::sort(values, {}, &Weighed::value);
    double total = 0, below = 0;
    for (const Weighed& v : values)
        total += v.area;
    Strain::Range range{values.front().value, values.back().value};
    for (const Weighed& v : values) {
        if (below <= 0.05 * total)
            range.low = v.value;
        if (below <= 0.95 * total)
            range.high = v.value;
        below += v.area;
    }
    return range;
}

} // namespace

Strain strain(const TriangleMesh& mesh, double metres_per_uv) {
    std::vector<Weighed> weft, warp, shear;
    const size_t step = mesh.triangles.size() / kTriangles + 1;
    for (size_t i = 0; i < mesh.triangles.size(); i += step) {
        const glm::uvec3 t = mesh.triangles[i];
        const auto mean = [&](const std::vector<glm::vec3>& values) {
            return glm::dvec3(values[t.x] + values[t.y] + values[t.z]) / 3.0;
        };
        const glm::dvec3 u = mean(mesh.weft), v = mean(mesh.warp);
        const double length_u = glm::length(u), length_v = glm::length(v);
        const double area = glm::length(glm::cross(mesh.positions[t.y] - mesh.positions[t.x],
                                                   mesh.positions[t.z] - mesh.positions[t.x]));
        if (!(length_u > 0 && length_v > 0 && area > 0))
            continue;
        weft.push_back({length_u / metres_per_uv, area});
        warp.push_back({length_v / metres_per_uv, area});
        shear.push_back(
            {std::asin(std::clamp(glm::dot(u, v) / (length_u * length_v), -1.0, 1.0)), area});
    }
    if (weft.empty())
        return {{1, 1}, {1, 1}, {0, 0}};
    return {middle_of(std::move(weft)), middle_of(std::move(warp)), middle_of(std::move(shear))};
}

} // namespace rapport
