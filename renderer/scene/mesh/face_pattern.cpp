#include "renderer/scene/mesh/face_pattern.h"

#include <opensubdiv/bfr/tessellation.h>

namespace rapport {
namespace {

using namespace OpenSubdiv;

FacePattern make_pattern(FacePatterns::Kind kind, const FacePatterns::Rates& rates) {
    using Kind = FacePatterns::Kind;
    const int size = kind == Kind::quad ? 4 : 3;
    const Bfr::Parameterization parameters(
        kind == Kind::triangle ? Sdc::SCHEME_LOOP : Sdc::SCHEME_CATMARK, size);
    const Bfr::Tessellation cut(parameters, size, rates.data());
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

const FacePattern& FacePatterns::get(Kind kind, const Rates& rates) {
    const std::pair key(kind, rates);
    if (!last_ || last_->first != key) {
        auto found = made_.find(key);
        if (found == made_.end())
            found = made_.emplace(key, make_pattern(kind, rates)).first;
        last_ = &*found;
    }
    return last_->second;
}

} // namespace rapport
