#include "renderer/app/info.h"
#include "renderer/core/image.h"
#include "renderer/scene/gltf/gltf.h"
#include "renderer/scene/mesh/uv_scale.h"
#include "renderer/scene/pbrt/pbrt_parser.h"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <iterator>

namespace rapport {

Info image_info(const std::filesystem::path& path) {
    const Image image = read_exr(path);
    Info info;
    info.json = {{"kind", "image"},
                 {"width", image.width},
                 {"height", image.height},
                 {"channels", image.channels},
                 {"attributes", image.attributes}};
    info.text = fmt::format("Image {} × {}: {}\n", image.width, image.height,
                            fmt::join(image.channels, ", "));
    for (const auto& [name, value] : image.attributes)
        info.text += name + ": " + value + (value.ends_with('\n') ? "" : "\n");
    return info;
}

Info model_info(const std::filesystem::path& path) {
    const GltfModel model = read_gltf(path);
    Info info;
    info.json = {{"kind", "model"}, {"parts", nlohmann::ordered_json::array()}};
    info.text = fmt::format("glTF model, {} parts\n", model.parts.size());
    for (const GltfPart& part : model.parts) {
        const size_t triangles = part.mesh.position_index.size();
        const bool uvs = !part.mesh.uv_index.empty();
        info.json["parts"].push_back({{"name", part.name},
                                      {"material", part.material},
                                      {"triangles", triangles},
                                      {"vertices", part.mesh.positions.size()},
                                      {"uvs", uvs},
                                      {"metres_per_uv", metres_per_uv(part.mesh)}});
        fmt::format_to(std::back_inserter(info.text),
                       "{}: material \"{}\", {} triangles, {} vertices, {}\n", part.name,
                       part.material, triangles, part.mesh.positions.size(),
                       uvs ? fmt::format("a unit of UV is {:.3g} m", metres_per_uv(part.mesh))
                           : "without UVs");
    }
    info.json["warnings"] = model.warnings;
    for (const std::string& warning : model.warnings)
        info.text += "warning: " + warning + '\n';
    return info;
}

Info scene_info(const std::filesystem::path& path) {
    const SceneDescription scene = parse_pbrt(path);
    const glm::ivec2 size = scene.camera.resolution;
    Info info;
    info.json = {{"kind", "scene"},
                 {"width", size.x},
                 {"height", size.y},
                 {"samples", scene.settings.samples},
                 {"shapes", nlohmann::ordered_json::array()},
                 {"lights", nlohmann::ordered_json::array()},
                 {"materials", nlohmann::ordered_json::array()}};
    for (const ShapeDescription& shape : scene.shapes)
        info.json["shapes"].push_back(shape.type);
    for (const LightDescription& light : scene.lights)
        info.json["lights"].push_back(light.type);
    for (const auto& [name, material] : scene.named_materials)
        info.json["materials"].push_back(name);
    const auto shining = std::ranges::count_if(
        scene.shapes, [](const ShapeDescription& shape) { return shape.area_light.has_value(); });
    info.text = fmt::format(
        "Scene {} × {}, {} samples per pixel, {} shapes, of which {} shine, {} other lights\n",
        size.x, size.y, scene.settings.samples, scene.shapes.size(), shining, scene.lights.size());
    for (const ShapeDescription& shape : scene.shapes)
        if (const std::string file = shape.params.get_string("filename", ""); !file.empty())
            fmt::format_to(std::back_inserter(info.text), "{}: {}\n", shape.type, file);
    for (const auto& [name, material] : scene.named_materials)
        fmt::format_to(std::back_inserter(info.text), "material \"{}\": {}{}\n", name,
                       material->type,
                       material->type == "cloth" ? ' ' + material->params.get_string("filename", "")
                                                 : std::string());
    return info;
}

} // namespace rapport
