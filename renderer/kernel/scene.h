#pragma once

#include "renderer/core/math.h"

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>

namespace rapport::kernel {

/// A ray segment; `dir` need not be of unit length, distances are in units of its length.
struct Ray {
    glm::vec3 org;
    glm::vec3 dir;
    float tnear = 0;
    float tfar = std::numeric_limits<float>::infinity();
};

/// As many as are traced at once.
template <class T> using Packet = std::array<T, 8>;

struct Hit {
    float t;
    uint32_t geometry; ///< as returned by add_triangles
    uint32_t primitive;
    float u, v;                 ///< barycentric weights of the 2nd and 3rd vertex
    glm::vec3 geometric_normal; ///< unit, counter-clockwise side
};

/// Triangle meshes in an Embree scene (robust mode). Built once, then traced from any thread.
/// A ray that is not finite, or whose interval is empty, misses.
class Scene {
  public:
    Scene();
    ~Scene();
    Scene(Scene&&) noexcept;
    Scene& operator=(Scene&&) noexcept;

    /// Copies the mesh; indices must be in range. Returns the geometry number, counted from 0.
    uint32_t add_triangles(std::span<const glm::vec3> positions,
                           std::span<const glm::uvec3> triangles);
    void commit();

    std::optional<Hit> intersect(const Ray& ray) const;
    /// What rays meet that lie close together, such as those of a pixel, at less than the price of
    /// each alone; at most a packet of them.
    Packet<std::optional<Hit>> intersect(std::span<const Ray> rays) const;
    /// Lower and upper corner of everything in the scene.
    std::pair<glm::vec3, glm::vec3> bounds() const;

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

} // namespace rapport::kernel
