#include "renderer/scene/mesh/tessellation.h"

#include "renderer/scene/mesh/face_pattern.h"

#include <algorithm>

namespace rapport {
namespace {

constexpr uint32_t kNone = std::numeric_limits<uint32_t>::max();

/// The vertices inside one edge, as the first face on it made them.
struct Edge {
    uint32_t first = kNone;     ///< nearest to the low end
    uint64_t low = 0, high = 0; ///< what its ends are given
    uint16_t rate = 1;
};

/// A vertex that was made for a corner; those of one vertex of the control mesh are chained.
struct CornerVertex {
    uint64_t given;
    uint32_t smooth_group, id;
    uint32_t previous;
};

class Tessellator {
  public:
    Tessellator(const ControlMesh& control, const SideRates& rates)
        : control_(control), edge_of_side_(3 * control.cut.triangles.size()),
          last_corner_(control.cut.origin.size(), kNone) {
        for_each_edge(control.edges, [&](std::span<const EdgeUse> uses) {
            for (const EdgeUse& use : uses)
                edge_of_side_[3 * use.triangle + use.corner] = static_cast<uint32_t>(edges_.size());
            edges_.emplace_back().rate = rates[3 * uses[0].triangle + uses[0].corner];
        });
    }

    std::optional<Tessellation> run(size_t max_triangles) {
        for (face_ = 0; face_ < control_.faces.size(); ++face_) {
            begin_face();
            const Face& face = control_.faces[face_];
            // Before the pattern is made: its triangles are about as many at most.
            const size_t most = square(size_t{finest_rate(face)});
            if (result_.triangles.size() + most > max_triangles)
                return std::nullopt;
            add_face(face);
        }
        begin_face();
        return std::move(result_);
    }

  private:
    void begin_face() {
        result_.first.push_back(static_cast<uint32_t>(result_.vertices.size()));
        result_.first_triangle.push_back(static_cast<uint32_t>(result_.triangles.size()));
    }

    uint16_t finest_rate(const Face& face) const {
        uint16_t finest = 1;
        for (uint32_t i = 0; i < face.size; ++i)
            finest = std::max(finest, edges_[edge_of_side_[face.side[i]]].rate);
        return finest;
    }

    const FacePattern& pattern(const Face& face) {
        FacePatterns::Rates rates{};
        for (uint32_t i = 0; i < face.size; ++i)
            rates[i] = edges_[edge_of_side_[face.side[i]]].rate;
        return patterns_.get(control_.kind(face), rates);
    }

    void add_face(const Face& face) {
        const FacePattern& cut = pattern(face);
        ids_.resize(cut.points.size());
        size_t at = 0;
        for (uint32_t i = 0; i < face.size; ++i) {
            ids_[at] = corner(face.side[i], cut.points[at]);
            at = add_side(face.side[i], cut, at + 1);
        }
        for (; at < cut.points.size(); ++at)
            ids_[at] = add_vertex({.parameter = cut.points[at]});
        for (const glm::uvec3& t : cut.triangles)
            result_.triangles.emplace_back(ids_[t.x], ids_[t.y], ids_[t.z]);
    }

    /// A vertex that has its own position and normal if these are `kNone`.
    uint32_t add_vertex(Tessellation::Vertex vertex, uint32_t place = kNone,
                        uint32_t normal = kNone) {
        const auto id = static_cast<uint32_t>(result_.vertices.size());
        vertex.face = face_;
        vertex.place = place == kNone ? id : place;
        vertex.normal = normal == kNone ? id : normal;
        result_.vertices.push_back(vertex);
        return id;
    }

    /// UV and colour of a corner, in one number.
    uint64_t given(uint32_t side) const {
        return uint64_t{control_.color(side)} << 32 | control_.uv(side);
    }

    uint32_t corner(uint32_t side, const glm::vec2& parameter) {
        const uint32_t group = control_.smooth_group[side];
        const uint64_t values = given(side);
        uint32_t& last = last_corner_[control_.vertex(side)];
        uint32_t place = kNone, normal = kNone;
        for (uint32_t c = last; c != kNone; c = corners_[c].previous) {
            const CornerVertex& other = corners_[c];
            if (other.smooth_group == group && other.given == values)
                return other.id;
            place = result_.vertices[other.id].place;
            if (other.smooth_group == group)
                normal = result_.vertices[other.id].normal;
        }
        const uint32_t id = add_vertex({.side = side, .parameter = parameter}, place, normal);
        corners_.push_back({values, group, id, last});
        last = static_cast<uint32_t>(corners_.size() - 1);
        return id;
    }

    /// The vertices inside a side, whose points in the pattern begin at `at`; returns their end.
    size_t add_side(uint32_t side, const FacePattern& cut, size_t at) {
        Edge& edge = edges_[edge_of_side_[side]];
        const uint32_t next = next_side(side), rate = edge.rate;
        const bool forward = control_.vertex(side) < control_.vertex(next);
        const uint64_t low = given(forward ? side : next), high = given(forward ? next : side);
        const bool is_new = edge.first == kNone, crease = control_.crease[side] != 0;
        const bool shared = !is_new && !crease && edge.low == low && edge.high == high;
        if (is_new) {
            edge.first = static_cast<uint32_t>(result_.vertices.size());
            edge.low = low, edge.high = high;
        }
        for (uint32_t along = 1; along < rate; ++along) { // from the low end to the high end
            const uint32_t step = forward ? along : rate - along;
            const uint32_t twin = is_new ? kNone : edge.first + along - 1;
            const size_t point = at + step - 1;
            ids_[point] = shared ? twin
                                 : add_vertex({.side = side,
                                               .step = static_cast<uint16_t>(step),
                                               .rate = static_cast<uint16_t>(rate),
                                               .parameter = cut.points[point]},
                                              twin, crease ? kNone : twin);
        }
        return at + rate - 1;
    }

    const ControlMesh& control_;
    std::vector<uint32_t> edge_of_side_;
    std::vector<Edge> edges_;
    std::vector<uint32_t> last_corner_; ///< per vertex of the control mesh
    std::vector<CornerVertex> corners_;
    FacePatterns patterns_;
    uint32_t face_ = 0;
    std::vector<uint32_t> ids_; ///< of the points of the face's pattern
    Tessellation result_;
};

} // namespace

uint16_t pieces_of(const ControlMesh& control, std::span<const EdgeUse> edge,
                   const EdgeRate& rate) {
    // Pieces of an edge that was cut must be cut alike: the order is that of the uncut one.
    uint32_t a = control.cut.origin[edge[0].low], b = control.cut.origin[edge[0].high];
    if (a > b)
        std::swap(a, b);
    return static_cast<uint16_t>(rate(control.mesh.positions[a], control.mesh.positions[b]));
}

SideRates side_rates(const ControlMesh& control, const EdgeRate& rate) {
    SideRates rates(3 * control.cut.triangles.size());
    for_each_edge(control.edges, [&](std::span<const EdgeUse> edge) {
        const uint16_t pieces = pieces_of(control, edge, rate);
        for (const EdgeUse& use : edge)
            rates[3 * use.triangle + use.corner] = pieces;
    });
    return rates;
}

std::optional<Tessellation> tessellate(const ControlMesh& control, const SideRates& rates,
                                       size_t max_triangles) {
    return Tessellator(control, rates).run(max_triangles);
}

} // namespace rapport
