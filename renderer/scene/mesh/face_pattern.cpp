#include "renderer/scene/mesh/face_pattern.h"

#include <algorithm>
#include <numeric>
#include <opensubdiv/bfr/tessellation.h>

namespace rapport {
namespace {

using namespace OpenSubdiv;

int size_of(FaceKind kind) { return kind == FaceKind::quad ? 4 : 3; }

Bfr::Parameterization parametrisation(FaceKind kind) {
    return {kind == FaceKind::triangle ? Sdc::SCHEME_LOOP : Sdc::SCHEME_CATMARK, size_of(kind)};
}

/// A triangle whose side after corner `base` is one piece: its two other sides laced together up to
/// the corner where they meet.
std::vector<glm::uvec3> laced(int base, const FacePatterns::Rates& rates) {
    const int64_t right = rates[static_cast<size_t>((base + 1) % 3)];
    const int64_t left = rates[static_cast<size_t>((base + 2) % 3)], count = 1 + right + left;
    const int64_t begin = std::accumulate(rates.begin(), rates.begin() + base, int64_t{0});
    const auto round = [&](int64_t point) {
        return static_cast<uint32_t>((point + count) % count);
    };
    std::vector<glm::uvec3> triangles;
    int64_t i = 0, j = 0; // pieces that are laced of the right side and of the left
    while (i + j + 1 < right + left) {
        const int64_t a = begin - j, b = begin + 1 + i;
        const bool up_right = j + 1 == left || (i + 1 < right && (i + 1) * left <= (j + 1) * right);
        triangles.emplace_back(round(a), round(b), round(up_right ? b + 1 : a - 1));
        ++(up_right ? i : j);
    }
    return triangles;
}

FacePattern make_pattern(FaceKind kind, const FacePatterns::Rates& rates) {
    const Bfr::Tessellation cut(parametrisation(kind), size_of(kind), rates.data());
    FacePattern pattern;
    if (const auto base = std::ranges::find(rates, 1) - rates.begin();
        size_of(kind) == 3 && base < 3) {
        // Bfr would cut its inside as finely as its long sides also across.
        pattern.points.resize(static_cast<size_t>(cut.GetNumBoundaryCoords()));
        cut.GetBoundaryCoords(&pattern.points[0].x);
        pattern.triangles = laced(static_cast<int>(base), rates);
        return pattern;
    }
    pattern.points.resize(static_cast<size_t>(cut.GetNumCoords()));
    pattern.triangles.resize(static_cast<size_t>(cut.GetNumFacets()));
    cut.GetCoords(&pattern.points[0].x);
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
