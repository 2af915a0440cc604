#include "renderer/scene/mesh/t_junctions.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <unordered_set>

namespace rapport {
namespace {

constexpr double kTolerance = 1e-3; ///< of the edge's length
/// Cells that the search for one edge looks at, at most, along each axis.
constexpr int kMostCells = 64;

/// Points in a grid of cubes.
class PointGrid {
  public:
    explicit PointGrid(double cell) : cell_(cell) {}
    void add(const glm::dvec3& point, uint32_t id) { cells_[key(place(point))].push_back(id); }
    /// Calls `visit` with the points in the cells that meet the box, and perhaps with others.
    template <class Visit>
    void for_each_near(const glm::dvec3& low, const glm::dvec3& high, const Visit& visit) const {
        const glm::i64vec3 first = place(low), last = place(high);
        if (glm::any(glm::greaterThan(last - first, glm::i64vec3(kMostCells)))) {
            for (const auto& [name, ids] : cells_)
                for (const uint32_t id : ids)
                    visit(id);
            return;
        }
        for (int64_t x = first.x; x <= last.x; ++x)
            for (int64_t y = first.y; y <= last.y; ++y)
                for (int64_t z = first.z; z <= last.z; ++z)
                    if (const auto found = cells_.find(key({x, y, z})); found != cells_.end())
                        for (const uint32_t id : found->second)
                            visit(id);
    }

  private:
    glm::i64vec3 place(const glm::dvec3& point) const {
        constexpr double kFarthest = 1e15;
        return glm::i64vec3(glm::clamp(glm::floor(point / cell_), -kFarthest, kFarthest));
    }
    static uint64_t key(const glm::i64vec3& place) { // of equal places; others may share it
        return static_cast<uint64_t>(place.x) * 0x9e3779b97f4a7c15u ^
               static_cast<uint64_t>(place.y) * 0xc2b2ae3d27d4eb4fu ^
               static_cast<uint64_t>(place.z) * 0x165667b19e3779f9u;
    }
    double cell_;
    std::unordered_map<uint64_t, std::vector<uint32_t>> cells_;
};

bool lies_inside(const glm::dvec3& point, const glm::dvec3& a, const glm::dvec3& b) {
    const glm::dvec3 along = b - a;
    const double length2 = glm::dot(along, along);
    const double place = glm::dot(point - a, along) / length2;
    const glm::dvec3 off = point - (a + place * along);
    return place > kTolerance && place < 1 - kTolerance &&
           glm::dot(off, off) < kTolerance * kTolerance * length2;
}

} // namespace

size_t hold_t_junctions(ControlMesh& control) {
    const auto origin = [&](uint32_t side) { return control.cut.origin[control.vertex(side)]; };
    std::vector<uint32_t> border; // sides
    double length = 0;
    for_each_edge(control.edges, [&](std::span<const EdgeUse> edge) {
        const uint32_t side = 3 * edge[0].triangle + edge[0].corner;
        if (edge.size() != 1 || control.detached[edge[0].triangle])
            return;
        border.push_back(side);
        length += glm::distance(control.position(side), control.position(next_side(side)));
    });
    if (!(length > 0))
        return 0;
    PointGrid grid(length / static_cast<double>(border.size()));
    std::unordered_map<uint32_t, std::vector<uint32_t>> sides_from; // by uncut vertex, both ways
    for (const uint32_t side : border) {
        const uint32_t a = origin(side), b = origin(next_side(side));
        for (const uint32_t vertex : {a, b})
            if (sides_from.emplace(vertex, std::vector<uint32_t>()).second)
                grid.add(control.mesh.positions[vertex], vertex);
        sides_from[a].push_back(side);
        sides_from[b].push_back(side);
    }
    std::unordered_set<uint32_t> junctions, held;
    for (const uint32_t side : border) {
        const glm::dvec3 a = control.position(side), b = control.position(next_side(side));
        const glm::dvec3 margin(kTolerance * glm::distance(a, b));
        std::unordered_set<uint32_t> on{origin(side), origin(next_side(side))};
        grid.for_each_near(glm::min(a, b) - margin, glm::max(a, b) + margin, [&](uint32_t vertex) {
            if (lies_inside(control.mesh.positions[vertex], a, b)) {
                on.insert(vertex);
                junctions.insert(vertex);
            }
        });
        if (on.size() == 2)
            continue;
        for (const uint32_t vertex : on)
            for (const uint32_t other : sides_from[vertex])
                if (on.contains(origin(other)) && on.contains(origin(next_side(other))))
                    control.cut.straight[other / 3][static_cast<int>(other % 3)] = true;
        held.insert(on.begin(), on.end());
    }
    for (size_t v = 0; v < control.cut.origin.size(); ++v)
        if (held.contains(control.cut.origin[v]))
            control.cut.pinned[v] = 1;
    return junctions.size();
}

} // namespace rapport
