#pragma once

#include <array>
#include <glm/glm.hpp>
#include <map>
#include <vector>

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
    enum class Kind { triangle, quad, quartered_triangle /**< of Catmull & Clark's surface */ };
    using Rates = std::array<int, 4>; ///< the last is 0 for a triangle

    const FacePattern& get(Kind kind, const Rates& rates);

  private:
    std::map<std::pair<Kind, Rates>, FacePattern> made_;
    const std::pair<const std::pair<Kind, Rates>, FacePattern>* last_ = nullptr;
};

} // namespace rapport
