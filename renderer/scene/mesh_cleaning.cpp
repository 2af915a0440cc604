#include "renderer/scene/mesh_cleaning.h"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <numeric>
#include <unordered_map>
#include <unordered_set>

namespace rapport {
namespace {

constexpr uint32_t kNone = std::numeric_limits<uint32_t>::max();

/// One round of a multiplicative hash over 64 bits (the finaliser of SplitMix64).
uint64_t mix(uint64_t hash, uint32_t word) {
    hash = (hash ^ word) * 0xbf58476d1ce4e5b9u;
    return hash ^ (hash >> 31);
}

struct ValueHash {
    template <glm::length_t N> size_t operator()(const glm::vec<N, float>& value) const {
        uint64_t hash = 0;
        for (glm::length_t i = 0; i < N; ++i)
            hash = mix(hash, std::bit_cast<uint32_t>(value[i]));
        return hash;
    }
};

/// Keeps one of each value that the index uses, in the order of first use.
template <class Value>
void merge_equal(std::vector<Value>& values, std::vector<glm::uvec3>& index) {
    std::unordered_map<Value, uint32_t, ValueHash> place;
    place.reserve(values.size());
    std::vector<Value> kept;
    kept.reserve(values.size());
    std::vector<uint32_t> renamed(values.size(), kNone);
    for (glm::uvec3& triangle : index)
        for (int c = 0; c < 3; ++c) {
            uint32_t& name = renamed[triangle[c]];
            if (name == kNone) {
                const Value value = values[triangle[c]] + 0.0f; // −0 becomes +0
                const auto [found, is_new] =
                    place.try_emplace(value, static_cast<uint32_t>(kept.size()));
                if (is_new)
                    kept.push_back(value);
                name = found->second;
            }
            triangle[c] = name;
        }
    values = std::move(kept);
}

struct TripleHash {
    size_t operator()(const std::array<uint32_t, 3>& v) const {
        return mix(mix(mix(0, v[0]), v[1]), v[2]);
    }
};

} // namespace

IndexedMesh clean(const IndexedMesh& mesh, CleaningReport* report) {
    IndexedMesh merged = mesh;
    merge_equal(merged.positions, merged.position_index);

    CleaningReport dropped;
    std::unordered_set<std::array<uint32_t, 3>, TripleHash> seen;
    seen.reserve(merged.position_index.size());
    size_t kept = 0;
    for (size_t t = 0; t < merged.position_index.size(); ++t) {
        const glm::uvec3 triangle = merged.position_index[t];
        std::array<uint32_t, 3> sorted{triangle.x, triangle.y, triangle.z};
        std::sort(sorted.begin(), sorted.end());
        if (sorted[0] == sorted[1] || sorted[1] == sorted[2]) {
            ++dropped.degenerate;
        } else if (!seen.insert(sorted).second) {
            ++dropped.repeated;
        } else {
            merged.position_index[kept] = triangle;
            if (!merged.uv_index.empty())
                merged.uv_index[kept] = merged.uv_index[t];
            if (!merged.normal_index.empty())
                merged.normal_index[kept] = merged.normal_index[t];
            ++kept;
        }
    }
    merged.position_index.resize(kept);
    merged.uv_index.resize(mesh.uv_index.empty() ? 0 : kept);
    merged.normal_index.resize(mesh.normal_index.empty() ? 0 : kept);

    merge_equal(merged.positions, merged.position_index); // points of dropped triangles go, too
    merge_equal(merged.uvs, merged.uv_index);
    merge_equal(merged.normals, merged.normal_index);
    if (report)
        *report = dropped;
    return merged;
}

std::vector<EdgeUse> edge_uses(std::span<const glm::uvec3> triangles) {
    // Sorted by the low vertex in two linear passes, then the few of each vertex among themselves.
    uint32_t vertices = 0;
    for (const glm::uvec3& t : triangles)
        vertices = std::max(vertices, std::max({t.x, t.y, t.z}) + 1);
    std::vector<size_t> first(size_t{vertices} + 1, 0);
    for (const glm::uvec3& t : triangles)
        for (int c = 0; c < 3; ++c)
            ++first[size_t{std::min(t[c], t[(c + 1) % 3])} + 1];
    std::partial_sum(first.begin(), first.end(), first.begin());
    std::vector<size_t> next(first.begin(), first.end());
    std::vector<EdgeUse> uses(3 * triangles.size());
    for (uint32_t t = 0; t < triangles.size(); ++t)
        for (uint8_t c = 0; c < 3; ++c) {
            const uint32_t a = triangles[t][c], b = triangles[t][(c + 1) % 3];
            uses[next[std::min(a, b)]++] = {std::min(a, b), std::max(a, b), t, c, a < b};
        }
    for (uint32_t v = 0; v < vertices; ++v)
        std::stable_sort(uses.begin() + static_cast<ptrdiff_t>(first[v]),
                         uses.begin() + static_cast<ptrdiff_t>(first[v + 1]),
                         [](const EdgeUse& a, const EdgeUse& b) { return a.high < b.high; });
    return uses;
}

} // namespace rapport
