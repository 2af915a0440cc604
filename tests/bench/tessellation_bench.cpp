#include "materials/table/table_bsdf.h"
#include "renderer/integrator/path_tracer.h"
#include "renderer/scene/model_scene.h"
#include "renderer/scene/scene_builder.h"
#include "tests/support/synthetic_tables.h"

#include <chrono>
#include <cstdio>

// What finer tessellation buys: lines of model, curve, parameter (pixels, or pieces to an edge),
// triangles, seconds to build the scene, and error of the picture: RMS difference from the finest
// over the mean, of the pixels that show the model. All pictures, of 512², have the same random
// numbers, so that hardly more than their geometry differs; "noise" is what 64 samples a pixel
// leave for comparison. charts/tessellation.py draws them:
//
//   build/tests/tests/tessellation_bench scenes/garments/dress.glb |
//       python3 tests/bench/charts/tessellation.py

namespace rapport {
namespace {

constexpr int kReferenceLevel = 16;
constexpr int kSamples = 16;

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

struct Measured {
    Image image;
    size_t triangles = 0;
    double seconds = 0;
};

Measured picture(const std::filesystem::path& model, const std::string& parameter, double value) {
    SceneDescription scene = describe_model(model, {512, 512});
    scene.settings.samples = kSamples;
    scene.settings.max_depth = 1;
    scene.shapes.back().params.add(
        number(parameter == "level" ? "integer" : "float", parameter, {value}));
    BuildOptions options;
    options.cloths[""] = "satin.bsdf";
    static const auto table = satin();
    options.load_table = [](const auto&, const auto&) { return table; };

    std::vector<std::string> warnings;
    const auto start = std::chrono::steady_clock::now();
    const Scene built = build_scene(scene, options, warnings);
    Measured result;
    result.seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    for (const Surface& surface : built.surfaces()) // the lamp has two
        result.triangles += surface.mesh->triangles.size();
    result.image = render(built).image();
    return result;
}

/// √(mean of `square_of(pixel)`) over the mean of `image`, of the pixels that show something.
template <class Square> double relative_rms(const Image& image, const Square& square_of) {
    double squares = 0, sum = 0, count = 0;
    const auto &green = *image.find("G"), &depth = *image.find("Z");
    for (size_t i = 0; i < green.size(); ++i)
        if (depth[i] > 0) {
            squares += square_of(i);
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
    for (int i = 1; i < count; ++i) {
        const std::filesystem::path model = arguments[i];
        const Image reference = picture(model, "level", kReferenceLevel).image;
        const auto& truth = *reference.find("G");
        const auto& variance = *reference.find("variance.G");
        std::printf("%s,noise,0,0,0,%.6f\n", model.stem().c_str(),
                    relative_rms(reference, [&](size_t i) { return variance[i] * kSamples / 64; }));
        const auto row = [&](const std::string& parameter, double value) {
            const Measured made = picture(model, parameter, value);
            std::printf("%s,%s,%g,%zu,%.4f,%.6f\n", model.stem().c_str(), parameter.c_str(), value,
                        made.triangles, made.seconds, relative_rms(reference, [&](size_t i) {
                            return square(double{(*made.image.find("G"))[i]} - double{truth[i]});
                        }));
            std::fflush(stdout);
        };
        for (const double level : {0, 1, 2, 3, 4, 6, 8, 12})
            row("level", level);
        for (const double pixels : {32.0, 16.0, 8.0, 6.0, 4.0, 3.0, 2.0, 1.5, 1.0, 0.7})
            row("edgelength", pixels);
    }
}
