#include "renderer/scene/mesh/face_pattern.h"

#include <algorithm>
#include <opensubdiv/bfr/tessellation.h>

namespace rapport {
namespace {

using namespace OpenSubdiv;

int size_of(FaceKind kind) { return kind == FaceKind::quad ? 4 : 3; }

Bfr::Parameterization parametrisation(FaceKind kind) {
    return {kind == FaceKind::triangle ? Sdc::SCHEME_LOOP : Sdc::SCHEME_CATMARK, size_of(kind)};
}

/// A triangle whose side after corner `base` is one piece: its two other sides, of `rates` pieces,
/// laced together up to the corner where they meet. `points` are those of its boundary.
std::vector<glm::uvec3> laced(uint32_t base, const FacePatterns::Rates& rates, size_t points) {
    const uint32_t count = static_cast<uint32_t>(points);
    uint32_t begin = 0; // of the side that is one piece
    for (uint32_t i = 0; i < base; ++i)
        begin += static_cast<uint32_t>(rates[i]);
    const auto right = static_cast<uint64_t>(rates[(base + 1) % 3]);
    const auto left = static_cast<uint64_t>(rates[(base + 2) % 3]);
    std::vector<glm::uvec3> triangles;
    uint64_t i = 0, j = 0; // pieces that are laced of either
    while (i + j + 1 < right + left) {
        const auto a = static_cast<uint32_t>((begin + count - j) % count);
        const auto b = static_cast<uint32_t>((begin + 1 + i) % count);
        const bool up_right = j + 1 == left || (i + 1 < right && (i + 1) * left <= (j + 1) * right);
        triangles.emplace_back(a, b, up_right ? (b + 1) % count : (a + count - 1) % count);
        ++(up_right ? i : j);
    }
    return triangles;
}

FacePattern make_pattern(FaceKind kind, const FacePatterns::Rates& rates) {
    const Bfr::Tessellation cut(parametrisation(kind), size_of(kind), rates.data());
    FacePattern pattern;
    pattern.points.resize(static_cast<size_t>(cut.GetNumCoords()));
    pattern.triangles.resize(static_cast<size_t>(cut.GetNumFacets()));
    cut.GetCoords(&pattern.points[0].x);
    const auto base = std::ranges::find(rates, 1) - rates.begin();
    if (size_of(kind) == 3 && base < 3) {
        // Bfr would cut its inside as finely as its long sides also across.
        pattern.points.resize(static_cast<size_t>(rates[0] + rates[1] + rates[2]));
        pattern.triangles = laced(static_cast<uint32_t>(base), rates, pattern.points.size());
        return pattern;
    }
    std::vector<int> corners(3 * pattern.triangles.size());
    cut.GetFacets(corners.data());
    for (size_t t = 0; t < pattern.triangles.size(); ++t)
        pattern.triangles[t] = {corners[3 * t], corners[3 * t + 1], corners[3 * t + 2]};
    return pattern;
}

} // namespace

const FacePattern& FacePatterns::get(FaceKind kind, const Rates& rates) {
    const std::pair key(kind, rates);
    if (!last_ || last_->first != key) {
        auto found = made_.find(key);
        if (found == made_.end())
            found = made_.emplace(key, make_pattern(kind, rates)).first;
        last_ = &*found;
    }
    return last_->second;
}

glm::dvec4 corner_shares(FaceKind kind, const glm::dvec2& p) {
    if (kind == FaceKind::triangle)
        return {1 - p.x - p.y, p.x, p.y, 0};
    if (kind == FaceKind::quad)
        return {(1 - p.x) * (1 - p.y), p.x * (1 - p.y), p.x * p.y, (1 - p.x) * p.y};
    // A quarter lies between a corner, the middles of its sides, and the middle of the face.
    glm::dvec2 in_quarter;
    const int corner = parametrisation(kind).ConvertCoordToNormalizedSubFace(&p.x, &in_quarter.x);
    const double a = in_quarter.x, b = in_quarter.y;
    glm::dvec4 shares(0);
    shares[(corner + 1) % 3] = a * (1 - b) / 2 + a * b / 3;
    shares[(corner + 2) % 3] = (1 - a) * b / 2 + a * b / 3;
    shares[corner] = 1 - shares[(corner + 1) % 3] - shares[(corner + 2) % 3];
    return shares;
}

} // namespace rapport
