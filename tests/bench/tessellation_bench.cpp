#include "materials/table/table_bsdf.h"
#include "renderer/integrator/path_tracer.h"
#include "renderer/scene/gltf/gltf.h"
#include "renderer/scene/model_scene.h"
#include "renderer/scene/scene_builder.h"
#include "tests/support/synthetic_tables.h"

#include <chrono>
#include <cstdio>
#include <limits>

// What finer tessellation buys: lines of model and view, curve, parameter (pixels, or pieces to an
// edge), triangles, seconds to build the scene, and error of the picture: RMS difference from the
// finest over the mean, of the pixels that show the model. The model is seen framed whole, and from
// close up: from a tenth of that distance. All pictures, of 512², have the same random numbers, so
// that hardly more than their geometry differs; "noise" is what 64 samples a pixel leave, by what
// two pictures of other random numbers differ by. charts/tessellation.py draws them:
//
//   build/tests/tests/tessellation_bench scenes/garments/dress.glb |
//       python3 tests/bench/charts/tessellation.py

namespace rapport {
namespace {

constexpr int kSamples = 16, kNoiseSamples = 64;

struct View {
    const char* name;
    float distance; ///< of the camera from its middle, in that at which it is framed whole
    std::pair<const char*, double> finest; ///< the parameter of the reference
};
constexpr View kViews[]{{"framed whole", 1, {"level", 16}},
                        {"close up", 0.1f, {"edgelength", 0.7}}};

Param number(const std::string& type, const std::string& name, std::vector<double> values) {
    Param param;
    param.type = type;
    param.name = name;
    param.numbers = std::move(values);
    return param;
}

/// A satin's highlight along the warp, on a dull ground: what shows a wrong frame most.
std::shared_ptr<const TableBsdf> satin() {
    const auto intensity = [](const IncidentDirection& in, const glm::dvec3& out, size_t) {
        if (out.z < 0)
            return 0.0;
        const glm::dvec3 light = spherical_direction(in.theta, in.phi);
        const glm::dvec3 half = glm::normalize(light + out);
        return out.z * (0.1 + std::exp(-square(half.y / 0.1)));
    };
    return std::make_shared<const TableBsdf>(tests::synthetic_table(intensity, 0.0), "satin.bsdf");
}

struct Built {
    Scene scene;
    size_t triangles;
    double seconds;
};

/// Moves the camera towards what it sees in the middle of the frame, to `share` of the distance.
void approach(Camera& camera, const GltfModel& model, float share) {
    const glm::vec3 eye(camera.to_world[3]), forward(camera.to_world[2]);
    float nearest = std::numeric_limits<float>::infinity();
    for (const GltfPart& part : model.parts)
        for (const glm::vec3& p : part.mesh.positions) {
            const float along = glm::dot(p - eye, forward);
            if (glm::distance(p, eye + along * forward) < 0.02f * along)
                nearest = std::min(nearest, along);
        }
    camera.to_world[3] = glm::vec4(eye + (1 - share) * nearest * forward, 1);
}

Built build(const std::filesystem::path& model, const View& view, const std::string& parameter,
            double value) {
    SceneDescription scene = describe_model(model, {512, 512});
    if (view.distance < 1)
        approach(scene.camera, *scene.shapes.back().model, view.distance);
    scene.settings.max_depth = 1;
    scene.shapes.back().params.add(
        number(parameter == "level" ? "integer" : "float", parameter, {value}));
    BuildOptions options;
    options.cloths[""] = "satin.bsdf";
    static const auto table = satin();
    options.load_table = [](const auto&, const auto&) { return table; };

    std::vector<std::string> warnings;
    const auto start = std::chrono::steady_clock::now();
    Built built{build_scene(scene, options, warnings), 0, 0};
    built.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    for (const Surface& surface : built.scene.surfaces()) // the lamp has two
        built.triangles += surface.mesh->triangles.size();
    return built;
}

Image picture(Scene& scene, int samples, uint64_t seed) {
    scene.settings.samples = samples;
    scene.settings.seed = seed;
    return render(scene).image();
}

/// RMS difference of two pictures over the mean of the first, of the pixels where that shows
/// something.
double difference(const Image& image, const Image& other) {
    double squares = 0, sum = 0, count = 0;
    const auto &green = *image.find("G"), &depth = *image.find("Z"), &found = *other.find("G");
    for (size_t i = 0; i < green.size(); ++i)
        if (depth[i] > 0) {
            squares += square(double{found[i]} - double{green[i]});
            sum += green[i];
            ++count;
        }
    return std::sqrt(squares / count) / (sum / count);
}

} // namespace
} // namespace rapport

int main(int count, char** arguments) {
    using namespace rapport;
    std::puts("model,curve,parameter,triangles,seconds,error");
    for (int i = 1; i < count; ++i)
        for (const View& view : kViews) {
            const std::filesystem::path model = arguments[i];
            const std::string name = model.stem().string() + ", " + view.name;
            const auto& [finest, finest_value] = view.finest;
            Scene reference = build(model, view, finest, finest_value).scene;
            const Image truth = picture(reference, kSamples, 0);
            std::printf("\"%s\",noise,0,0,0,%.6f\n", name.c_str(),
                        difference(picture(reference, kNoiseSamples, 1),
                                   picture(reference, kNoiseSamples, 2)) /
                            std::sqrt(2.0));
            const auto row = [&](const std::string& parameter, double value) {
                Built made = build(model, view, parameter, value);
                std::printf("\"%s\",%s,%g,%zu,%.4f,%.6f\n", name.c_str(), parameter.c_str(), value,
                            made.triangles, made.seconds,
                            difference(truth, picture(made.scene, kSamples, 0)));
                std::fflush(stdout);
            };
            for (const double level : {0, 1, 2, 3, 4, 6, 8, 12})
                row("level", level);
            for (const double pixels : {32.0, 16.0, 8.0, 6.0, 4.0, 3.0, 2.0, 1.5, 1.0})
                row("edgelength", pixels);
        }
}
