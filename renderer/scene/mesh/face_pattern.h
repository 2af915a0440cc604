#pragma once

#include "renderer/scene/mesh/control_mesh.h"

#include <map>

namespace rapport {

/// How a face is cut into triangles, in the parameters of its limit surface.
struct FacePattern {
    /// The boundary from corner 0 round, every corner and then the points inside the side after it;
    /// then the points inside.
    std::vector<glm::vec2> points;
    std::vector<glm::uvec3> triangles;
};

/// Patterns by kind of face and by the number of pieces that each of its sides is cut into, the
/// inside following the sides (OpenSubdiv's Bfr); made when first asked for.
class FacePatterns {
  public:
    using Rates = std::array<int, 4>; ///< the last is 0 for a triangle

    const FacePattern& get(FaceKind kind, const Rates& rates);

  private:
    std::map<std::pair<FaceKind, Rates>, FacePattern> made_;
    const std::pair<const std::pair<FaceKind, Rates>, FacePattern>* last_ = nullptr;
};

/// Shares of a face's corners in the point at `parameter`, such that they are linear along its
/// sides; they sum to 1.
glm::dvec4 corner_shares(FaceKind kind, const glm::dvec2& parameter);

} // namespace rapport
