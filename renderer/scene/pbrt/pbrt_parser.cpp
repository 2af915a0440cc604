#include "renderer/scene/pbrt/pbrt_parser.h"

#include "renderer/core/error.h"
#include "renderer/scene/look_at.h"
#include "renderer/scene/pbrt/pbrt_lexer.h"
#include "renderer/scene/pbrt/pbrt_options.h"
#include "renderer/scene/pbrt/pbrt_params.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <optional>
#include <utility>

namespace rapport {
namespace {

using Kind = PbrtToken::Kind;

/// What directives change and AttributeEnd brings back.
struct GraphicsState {
    glm::dmat4 ctm{1}; ///< current transformation matrix
    bool reverse_orientation = false;
    std::shared_ptr<const MaterialDescription> material;
    std::optional<Params> area_light;
};

class Parser {
  public:
    explicit Parser(const std::filesystem::path& path) {
        scene_.path = path;
        parse_file(path);
        for (const auto& [name, object] : objects_)
            if (!object.instanced)
                scene_.stated.unplaced_shapes.insert(scene_.stated.unplaced_shapes.end(),
                                                     object.shapes.begin(), object.shapes.end());
    }

    SceneDescription result() && { return std::move(scene_); }

  private:
    enum class Phase { options, world, any };
    struct Directive {
        std::string_view name;
        Phase phase;
        void (Parser::*read)();
    };
    struct Saved {
        std::string_view begin; ///< the directive that saved
        GraphicsState state;
    };
    struct Object {
        std::vector<ShapeDescription> shapes;
        bool instanced = false;
    };
    static const std::vector<Directive>& directives();
    static constexpr int kDeepestInclude = 32;

    void parse_file(const std::filesystem::path& path) {
        PbrtLexer lexer(path);
        parse(lexer);
    }

    void parse(PbrtLexer& lexer) {
        PbrtLexer* const outer = std::exchange(lexer_, &lexer);
        while (lexer.peek().kind != Kind::end)
            parse_directive();
        if (outer == nullptr) {
            if (!in_world_)
                throw lexer.error(lexer.peek(), "WorldBegin");
            if (!saved_.empty())
                throw lexer.error(lexer.peek(), end_of(saved_.back().begin));
        }
        lexer_ = outer;
    }

    void parse_directive() {
        directive_ = lexer_->next();
        const auto& all = directives();
        const auto found = std::find_if(all.begin(), all.end(), [&](const Directive& d) {
            return directive_.kind == Kind::identifier && d.name == directive_.text;
        });
        if (found == all.end()) {
            std::vector<std::string_view> names;
            for (const Directive& d : all)
                names.push_back(d.name);
            throw lexer_->error(directive_, fmt::format("one of {}", fmt::join(names, ", ")));
        }
        if (found->phase == Phase::options && in_world_)
            throw lexer_->error(directive_, directive_.text + " before WorldBegin",
                                "it after WorldBegin");
        if (found->phase == Phase::world && !in_world_)
            throw lexer_->error(directive_, "WorldBegin before " + directive_.text, "none");
        (this->*found->read)();
    }

    // Tokens

    PbrtToken read_token(const char* what) {
        if (lexer_->peek().kind != Kind::string)
            throw lexer_->error(lexer_->peek(), what);
        return lexer_->next();
    }
    std::string read_string(const char* what) { return read_token(what).text; }

    template <size_t N> std::array<double, N> read_numbers(const char* what) {
        const bool bracketed = lexer_->peek().kind == Kind::open;
        if (bracketed)
            lexer_->next();
        std::array<double, N> numbers;
        for (double& number : numbers) {
            if (lexer_->peek().kind != Kind::number)
                throw lexer_->error(lexer_->peek(), what);
            number = lexer_->next().number;
        }
        if (bracketed) {
            if (lexer_->peek().kind != Kind::close)
                throw lexer_->error(lexer_->peek(), "']'");
            lexer_->next();
        }
        return numbers;
    }

    /// Of the directive, after its type or name.
    Params read_params(const PbrtToken& type) {
        return read_pbrt_params(*lexer_, directive_.text + " \"" + type.text + '"', type);
    }

    // Directives

    template <void (*Read)(const std::string&, const Params&, SceneDescription&)> void option() {
        const PbrtToken type = read_token("a type in quotes");
        const Params params = read_params(type);
        Read(type.text, params, scene_);
        params.check_all_used();
    }

    void camera() {
        option<read_camera>();
        coordinate_systems_["camera"] = glm::inverse(state_.ctm);
        scene_.camera.to_world = glm::mat4(coordinate_systems_["camera"]);
    }

    void set_ctm(const glm::dmat4& ctm) {
        const double volume = glm::determinant(glm::dmat3(ctm));
        if (volume == 0 || !std::isfinite(volume))
            throw lexer_->error(directive_, "a transformation that can be inverted",
                                directive_.text + " to a singular one");
        state_.ctm = ctm;
    }
    void translate() {
        const auto v = read_numbers<3>("three numbers to translate by");
        set_ctm(glm::translate(state_.ctm, {v[0], v[1], v[2]}));
    }
    void scale() {
        const auto v = read_numbers<3>("three scale factors");
        set_ctm(glm::scale(state_.ctm, {v[0], v[1], v[2]}));
    }
    void rotate() {
        const auto v = read_numbers<4>("an angle in degrees and an axis");
        set_ctm(glm::rotate(state_.ctm, radians(v[0]), {v[1], v[2], v[3]}));
    }
    void look_at_directive() {
        const auto v = read_numbers<9>("nine numbers: eye, target, up");
        const auto matrix = look_at({v[0], v[1], v[2]}, {v[3], v[4], v[5]}, {v[6], v[7], v[8]});
        if (!matrix)
            throw lexer_->error(directive_, "eye and target apart, and up not along the view",
                                "LookAt without a direction");
        set_ctm(state_.ctm * *matrix);
    }
    glm::dmat4 read_matrix() {
        const auto v = read_numbers<16>("16 numbers");
        if (v[3] != 0 || v[7] != 0 || v[11] != 0 || v[15] != 1) // column by column
            throw lexer_->error(directive_,
                                "an affine matrix, every fourth number of which makes 0 0 0 1",
                                fmt::format("{} {} {} {}", v[3], v[7], v[11], v[15]));
        return glm::make_mat4(v.data());
    }
    void transform() { set_ctm(read_matrix()); }
    void concat_transform() { set_ctm(state_.ctm * read_matrix()); }
    void identity() { state_.ctm = glm::dmat4(1); }
    void coordinate_system() { coordinate_systems_[read_string("a name in quotes")] = state_.ctm; }
    void coord_sys_transform() {
        const PbrtToken token = lexer_->peek();
        const auto found = coordinate_systems_.find(read_string("a name in quotes"));
        if (found == coordinate_systems_.end())
            throw lexer_->error(token, known("coordinate system", coordinate_systems_));
        state_.ctm = found->second;
    }
    void reverse_orientation() { state_.reverse_orientation = !state_.reverse_orientation; }

    void include() {
        if (++include_depth_ > kDeepestInclude)
            throw lexer_->error(directive_,
                                fmt::format("at most {} files inside each other", kDeepestInclude),
                                "a deeper Include");
        const PbrtToken name = read_token("a file name in quotes");
        const std::filesystem::path file = scene_.path.parent_path() / name.text;
        std::optional<PbrtLexer> included;
        try {
            included.emplace(file);
        } catch (const FileError& error) {
            if (!error.place.empty()) // it is there, and what is in it is wrong
                throw;
            throw lexer_->error(name, "the name of a file");
        }
        parse(*included);
        --include_depth_;
    }

    void world_begin() {
        in_world_ = true;
        state_.ctm = glm::dmat4(1);
        coordinate_systems_["world"] = state_.ctm;
    }

    static std::string end_of(std::string_view begin) {
        return std::string(begin.substr(0, begin.size() - 5)) + "End"; // …Begin
    }
    template <class Map> static std::string known(const char* what, const Map& map) {
        std::vector<std::string> names;
        for (const auto& [name, value] : map)
            names.push_back('"' + name + '"');
        return names.empty() ? fmt::format("a known {}, of which there is none yet", what)
                             : fmt::format("a known {}: {}", what, fmt::join(names, ", "));
    }

    void attribute_begin() { saved_.push_back({"AttributeBegin", state_}); }
    void attribute_end() { state_ = pop("AttributeBegin"); }
    void transform_begin() { saved_.push_back({"TransformBegin", state_}); }
    void transform_end() { state_.ctm = pop("TransformBegin").ctm; }
    GraphicsState pop(std::string_view begin) {
        if (saved_.empty() || saved_.back().begin != begin)
            throw lexer_->error(directive_, saved_.empty() ? std::string(begin) + " before it"
                                                           : end_of(saved_.back().begin));
        GraphicsState state = std::move(saved_.back().state);
        saved_.pop_back();
        return state;
    }

    void object_begin() {
        if (object_)
            throw lexer_->error(directive_, "ObjectEnd", "an object within an object");
        const PbrtToken token = lexer_->peek();
        const std::string name = read_string("an object's name in quotes");
        const auto [place, is_new] = objects_.try_emplace(name);
        if (!is_new)
            throw lexer_->error(token, "a new name", '"' + name + "\" for the second time");
        object_ = &place->second;
        saved_.push_back({"ObjectBegin", state_});
    }
    void object_end() {
        state_ = pop("ObjectBegin");
        object_ = nullptr;
    }
    void object_instance() {
        if (object_)
            throw lexer_->error(directive_, "ObjectEnd", "an instance within an object");
        const PbrtToken token = lexer_->peek();
        const auto found = objects_.find(read_string("an object's name in quotes"));
        if (found == objects_.end())
            throw lexer_->error(token, known("object", objects_));
        found->second.instanced = true;
        for (const ShapeDescription& shape : found->second.shapes) {
            scene_.shapes.push_back(shape);
            scene_.shapes.back().to_world = glm::mat4(state_.ctm) * shape.to_world;
        }
    }

    void texture() {
        const PbrtToken name = read_token("a texture's name in quotes");
        for (const char* const only : {"spectrum", "imagemap"}) {
            const PbrtToken kind = lexer_->peek();
            const std::string expected = fmt::format("\"{}\"", only);
            if (read_string(expected.c_str()) != only)
                throw lexer_->error(kind, expected);
        }
        const auto [place, is_new] = textures_.try_emplace(name.text);
        if (!is_new)
            throw lexer_->error(name, "a new name", '"' + name.text + "\" for the second time");
        place->second = std::make_shared<const TextureDescription>(
            TextureDescription{read_params(name), scene_.path.parent_path()});
        scene_.stated.textures.push_back(place->second);
    }

    std::shared_ptr<MaterialDescription> read_material(const PbrtToken& owner) {
        auto material = std::make_shared<MaterialDescription>();
        material->params = read_params(owner);
        material->base_dir = scene_.path.parent_path();
        scene_.stated.materials.push_back(material);
        return material;
    }
    /// Once its type is known: only a diffuse reflectance may be a texture.
    void find_texture(MaterialDescription& material) {
        if (material.type != "diffuse")
            return;
        const auto name = material.params.take_texture("reflectance");
        if (!name)
            return;
        const auto found = textures_.find(*name);
        if (found == textures_.end())
            throw lexer_->error(directive_, known("texture", textures_), '"' + *name + '"');
        material.reflectance = found->second;
        Param white; // which the texture scales
        white.type = "rgb";
        white.name = "reflectance";
        white.numbers = {1, 1, 1};
        material.params.add(std::move(white));
    }
    void material() {
        const PbrtToken type = read_token("a material's type in quotes");
        const auto material = read_material(type);
        material->type = type.text;
        find_texture(*material);
        state_.material = material;
    }
    void make_named_material() {
        const PbrtToken name = read_token("a material's name in quotes");
        if (scene_.named_materials.contains(name.text))
            throw lexer_->error(name, "a new name", '"' + name.text + "\" for the second time");
        const auto material = read_material(name);
        material->name = name.text;
        material->type = material->params.get_string("type", "");
        if (material->type.empty())
            material->params.fail("type", "\"string type\"", "none");
        find_texture(*material);
        scene_.named_materials[name.text] = material;
    }
    void named_material() {
        const PbrtToken token = lexer_->peek();
        const auto found = scene_.named_materials.find(read_string("a material's name in quotes"));
        if (found == scene_.named_materials.end())
            throw lexer_->error(token, known("named material", scene_.named_materials));
        state_.material = found->second;
    }

    void light_source() {
        LightDescription light;
        const PbrtToken type = read_token("a light's type in quotes");
        light.type = type.text;
        light.params = read_params(type);
        light.to_world = glm::mat4(state_.ctm);
        scene_.lights.push_back(std::move(light));
    }
    void area_light_source() {
        const PbrtToken type = read_token("\"diffuse\"");
        if (type.text != "diffuse")
            throw lexer_->error(type, "\"diffuse\"");
        state_.area_light = read_params(type);
        scene_.stated.area_lights.push_back(*state_.area_light);
    }
    void shape() {
        ShapeDescription shape;
        const PbrtToken type = read_token("a shape's type in quotes");
        shape.type = type.text;
        shape.params = read_params(type);
        shape.to_world = glm::mat4(state_.ctm);
        shape.reverse_orientation = state_.reverse_orientation;
        shape.material = state_.material;
        shape.area_light = state_.area_light;
        if (object_ && shape.area_light)
            throw lexer_->error(directive_, "objects without area lights, as in pbrt",
                                "a Shape that shines");
        (object_ ? object_->shapes : scene_.shapes).push_back(std::move(shape));
    }

    SceneDescription scene_;
    PbrtLexer* lexer_ = nullptr;
    PbrtToken directive_;
    GraphicsState state_;
    std::vector<Saved> saved_;
    std::map<std::string, glm::dmat4> coordinate_systems_;
    std::map<std::string, std::shared_ptr<const TextureDescription>> textures_;
    std::map<std::string, Object> objects_;
    Object* object_ = nullptr; ///< that is being described
    int include_depth_ = 0;
    bool in_world_ = false;
};

const std::vector<Parser::Directive>& Parser::directives() {
    using P = Parser;
    static const std::vector<Directive> all{
        {"AreaLightSource", Phase::world, &P::area_light_source},
        {"AttributeBegin", Phase::world, &P::attribute_begin},
        {"AttributeEnd", Phase::world, &P::attribute_end},
        {"Camera", Phase::options, &P::camera},
        {"ColorSpace", Phase::options, &P::option<read_color_space>},
        {"ConcatTransform", Phase::any, &P::concat_transform},
        {"CoordSysTransform", Phase::any, &P::coord_sys_transform},
        {"CoordinateSystem", Phase::any, &P::coordinate_system},
        {"Film", Phase::options, &P::option<read_film>},
        {"Identity", Phase::any, &P::identity},
        {"Include", Phase::any, &P::include},
        {"Integrator", Phase::options, &P::option<read_integrator>},
        {"LightSource", Phase::world, &P::light_source},
        {"LookAt", Phase::any, &P::look_at_directive},
        {"MakeNamedMaterial", Phase::world, &P::make_named_material},
        {"Material", Phase::world, &P::material},
        {"NamedMaterial", Phase::world, &P::named_material},
        {"ObjectBegin", Phase::world, &P::object_begin},
        {"ObjectEnd", Phase::world, &P::object_end},
        {"ObjectInstance", Phase::world, &P::object_instance},
        {"PixelFilter", Phase::options, &P::option<read_filter>},
        {"ReverseOrientation", Phase::world, &P::reverse_orientation},
        {"Rotate", Phase::any, &P::rotate},
        {"Sampler", Phase::options, &P::option<read_sampler>},
        {"Scale", Phase::any, &P::scale},
        {"Shape", Phase::world, &P::shape},
        {"Texture", Phase::world, &P::texture},
        {"Transform", Phase::any, &P::transform},
        {"TransformBegin", Phase::world, &P::transform_begin},
        {"TransformEnd", Phase::world, &P::transform_end},
        {"Translate", Phase::any, &P::translate},
        {"WorldBegin", Phase::options, &P::world_begin},
    };
    return all;
}

} // namespace

SceneDescription parse_pbrt(const std::filesystem::path& path) { return Parser(path).result(); }

} // namespace rapport
