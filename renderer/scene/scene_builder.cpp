#include "renderer/scene/scene_builder.h"

#include "renderer/core/error.h"
#include "renderer/scene/imagemap.h"
#include "renderer/scene/mesh/enters_cube.h"
#include "renderer/scene/mesh/mesh_operations.h"
#include "renderer/scene/shape/fibre_swatch.h"
#include "renderer/scene/shape/shape.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <glm/gtc/matrix_transform.hpp>
#include <set>
#include <stdexcept>

namespace rapport {
namespace {

using MaterialPointer = std::shared_ptr<const MaterialDescription>;

MaterialPointer cloth_material(const std::string& name, const std::filesystem::path& file,
                               const std::string& colourway) {
    auto material = std::make_shared<MaterialDescription>();
    material->type = "cloth";
    material->name = name;
    material->params = Params(file.string(), "cloth", 0);
    for (const auto& [parameter, value] :
         {std::pair("filename", file.string()), {"colourway", colourway}}) {
        Param param;
        param.type = "string";
        param.name = parameter;
        param.strings = {value};
        material->params.add(std::move(param));
    }
    return material;
}

/// What `make` makes; a FileError of a file that the scene names then tells also where it does.
template <class Make> auto named_in(const Params& params, const Make& make) {
    try {
        return make();
    } catch (const FileError& error) {
        if (error.path == params.path() || params.place().empty())
            throw;
        throw FileError(
            error.path, error.place, error.expected,
            fmt::format("{} (named at {}:{})", error.found, params.path(), params.place()));
    }
}

class Builder {
  public:
    Builder(const SceneDescription& description, const BuildOptions& options,
            std::vector<std::string>& warnings)
        : description_(description), options_(options), warnings_(warnings),
          base_dir_(description.path.parent_path()),
          sight_(options.seen_from.value_or(description.camera)) {
        for (const auto& [name, file] : options.cloths)
            overrides_[name] = cloth_material(name, file, colourway_of(name));
        for (const auto& [name, colourway] : options.colourways)
            if (!options.cloths.contains(name))
                throw FileError(description_.path.string(), "",
                                "a cloth for each material that is given a colourway",
                                fmt::format("\"{}\" for \"{}\"", colourway, name));
        for (const auto& [name, material] : description.named_materials)
            names_met_.insert(name);
    }

    Scene build() {
        std::vector<std::shared_ptr<Light>> lights;
        for (const LightDescription& light : description_.lights)
            lights.push_back(named_in(light.params, [&] {
                return make_light(light.type,
                                  {light.params, base_dir_, light.to_world, &warnings_});
            }));
        std::vector<Surface> surfaces;
        for (const ShapeDescription& shape : description_.shapes)
            add_shape(shape, surfaces);
        check_overrides_are_worn();
        check_fibres_are_lit(surfaces, lights);
        check_fibres_are_alone(surfaces);
        check_unused();
        return Scene(std::move(surfaces), std::move(lights), description_.camera,
                     description_.settings);
    }

  private:
    std::string colourway_of(const std::string& name) const {
        const auto found = options_.colourways.find(name);
        return found == options_.colourways.end() ? "" : found->second;
    }

    void add_shape(const ShapeDescription& shape, std::vector<Surface>& surfaces) {
        const auto needs_uvs = [&](const std::string& name) {
            const MaterialPointer material = material_for(shape, name);
            return material && material->type == "cloth";
        };
        std::atomic<bool> cut_by_sight = false;
        const auto seen_length = [&, to_world = glm::dmat4(shape.to_world)](const glm::dvec3& a,
                                                                            const glm::dvec3& b) {
            cut_by_sight.store(true, std::memory_order_relaxed);
            return sight_.length(to_world * glm::dvec4(a, 1), to_world * glm::dvec4(b, 1));
        };
        std::vector<ShapePart> parts = named_in(shape.params, [&] {
            return make_shape(shape.type, {shape.params, base_dir_, needs_uvs, warnings_,
                                           seen_length, shape.model});
        });
        for (ShapePart& part : parts) {
            const MaterialPointer material = material_for(shape, part.material);
            if (material && part.mesh.uvs.empty() &&
                (material->type == "cloth" || material->reflectance))
                shape.params.fail("",
                                  fmt::format("UVs, along which the {} lies",
                                              material->reflectance ? "texture" : "cloth"),
                                  "a mesh without");
            if (!material && part.base_color.picture && part.mesh.uvs.empty()) {
                warnings_.push_back(part.base_color.picture->name +
                                    " is left out: its mesh has no UVs");
                part.base_color.picture = nullptr;
            }
            Surface surface;
            surface.cut_by_sight = cut_by_sight;
            transform(part.mesh, shape.to_world);
            if (has_far_positions(part.mesh))
                shape.params.fail("", "positions below 1e18 m", "larger ones");
            if (part.fibres) {
                place_fibres(part.fibres, shape, surface);
                fibre_boxes_.push_back({shape, surfaces.size(), box_to_cube(*part.fibres, shape)});
            }
            if (shape.reverse_orientation)
                reverse_orientation(part.mesh);
            orient_by_normals(part.mesh);
            surface.material = material ? bsdf(material) : bsdf(part.base_color);
            surface.print = material ? Print{texture(material->reflectance)}
                                     : print(part.base_color, part.mesh, shape);
            surface.description =
                described(material ? *material : MaterialDescription{}, part.material);
            surface.mesh = std::make_shared<const TriangleMesh>(std::move(part.mesh));
            if (shape.area_light)
                set_emission(shape, surface);
            surfaces.push_back(std::move(surface));
        }
    }

    static void place_fibres(const std::shared_ptr<const FibreSwatch>& fibres,
                             const ShapeDescription& shape, Surface& surface) {
        if (shape.area_light)
            shape.params.fail("", "fibres that do not shine", "an area light");
        try {
            surface.fibres.emplace(fibres, shape.to_world);
        } catch (const std::invalid_argument&) {
            shape.params.fail("", "a transform of turns, moves and scales common to all axes",
                              "one that deforms the fibres");
        }
    }

    /// To (-1, 1)³ from what holds the fibres, but for a skin at which others may touch it.
    static glm::dmat4 box_to_cube(const FibreSwatch& fibres, const ShapeDescription& shape) {
        constexpr double kSkin = 1e-3; ///< of the size
        const glm::dvec3 low = 1e-6 * fibres.low(), high = 1e-6 * fibres.high();
        return glm::scale(glm::dmat4(1), 2 * (1 + kSkin) / (high - low)) *
               glm::translate(glm::dmat4(1), -0.5 * (low + high)) *
               glm::inverse(glm::dmat4(shape.to_world));
    }

    /// Mistakes are told also where nothing is seen of them. Cloths are not measured for that, nor
    /// missed: what nothing wears may have been replaced by the caller's.
    void check_unused() {
        const auto no_table = [](const auto&, const auto&) { return nullptr; };
        for (const MaterialPointer& material : description_.stated.materials)
            if (!materials_.contains(material.get()))
                make_material(material->type, {material->params, material->base_dir, no_table});
        for (const auto& description : description_.stated.textures)
            texture(description);
        for (const Params& area_light : description_.stated.area_lights) {
            Surface unlit;
            read_emission(area_light, unlit);
        }
        for (const ShapeDescription& shape : description_.stated.unplaced_shapes) {
            std::vector<std::string> untold;
            named_in(shape.params, [&] {
                return make_shape(shape.type,
                                  {shape.params, base_dir_,
                                   [](const std::string&) { return false; }, untold,
                                   [](const auto&, const auto&) { return 0.0; }, shape.model});
            });
        }
    }

    void check_overrides_are_worn() const {
        for (const auto& [name, file] : options_.cloths) {
            if (worn_.contains(name))
                continue;
            std::string expected = fmt::format("a shape that wears \"{}\"", name);
            if (name.empty())
                expected = "a glTF shape to wear the cloth that is for all materials";
            else if (names_met_.empty())
                expected = "a named material, of which it has none";
            else if (!names_met_.contains(name))
                expected = fmt::format("a material of its own: {}", fmt::join(names_met_, ", "));
            throw FileError(description_.path.string(), "", expected,
                            name.empty() ? fmt::format("none for {}", file.string())
                                         : fmt::format("\"{}\" for {}", name, file.string()));
        }
    }

    void check_fibres_are_lit(const std::vector<Surface>& surfaces,
                              const std::vector<std::shared_ptr<Light>>& lights) const {
        if (std::ranges::none_of(surfaces, [](const Surface& s) { return s.fibres.has_value(); }))
            return;
        for (size_t i = 0; i < lights.size(); ++i)
            if (lights[i]->is_delta()) {
                const LightDescription& light = description_.lights[i];
                light.params.fail("",
                                  "lights of some size where there is a Shape \"fibers\", for no "
                                  "path through smooth fibres meets a point or a single direction",
                                  fmt::format("LightSource \"{}\"", light.type));
            }
    }

    /// A path crosses the box of fibres in one go and would see nothing else in there.
    void check_fibres_are_alone(const std::vector<Surface>& surfaces) const {
        for (const FibreBox& fibres : fibre_boxes_) {
            const Params& params = fibres.shape.params;
            const glm::dvec3 eye = fibres.to_cube * glm::dmat4(description_.camera.to_world)[3];
            if (glm::all(glm::lessThan(glm::abs(eye), glm::dvec3(1))))
                params.fail("", "a camera outside the box of the fibres", "one among them");
            for (size_t i = 0; i < surfaces.size(); ++i)
                if (i != fibres.surface && enters_cube(*surfaces[i].mesh, fibres.to_cube))
                    params.fail("", "no other shape within the box of the fibres", "one");
        }
    }

    /// In this order: the caller's cloth for a glTF part by its name, or for all parts; the scene's
    /// material of the part's name; the caller's cloth for the current material, or that itself.
    MaterialPointer material_for(const ShapeDescription& shape, const std::string& part) {
        if (!part.empty())
            names_met_.insert(part);
        if (shape.type == "gltf")
            for (const std::string& name : {part, std::string()})
                if (const MaterialPointer cloth = override_of(name))
                    return cloth;
        if (const auto named = description_.named_materials.find(part);
            named != description_.named_materials.end())
            return named->second;
        if (!shape.material)
            return nullptr;
        const MaterialPointer cloth =
            shape.material->name.empty() ? nullptr : override_of(shape.material->name);
        return cloth ? cloth : shape.material;
    }

    MaterialPointer override_of(const std::string& name) {
        const auto found = overrides_.find(name);
        if (found == overrides_.end())
            return nullptr;
        worn_.insert(name);
        return found->second;
    }

    static std::shared_ptr<const Bsdf> bsdf(const BaseColor& color) {
        const Rgb reflectance = color.picture ? Rgb(1) : color.factor;
        Param param;
        param.type = "rgb";
        param.name = "reflectance";
        param.numbers = {reflectance.r, reflectance.g, reflectance.b};
        Params params("", "a part's base colour", 0);
        params.add(std::move(param));
        return make_material("diffuse", {params, {}, {}});
    }

    std::shared_ptr<const PictureTexture>
    texture(const std::shared_ptr<const TextureDescription>& description) {
        if (!description)
            return nullptr;
        auto& made = textures_[description.get()];
        if (!made)
            made = named_in(description->params, [&] {
                return make_imagemap(description->params, description->base_dir);
            });
        return made;
    }

    /// A light shines from all of its surface, hence none of it is missing.
    Print print(const BaseColor& color, const TriangleMesh& mesh, const ShapeDescription& shape) {
        return {texture(color), !mesh.colors.empty(),
                shape.area_light ? std::nullopt : color.opacity};
    }

    std::shared_ptr<const PictureTexture> texture(const BaseColor& color) {
        if (!color.picture)
            return nullptr;
        auto& picture = pictures_[color.picture];
        if (!picture)
            picture = std::make_shared<Picture>(color.picture->bytes, color.picture->name);
        return std::make_shared<PictureTexture>(picture, color.mapping, color.factor);
    }

    static MaterialPointer described(MaterialDescription material, const std::string& part) {
        if (!part.empty())
            material.name = part;
        else if (material.name.empty() && material.type == "cloth")
            material.name = fmt::format("{} (line {})", material.params.get_string("filename", ""),
                                        material.params.line());
        return std::make_shared<const MaterialDescription>(std::move(material));
    }

    std::shared_ptr<const Bsdf> bsdf(const MaterialPointer& material) {
        auto& made = materials_[material.get()];
        if (!made)
            made = named_in(material->params, [&] {
                return make_material(material->type,
                                     {material->params, material->base_dir, options_.load_table});
            });
        return made;
    }

    /// AreaLightSource "diffuse": "rgb L" radiance, "float scale", "bool twosided".
    static void read_emission(const Params& params, Surface& surface) {
        surface.emission = light_radiance(params);
        surface.two_sided_emission = params.get_bool("twosided", false);
        params.check_all_used();
    }

    static void set_emission(const ShapeDescription& shape, Surface& surface) {
        read_emission(*shape.area_light, surface);
        float area = 0; // in single precision, as the light takes it
        for (const glm::uvec3& t : surface.mesh->triangles) {
            const auto& p = surface.mesh->positions;
            area += glm::length(glm::cross(p[t.y] - p[t.x], p[t.z] - p[t.x])) / 2;
        }
        if (!std::isfinite(2 * static_cast<float>(kPi) * area * luminance(surface.emission)))
            shape.params.fail("", "an area light whose power is a number",
                              "one too large or too bright");
    }

    const SceneDescription& description_;
    const BuildOptions& options_;
    std::vector<std::string>& warnings_;
    std::filesystem::path base_dir_;
    Sight sight_;
    std::map<std::string, MaterialPointer> overrides_;
    std::map<const MaterialDescription*, std::shared_ptr<const Bsdf>> materials_;
    std::map<const TextureDescription*, std::shared_ptr<const PictureTexture>> textures_;
    std::map<std::shared_ptr<const EncodedPicture>, std::shared_ptr<const Picture>> pictures_;
    struct FibreBox {
        const ShapeDescription& shape;
        size_t surface;
        glm::dmat4 to_cube;
    };
    std::vector<FibreBox> fibre_boxes_;
    std::set<std::string> names_met_;
    std::set<std::string> worn_; ///< names of the overrides that a shape took
};

} // namespace

Scene build_scene(const SceneDescription& description, const BuildOptions& options,
                  std::vector<std::string>& warnings) {
    return Builder(description, options, warnings).build();
}

} // namespace rapport
