#include "renderer/scene/tessellation.h"

#include "renderer/scene/mesh_cleaning.h"

#include <unordered_map>

namespace rapport {
namespace {

constexpr uint32_t kNone = std::numeric_limits<uint32_t>::max();

/// The vertices inside one edge, as the first triangle on it made them.
struct Edge {
    uint32_t first = kNone; ///< nearest to the low end
    uint32_t uv_low = 0, uv_high = 0;
};

class Tessellator {
  public:
    Tessellator(const std::vector<glm::uvec3>& triangles, const std::vector<glm::uvec3>& uv_index,
                uint32_t level)
        : triangles_(triangles), uv_index_(uv_index), level_(level),
          grid_((level + 1) * (level + 1)) {
        edge_of_side_.resize(3 * triangles.size());
        for_each_edge(edge_uses(triangles), [&](std::span<const EdgeUse> uses) {
            for (const EdgeUse& use : uses)
                edge_of_side_[3 * use.triangle + use.corner] = static_cast<uint32_t>(edges_.size());
            edges_.emplace_back();
        });
    }

    Tessellation run() {
        result_.triangles.reserve(triangles_.size() * level_ * level_);
        for (triangle_ = 0; triangle_ < triangles_.size(); ++triangle_) {
            result_.first.push_back(static_cast<uint32_t>(result_.vertices.size()));
            for (uint32_t c = 0; c < 3; ++c)
                add_corner(c);
            for (uint32_t c = 0; c < 3; ++c)
                add_side(c);
            for (uint32_t t = 1; t < level_; ++t)
                for (uint32_t s = 1; s + t < level_; ++s)
                    at(s, t) = add_vertex(s, t, kNone);
            connect();
        }
        result_.first.push_back(static_cast<uint32_t>(result_.vertices.size()));
        return std::move(result_);
    }

  private:
    uint32_t& at(uint32_t s, uint32_t t) { return grid_[t * (level_ + 1) + s]; }

    uint32_t add_vertex(uint32_t s, uint32_t t, uint32_t twin) {
        const auto id = static_cast<uint32_t>(result_.vertices.size());
        result_.vertices.push_back({triangle_, static_cast<uint16_t>(s), static_cast<uint16_t>(t),
                                    twin == kNone ? id : twin});
        return id;
    }

    uint32_t uv(uint32_t corner) const {
        return uv_index_.empty() ? 0 : uv_index_[triangle_][static_cast<int>(corner)];
    }

    void add_corner(uint32_t c) {
        const uint32_t s = c == 1 ? level_ : 0, t = c == 2 ? level_ : 0;
        const uint32_t vertex = triangles_[triangle_][static_cast<int>(c)];
        const auto [corner, is_new] = corners_.try_emplace(uint64_t{vertex} << 32 | uv(c), 0);
        if (is_new) {
            const auto [twin, is_first] = first_corner_.try_emplace(vertex, kNone);
            corner->second = add_vertex(s, t, twin->second);
            if (is_first)
                twin->second = corner->second;
        }
        at(s, t) = corner->second;
    }

    void add_side(uint32_t c) {
        const uint32_t next = (c + 1) % 3;
        Edge& edge = edges_[edge_of_side_[3 * triangle_ + c]];
        const bool forward = triangles_[triangle_][static_cast<int>(c)] <
                             triangles_[triangle_][static_cast<int>(next)];
        const uint32_t uv_low = uv(forward ? c : next), uv_high = uv(forward ? next : c);
        const bool is_new = edge.first == kNone;
        const bool shared = !is_new && edge.uv_low == uv_low && edge.uv_high == uv_high;
        if (is_new)
            edge = {static_cast<uint32_t>(result_.vertices.size()), uv_low, uv_high};
        for (uint32_t k = 1; k < level_; ++k) { // from the low end to the high end
            const uint32_t along = forward ? k : level_ - k;
            const uint32_t s = c == 0 ? along : c == 1 ? level_ - along : 0;
            const uint32_t t = c == 0 ? 0 : c == 1 ? along : level_ - along;
            const uint32_t twin = edge.first + k - 1;
            at(s, t) = shared ? twin : add_vertex(s, t, is_new ? kNone : twin);
        }
    }

    void connect() {
        for (uint32_t t = 0; t < level_; ++t)
            for (uint32_t s = 0; s + t < level_; ++s) {
                result_.triangles.emplace_back(at(s, t), at(s + 1, t), at(s, t + 1));
                if (s + t + 1 < level_)
                    result_.triangles.emplace_back(at(s + 1, t), at(s + 1, t + 1), at(s, t + 1));
            }
    }

    const std::vector<glm::uvec3>& triangles_;
    const std::vector<glm::uvec3>& uv_index_;
    const uint32_t level_;
    uint32_t triangle_ = 0;
    std::vector<uint32_t> grid_;
    std::vector<uint32_t> edge_of_side_;
    std::vector<Edge> edges_;
    std::unordered_map<uint64_t, uint32_t> corners_; ///< by vertex and UV
    std::unordered_map<uint32_t, uint32_t> first_corner_;
    Tessellation result_;
};

} // namespace

Tessellation tessellate(const std::vector<glm::uvec3>& triangles,
                        const std::vector<glm::uvec3>& uv_index, int level) {
    return Tessellator(triangles, uv_index, static_cast<uint32_t>(level)).run();
}

} // namespace rapport
