#include "renderer/scene/mesh/face_pattern.h"

#include <opensubdiv/bfr/tessellation.h>

namespace rapport {
namespace {

using namespace OpenSubdiv;

int size_of(FaceKind kind) { return kind == FaceKind::quad ? 4 : 3; }

Bfr::Parameterization parametrisation(FaceKind kind) {
    return {kind == FaceKind::triangle ? Sdc::SCHEME_LOOP : Sdc::SCHEME_CATMARK, size_of(kind)};
}

FacePattern make_pattern(FaceKind kind, const FacePatterns::Rates& rates) {
    const Bfr::Tessellation cut(parametrisation(kind), size_of(kind), rates.data());
    FacePattern pattern;
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
