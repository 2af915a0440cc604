#include "renderer/scene/mesh/mesh_cleaning.h"

#include "renderer/core/parallel.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <numeric>
#include <utility>

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

template <glm::length_t N> uint64_t hash_of(const glm::vec<N, float>& value, uint64_t hash) {
    for (glm::length_t i = 0; i < N; ++i)
        hash = mix(hash, std::bit_cast<uint32_t>(value[i]));
    return hash;
}

/// Renumbers what an index points to, `count` things, in the order of first use. `name_of(old,
/// next)` says under which number `old` goes: `next`, or that of an equal one, which then stands
/// for it. Returns the old numbers of those that are kept.
template <class NameOf>
std::vector<uint32_t> renumber(size_t count, std::vector<glm::uvec3>& index,
                               const NameOf& name_of) {
    std::vector<uint32_t> kept, renamed(count, kNone);
    kept.reserve(count);
    for (glm::uvec3& triangle : index)
        for (int c = 0; c < 3; ++c) {
            uint32_t& name = renamed[triangle[c]];
            if (name == kNone) {
                const auto next = static_cast<uint32_t>(kept.size());
                kept.push_back(triangle[c]);
                name = name_of(kept, next);
                if (name != next)
                    kept.pop_back();
            }
            triangle[c] = name;
        }
    return kept;
}

template <class Value> void keep(std::vector<Value>& values, const std::vector<uint32_t>& kept) {
    std::vector<Value> result;
    result.reserve(kept.size());
    for (const uint32_t old : kept)
        result.push_back(values[old]);
    values = std::move(result);
}

/// Merges what has equal values in all of `values`, arrays of one length.
template <class... Values> void merge_equal(std::vector<glm::uvec3>& index, Values&... values) {
    const size_t count = std::max({values.size()...});
    const auto drop_signs = [](auto& array) { // −0 becomes +0
        for (auto& value : array)
            value += 0.0f;
    };
    (drop_signs(values), ...);
    FlatIndex known(count);
    const std::vector<uint32_t> kept =
        renumber(count, index, [&](const std::vector<uint32_t>& kept, uint32_t next) {
            const uint32_t old = kept[next];
            uint64_t hash = 0;
            ((hash = values.empty() ? hash : hash_of(values[old], hash)), ...);
            return known.find_or_add(hash, next, [&](uint32_t other) {
                return (... && (values.empty() || values[kept[other]] == values[old]));
            });
        });
    ((values.empty() ? void() : keep(values, kept)), ...);
}

template <class... Values> void drop_unused(std::vector<glm::uvec3>& index, Values&... values) {
    const std::vector<uint32_t> kept = renumber(std::max({values.size()...}), index,
                                                [](const auto&, uint32_t next) { return next; });
    ((values.empty() ? void() : keep(values, kept)), ...);
}

glm::uvec3 sorted(glm::uvec3 t) {
    std::sort(&t.x, &t.x + 3);
    return t;
}

/// Of the vertices `before` merging, those that are another one in all of the indices after it.
size_t count_merged(const std::vector<glm::uvec3>& before, const IndexedMesh& after) {
    uint32_t count = 0;
    for (const glm::uvec3& t : before)
        count = std::max({count, t.x + 1, t.y + 1, t.z + 1});
    std::vector<char> met(count, 0);
    std::vector<glm::uvec4> vertices; // by position, UV, normal, colour
    FlatIndex known(count);
    size_t merged = 0;
    for (size_t t = 0; t < before.size(); ++t)
        for (int c = 0; c < 3; ++c) {
            if (std::exchange(met[before[t][c]], 1))
                continue;
            const auto number = [&](const std::vector<glm::uvec3>& index) {
                return index.empty() ? 0 : index[t][c];
            };
            const glm::uvec4 vertex(number(after.position_index), number(after.uv_index),
                                    number(after.normal_index), number(after.color_index));
            const auto next = static_cast<uint32_t>(vertices.size());
            if (known.find_or_add(
                    mix(mix(mix(mix(0, vertex.x), vertex.y), vertex.z), vertex.w), next,
                    [&](uint32_t other) { return vertices[other] == vertex; }) == next)
                vertices.push_back(vertex);
            else
                ++merged;
        }
    return merged;
}

bool is_collinear(const IndexedMesh& mesh, const glm::uvec3& t) {
    const glm::dvec3 corner = mesh.positions[t.x];
    return glm::cross(glm::dvec3(mesh.positions[t.y]) - corner,
                      glm::dvec3(mesh.positions[t.z]) - corner) == glm::dvec3(0);
}

} // namespace

CleanMesh::CleanMesh(IndexedMesh mesh) : IndexedMesh(std::move(mesh)) {
    const std::vector<glm::uvec3> before = position_index;
    parallel_for(4, [&](size_t kind) {
        if (kind == 0)
            merge_equal(position_index, positions);
        else if (kind == 1)
            merge_equal(uv_index, uvs, warps);
        else if (kind == 2)
            merge_equal(normal_index, normals);
        else
            merge_equal(color_index, colors);
    });

    dropped.vertices = count_merged(before, *this);

    const std::vector<glm::uvec3>& triangles = position_index;
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
        dropped.collinear += is_collinear(*this, triangle);
        for (std::vector<glm::uvec3>* index : indices())
            if (!index->empty())
                (*index)[kept] = (*index)[t];
        ++kept;
    }
    for (std::vector<glm::uvec3>* index : indices())
        index->resize(index->empty() ? 0 : kept);

    if (dropped.degenerate + dropped.repeated == 0)
        return;
    drop_unused(position_index, positions);
    drop_unused(uv_index, uvs, warps);
    drop_unused(normal_index, normals);
    drop_unused(color_index, colors);
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
