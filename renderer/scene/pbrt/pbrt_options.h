#pragma once

#include "renderer/scene/scene_description.h"

namespace rapport {

// The directives before WorldBegin that say how a scene is seen and computed: each reads a
// directive's `type` and parameters into the description, or throws a FileError at the directive.

void read_camera(const std::string& type, const Params& params, SceneDescription& scene);
void read_film(const std::string& type, const Params& params, SceneDescription& scene);
void read_sampler(const std::string& type, const Params& params, SceneDescription& scene);
void read_filter(const std::string& type, const Params& params, SceneDescription& scene);
void read_integrator(const std::string& type, const Params& params, SceneDescription& scene);
void read_color_space(const std::string& type, const Params& params, SceneDescription& scene);

} // namespace rapport
