#include "renderer/scene/gltf/gltf_material.h"

#include "renderer/core/error.h"

#include <cmath>
#include <fmt/format.h>

namespace rapport {
namespace {

const std::string kTransform = "KHR_texture_transform";

/// Reads the extension's members; `place` names it in FileErrors.
class TransformReader {
  public:
    TransformReader(const tinygltf::Value& value, const std::string& path, std::string place)
        : value_(value), path_(path), place_(std::move(place)) {}

    TextureTransform transform() const {
        TextureTransform transform;
        if (value_.Has("rotation"))
            transform.rotation = number(value_.Get("rotation"), "rotation");
        if (value_.Has("offset"))
            transform.offset = pair("offset");
        if (value_.Has("scale"))
            transform.scale = pair("scale");
        return transform;
    }
    int set(int fallback) const {
        if (!value_.Has("texCoord"))
            return fallback;
        const double set = number(value_.Get("texCoord"), "texCoord");
        if (!(set >= 0 && set < 1 << 30 && set == std::floor(set)))
            fail("texCoord", "a whole number that is not negative", fmt::format("{}", set));
        return static_cast<int>(set);
    }

  private:
    [[noreturn]] void fail(const char* key, const std::string& expected,
                           const std::string& found) const {
        throw FileError(path_, fmt::format("{}.{}", place_, key), expected, found);
    }
    double number(const tinygltf::Value& value, const char* key) const {
        if (!value.IsNumber())
            fail(key, "a number", "another type");
        return value.GetNumberAsDouble();
    }
    glm::dvec2 pair(const char* key) const {
        const tinygltf::Value& value = value_.Get(key);
        if (!value.IsArray() || value.ArrayLen() != 2)
            fail(key, "an array of 2 numbers", "something else");
        return {number(value.Get(0), key), number(value.Get(1), key)};
    }

    const tinygltf::Value& value_;
    const std::string& path_;
    std::string place_;
};

PictureMapping::Wrap wrap_mode(int mode, const std::string& path, const std::string& place) {
    switch (mode) {
    case TINYGLTF_TEXTURE_WRAP_REPEAT:
        return PictureMapping::Wrap::repeat;
    case TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE:
        return PictureMapping::Wrap::clamp;
    case TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT:
        return PictureMapping::Wrap::mirror;
    default:
        throw FileError(path, place, "33071, 33648 or 10497", fmt::format("{}", mode));
    }
}

/// Element `index` of a section, or a FileError at `place`, which refers to it.
template <class Entry>
const Entry& entry(const std::vector<Entry>& section, int index, const std::string& what,
                   const std::string& path, const std::string& place) {
    if (index < 0 || static_cast<size_t>(index) >= section.size())
        throw FileError(path, place, fmt::format("one of {} {}", section.size(), what),
                        fmt::format("{}", index));
    return section[static_cast<size_t>(index)];
}

/// Nothing of a material that is opaque whatever its alpha.
std::optional<Opacity> opacity_of(const tinygltf::Material& material, const std::string& path,
                                  const std::string& place) {
    const std::string& mode = material.alphaMode;
    if (mode == "OPAQUE")
        return std::nullopt;
    if (mode != "MASK" && mode != "BLEND")
        throw FileError(path, place + ".alphaMode", "OPAQUE, MASK or BLEND",
                        fmt::format("\"{}\"", mode));
    Opacity opacity{static_cast<float>(material.pbrMetallicRoughness.baseColorFactor[3])};
    if (mode == "MASK") {
        if (!(material.alphaCutoff >= 0))
            throw FileError(path, place + ".alphaCutoff", "a number that is not negative",
                            fmt::format("{}", material.alphaCutoff));
        opacity.cutoff = static_cast<float>(material.alphaCutoff);
    }
    return opacity;
}

} // namespace

glm::vec2 TextureTransform::operator()(const glm::vec2& uv) const {
    const glm::dvec2 scaled = scale * glm::dvec2(uv);
    const double c = std::cos(rotation), s = std::sin(rotation);
    return glm::dvec2(c * scaled.x + s * scaled.y, c * scaled.y - s * scaled.x) + offset;
}

GltfUvs gltf_uvs(const tinygltf::Model& file, const tinygltf::Primitive& primitive,
                 const std::string& path) {
    const auto set_of_primitive = [&](int set, const TextureTransform& transform) {
        GltfUvs uvs{-1, fmt::format("TEXCOORD_{}", set), transform};
        if (const auto found = primitive.attributes.find(uvs.attribute);
            found != primitive.attributes.end())
            uvs.accessor = found->second;
        return uvs;
    };
    if (primitive.material >= 0) {
        const tinygltf::TextureInfo& texture =
            file.materials[static_cast<size_t>(primitive.material)]
                .pbrMetallicRoughness.baseColorTexture;
        int set = texture.texCoord;
        TextureTransform transform;
        if (const auto found = texture.extensions.find(kTransform);
            found != texture.extensions.end()) {
            const TransformReader reader(
                found->second, path,
                fmt::format("materials[{}].pbrMetallicRoughness.baseColorTexture.extensions.{}",
                            primitive.material, kTransform));
            set = reader.set(set);
            transform = reader.transform();
        }
        if (GltfUvs uvs = set_of_primitive(set, transform); uvs.accessor >= 0)
            return uvs;
    }
    return set_of_primitive(0, {});
}

BaseColor gltf_base_color(const tinygltf::Model& file, const GltfAccessors& accessors, int material,
                          const std::string& path, std::vector<std::string>& warnings) {
    const tinygltf::PbrMetallicRoughness& source =
        file.materials[static_cast<size_t>(material)].pbrMetallicRoughness;
    const std::string place = fmt::format("materials[{}].pbrMetallicRoughness", material);
    BaseColor color;
    for (const double value : source.baseColorFactor)
        if (!(value >= 0 && value <= 1))
            throw FileError(path, place + ".baseColorFactor", "numbers in [0, 1]",
                            fmt::format("{}", value));
    for (int c = 0; c < 3; ++c)
        color.factor[c] = static_cast<float>(source.baseColorFactor[static_cast<size_t>(c)]);
    color.opacity = opacity_of(file.materials[static_cast<size_t>(material)], path,
                               fmt::format("materials[{}]", material));
    if (source.baseColorTexture.index < 0)
        return color;
    const tinygltf::Texture& texture = entry(file.textures, source.baseColorTexture.index,
                                             "textures", path, place + ".baseColorTexture.index");
    const std::string texture_place = fmt::format("textures[{}]", source.baseColorTexture.index);
    if (texture.sampler >= 0) {
        const tinygltf::Sampler& sampler =
            entry(file.samplers, texture.sampler, "samplers", path, texture_place + ".sampler");
        const std::string sampler_place = fmt::format("samplers[{}]", texture.sampler);
        color.mapping.wrap_u = wrap_mode(sampler.wrapS, path, sampler_place + ".wrapS");
        color.mapping.wrap_v = wrap_mode(sampler.wrapT, path, sampler_place + ".wrapT");
    }
    std::span<const unsigned char> bytes;
    if (texture.source >= 0) {
        const tinygltf::Image& image =
            entry(file.images, texture.source, "images", path, texture_place + ".source");
        bytes = image.bufferView >= 0
                    ? accessors.bytes(image.bufferView, fmt::format("images[{}]", texture.source))
                    : std::span(image.image);
    }
    if (bytes.empty())
        warnings.push_back(texture_place +
                           ": its picture is missing or in a form that is not read");
    else
        color.picture = std::make_shared<EncodedPicture>(EncodedPicture{
            fmt::format("{}: images[{}]", path, texture.source), {bytes.begin(), bytes.end()}});
    return color;
}

} // namespace rapport
