#pragma once

#include "renderer/preview/orbit_camera.h"
#include "renderer/preview/tracer.h"
#include "renderer/scene/shape/fibre_swatch.h"

namespace rapport {

/// A cloth's fibres close up under a lamp that may stand anywhere: what the window shows beside
/// what the cloth does with light. To be used from one thread, which never waits.
class FibreView {
  public:
    /// What is to be seen, in a picture of that size; `light` is the unit vector towards the lamp
    /// (local frame of the cloth). The same again changes nothing.
    void show(std::shared_ptr<const FibreSwatch> fibres, const glm::vec3& light,
              const glm::ivec2& size);
    /// As Session's, of pixels of the picture and of notches of the wheel.
    void orbit(const glm::vec2& pixels);
    void zoom(float steps);

    /// The latest; nothing before the first.
    std::shared_ptr<const TracedPicture> picture() const { return tracer_.picture(); }

  private:
    void restart();

    std::shared_ptr<const FibreSwatch> fibres_;
    glm::vec3 light_{0};
    std::shared_ptr<const Scene> scene_;
    std::optional<OrbitCamera> camera_;
    Tracer tracer_;
};

/// The swatch, its half width the unit of length, under a lamp and a dim sky.
Scene fibre_scene(std::shared_ptr<const FibreSwatch> fibres, const glm::vec3& light);

} // namespace rapport
