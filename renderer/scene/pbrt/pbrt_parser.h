#pragma once

#include "renderer/scene/scene_description.h"

namespace rapport {

/// Reads a scene in pbrt-v4's text format; a file that keeps to the common part means the same
/// there. A strict subset: what is not known, in a directive, a type or a parameter, is a FileError
/// with line and column that lists what is.
///
/// Before `WorldBegin`: Camera "perspective" | "orthographic"; Film "rgb"; Sampler "independent" |
/// "sobol" | "paddedsobol" | "zsobol" (the last three are one here); PixelFilter "box" (which is
/// also the default: pbrt's own, a Gaussian, correlates pixels); Integrator "path"; ColorSpace
/// "srgb". After it: AttributeBegin/End, TransformBegin/End, Material, MakeNamedMaterial,
/// NamedMaterial, Texture "spectrum" "imagemap" (for the reflectance of "diffuse"), LightSource,
/// AreaLightSource "diffuse", Shape, ObjectBegin/End, ObjectInstance (each instance is a copy and
/// takes the memory of one). Anywhere: LookAt, Translate, Rotate, Scale, Transform,
/// ConcatTransform, Identity, CoordinateSystem, CoordSysTransform, ReverseOrientation, Include.
///
/// As in pbrt, camera space is left-handed when the world is taken as right-handed: x points right
/// in the picture, y up, z into the scene, and LookAt's x is up × direction. Right-handed geometry
/// (glTF) therefore appears as in a mirror unless the file starts with `Scale -1 1 1`.
SceneDescription parse_pbrt(const std::filesystem::path& path);

} // namespace rapport
