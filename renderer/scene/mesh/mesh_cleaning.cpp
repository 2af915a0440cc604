#include "renderer/scene/mesh/mesh_cleaning.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <numeric>

namespace rapport {
namespace {

constexpr uint32_t kNone = std::numeric_limits<uint32_t>::max();

/// One round of a multiplicative hash over 64 bits (the finaliser of SplitMix64).
uint64_t mix(uint64_t hash, uint32_t word) {
    hash = (hash ^ word) * 0xbf58476d1ce4e5b9u;
    return hash ^ (hash >> 31);
}

/// Numbers of things, found by what they are: open addressing with linear probing, which for
/// millions of small things is several times as fast as a table of nodes.
class FlatIndex {
  public:
    explicit FlatIndex(size_t most) : slots_(std::bit_ceil(2 * most + 1), kNone) {}
    /// The number already there for which `is_same` holds, else `number`, which is added.
    template <class IsSame>
    uint32_t find_or_add(uint64_t hash, uint32_t number, const IsSame& is_same) {
        const size_t mask = slots_.size() - 1;
        for (size_t slot = hash & mask;; slot = (slot + 1) & mask) {
            if (slots_[slot] == kNone)
                return slots_[slot] = number;
            if (is_same(slots_[slot]))
                return slots_[slot];
        }
    }

  private:
    std::vector<uint32_t> slots_;
};

template <glm::length_t N> uint64_t hash_of(const glm::vec<N, float>& value) {
    uint64_t hash = 0;
    for (glm::length_t i = 0; i < N; ++i)
        hash = mix(hash, std::bit_cast<uint32_t>(value[i]));
    return hash;
}

/// Keeps the values that the index uses, in the order of first use. `name_of(kept, next)` says
/// under which number the value `kept[next]` goes: `next`, or that of an equal one, which then
/// stands for it.
template <class Value, class NameOf>
void renumber(std::vector<Value>& values, std::vector<glm::uvec3>& index, const NameOf& name_of) {
    std::vector<Value> kept;
    kept.reserve(values.size());
    std::vector<uint32_t> renamed(values.size(), kNone);
    for (glm::uvec3& triangle : index)
        for (int c = 0; c < 3; ++c) {
            uint32_t& name = renamed[triangle[c]];
            if (name == kNone) {
                const Value value = values[triangle[c]] + 0.0f; // −0 becomes +0
                const auto next = static_cast<uint32_t>(kept.size());
                kept.push_back(value);
                name = name_of(kept, next);
                if (name != next)
                    kept.pop_back();
            }
            triangle[c] = name;
        }
    values = std::move(kept);
}

template <class Value>
void merge_equal(std::vector<Value>& values, std::vector<glm::uvec3>& index) {
    FlatIndex known(values.size());
    renumber(values, index, [&](const std::vector<Value>& kept, uint32_t next) {
        return known.find_or_add(hash_of(kept[next]), next,
                                 [&](uint32_t other) { return kept[other] == kept[next]; });
    });
}

template <class Value>
void drop_unused(std::vector<Value>& values, std::vector<glm::uvec3>& index) {
    renumber(values, index, [](const auto&, uint32_t next) { return next; });
}

glm::uvec3 sorted(glm::uvec3 t) {
    std::sort(&t.x, &t.x + 3);
    return t;
}

} // namespace

IndexedMesh clean(const IndexedMesh& mesh, CleaningReport* report) {
    IndexedMesh merged = mesh;
    merge_equal(merged.positions, merged.position_index);

    CleaningReport dropped;
    const std::vector<glm::uvec3>& triangles = merged.position_index;
    FlatIndex seen(triangles.size());
    size_t kept = 0;
    for (size_t t = 0; t < triangles.size(); ++t) {
        const glm::uvec3 triangle = triangles[t], corners = sorted(triangle);
        if (corners.x == corners.y || corners.y == corners.z) {
            ++dropped.degenerate;
            continue;
        }
        const auto next = static_cast<uint32_t>(kept);
        const uint64_t hash = mix(mix(mix(0, corners.x), corners.y), corners.z);
        if (seen.find_or_add(hash, next, [&](uint32_t other) {
                return sorted(triangles[other]) == corners;
            }) != next) {
            ++dropped.repeated;
            continue;
        }
        merged.position_index[kept] = triangle;
        if (!merged.uv_index.empty())
            merged.uv_index[kept] = merged.uv_index[t];
        if (!merged.normal_index.empty())
            merged.normal_index[kept] = merged.normal_index[t];
        ++kept;
    }
    merged.position_index.resize(kept);
    merged.uv_index.resize(mesh.uv_index.empty() ? 0 : kept);
    merged.normal_index.resize(mesh.normal_index.empty() ? 0 : kept);

    drop_unused(merged.positions, merged.position_index);
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
