#pragma once

#include "renderer/core/params.h"
#include "renderer/core/registry.h"
#include "renderer/scene/mesh/mesh.h"
#include "renderer/scene/picture.h"

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace rapport {

class FibreSwatch;
struct GltfModel;

/// A piece of a shape that wears one material.
struct ShapePart {
    TriangleMesh mesh;    ///< in the shape's own space
    std::string material; ///< the name that the shape's file gives it, or empty
    /// What it wears where the scene states no material.
    BaseColor base_color{};
    /// What the mesh is only the box of, with a metre to 10⁶ of its units.
    std::shared_ptr<const FibreSwatch> fibres = nullptr;
};

/// What a shape is made from.
struct ShapeContext {
    const Params& params;
    std::filesystem::path base_dir; ///< file names are relative to it
    /// Whether the part with this material name needs UVs, because a cloth lies along them.
    std::function<bool(const std::string& material)> needs_uvs;
    std::vector<std::string>& warnings; ///< what was ignored or mended is appended, a line each
    /// Under how many pixels the camera sees the segment between two points of the shape's space
    /// (Sight::length).
    std::function<double(const glm::dvec3&, const glm::dvec3&)> seen_length;
    std::shared_ptr<const GltfModel> model; ///< ShapeDescription's
};

using ShapeFactory = std::function<std::vector<ShapePart>(const ShapeContext&)>;
using ShapeRegistry = Registry<ShapeFactory>;
/// A new shape is one file with, at its end,
///     const Registered<ShapeFactory> registered("name", make_name);
/// Makes the shape `name`, or throws a FileError that lists the names there are, or the parameters
/// where one is not known.
std::vector<ShapePart> make_shape(const std::string& name, const ShapeContext& context);

} // namespace rapport
