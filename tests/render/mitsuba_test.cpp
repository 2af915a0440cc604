#include "materials/table/export_measured.h"
#include "materials/table/table_bsdf.h"
#include "renderer/core/image.h"
#include "tests/support/file_bytes.h"
#include "tests/support/long_run.h"
#include "tests/support/run_program.h"
#include "tests/support/shared_data.h"
#include "tests/support/synthetic_tables.h"
#include "tests/support/temporary_folder.h"

#include <cstdlib>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

// Mitsuba 3 renders the same scenes where it is installed (pip install mitsuba numpy): its pictures
// must be ours, of usual materials and of what `export --to mitsuba` writes of a cloth.

namespace rapport {
namespace {

const int kSize = 32;

/// A cloth with a streak of a highlight that lies turned by 30°, and lets nothing pass: it has no
/// mirror symmetry, so that an azimuth that counts the wrong way shows.
double turned_satin(const IncidentDirection& from, const glm::dvec3& out, size_t band) {
    if ((out.z > 0) != (from.side == Side::front))
        return 0;
    constexpr double kDiffuse[] = {0.25, 0.1, 0.05};
    const glm::dvec3 sum = spherical_direction(from.theta, from.phi) + out;
    const double angle = radians(30.0), c = std::cos(angle), s = std::sin(angle);
    const double across = (c * sum.x + s * sum.y) / 0.9, along = (c * sum.y - s * sum.x) / 0.2;
    return kDiffuse[band] / kPi * std::abs(out.z) + 0.5 * std::exp(-square(across) - square(along));
}
double mirrored_satin(const IncidentDirection& from, const glm::dvec3& out, size_t band) {
    return turned_satin({from.side, from.theta, -from.phi}, {out.x, -out.y, out.z}, band);
}
double quarter_turned_satin(const IncidentDirection& from, const glm::dvec3& out, size_t band) {
    return turned_satin({from.side, from.theta, from.phi - kPi / 2}, {out.y, -out.x, out.z}, band);
}

/// A wavy sheet, facets as they are. Warp and weft stay at right angles: where they do not, Mitsuba
/// keeps ∂P/∂u and we ∂P/∂v.
std::string hills() {
    constexpr int kSteps = 24;
    std::string text = fmt::format("ply\nformat ascii 1.0\nelement vertex {}\nproperty float x\n"
                                   "property float y\nproperty float z\nproperty float u\n"
                                   "property float v\nelement face {}\n"
                                   "property list uchar int vertex_indices\nend_header\n",
                                   (kSteps + 1) * (kSteps + 1), 2 * kSteps * kSteps);
    for (int j = 0; j <= kSteps; ++j)
        for (int i = 0; i <= kSteps; ++i) {
            const double u = double(i) / kSteps, v = double(j) / kSteps;
            text +=
                fmt::format("{} {} {} {} {}\n", 2 * u - 1, 2 * v - 1, 0.15 * std::sin(9 * v), u, v);
        }
    for (int j = 0; j < kSteps; ++j)
        for (int i = 0; i < kSteps; ++i) {
            const int a = j * (kSteps + 1) + i, b = a + kSteps + 1;
            text += fmt::format("3 {} {} {}\n3 {} {} {}\n", a, a + 1, b, a + 1, b + 1, b);
        }
    return text;
}

/// The shared sheet of 199,712 triangles without its normals: where they are smooth, and light is
/// on one side by them and on the other by the triangle, Mitsuba lets it through and we mirror it.
std::string flat_sheet(const std::filesystem::path& path) {
    const std::string file = tests::read_bytes(path), end = "end_header\n";
    std::string header = file.substr(0, file.find(end) + end.size());
    const char* vertex = file.data() + header.size();
    const size_t vertices = std::stoul(header.substr(header.find("vertex ") + 7));
    for (const std::string name : {"nx", "ny", "nz"}) {
        const std::string line = "property float " + name + "\n";
        header.erase(header.find(line), line.size());
    }
    constexpr size_t kPosition = 12, kNormal = 12, kUv = 8;
    for (size_t i = 0; i < vertices; ++i, vertex += kPosition + kNormal + kUv)
        header.append(vertex, kPosition).append(vertex + kPosition + kNormal, kUv);
    return header.append(vertex, file.data() + file.size());
}

/// A mesh, its triangles flat, under an even sky, and perhaps a sun.
struct World {
    std::string mesh;
    glm::vec3 eye, centre;
    float fov; ///< [degrees]
    float sky; ///< radiance
    float sun; ///< irradiance
};

class Mitsuba : public testing::Test {
  protected:
    void SetUp() override {
        if (std::system("python3 -c 'import mitsuba, numpy' 2>/dev/null") != 0)
            GTEST_SKIP() << "python3 has no mitsuba or no numpy";
        tests::write_bytes(folder_ / "hills.ply", hills());
    }

    Image by_mitsuba(const World& world, const nlohmann::json& bsdf, int seed, int bounces,
                     const char* variant = "scalar_rgb") {
        const auto list = [](const glm::vec3& v) { return nlohmann::json{v.x, v.y, v.z}; };
        const nlohmann::json scene{
            {"mesh", world.mesh},      {"eye", list(world.eye)}, {"centre", list(world.centre)},
            {"fov", world.fov},        {"sky", world.sky},       {"sun", list(kTowardsSun)},
            {"irradiance", world.sun}, {"bsdf", bsdf},           {"bounces", bounces}};
        const std::string out = (folder_ / "mitsuba.exr").string();
        const std::string command =
            fmt::format("python3 {}/tests/render/mitsuba_render.py {} '{}' {} {} {} {} >/dev/null",
                        RAPPORT_SOURCE_DIR, variant, scene.dump(), out, kSize, samples(), seed);
        if (std::system(command.c_str()) != 0)
            throw std::runtime_error("Mitsuba failed: " + command);
        return read_exr(out);
    }
    /// The hills, directly lit.
    Image by_mitsuba(const nlohmann::json& bsdf, int seed, const char* variant = "scalar_rgb") {
        return by_mitsuba(hills_, bsdf, seed, 1, variant);
    }

    nlohmann::json measured(const std::string& file) const {
        return {{"type", "measured"}, {"filename", (folder_ / file).string()}};
    }

    Image by_us(const World& world, const std::string& material, int seed, int bounces) {
        const std::string out = (folder_ / "rapport.exr").string();
        const auto list = [](const glm::vec3& v) { return fmt::format("{} {} {}", v.x, v.y, v.z); };
        std::string scene = fmt::format(
            "Scale -1 1 1\nLookAt {0}  {1}  0 0 1\nCamera \"perspective\" \"float fov\" {2}\n"
            "Film \"rgb\" \"integer xresolution\" {3} \"integer yresolution\" {3}\n"
            "Sampler \"independent\" \"integer pixelsamples\" {4}\n"
            "Integrator \"path\" \"integer maxdepth\" {5}\nWorldBegin\n"
            "LightSource \"infinite\" \"rgb L\" [{6} {6} {6}]\n",
            list(world.eye), list(world.centre), world.fov, kSize, samples(), bounces, world.sky);
        if (world.sun > 0)
            scene += fmt::format("LightSource \"distant\" \"rgb L\" [{0} {0} {0}] "
                                 "\"point3 from\" [{1}] \"point3 to\" [0 0 0]\n",
                                 world.sun, list(kTowardsSun));
        scene += fmt::format("Material {}\nShape \"plymesh\" \"string filename\" \"{}\"\n",
                             material, world.mesh);
        tests::write_bytes(folder_ / "scene.pbrt", scene);
        const tests::ProgramRun run = tests::run_program(
            {"render", "scene.pbrt", "-o", out, "--quiet", "--seed", std::to_string(seed)},
            folder_.path().string());
        EXPECT_EQ(run.status, 0) << run.err;
        return read_exr(out);
    }
    Image by_us(const std::string& material, int seed) { return by_us(hills_, material, seed, 1); }

    static int samples() { return tests::long_run() ? 4096 : 1024; }

    /// RMS difference of the expectations of two pictures over the mean of the first, each rendered
    /// twice: the product of two independent differences has no noise in its mean.
    static double rms_difference(const std::array<Image, 2>& a, const std::array<Image, 2>& b) {
        double squares = 0, mean = 0;
        for (const char* channel : {"R", "G", "B"})
            for (int i = 0; i < kSize * kSize; ++i) {
                const double difference[2] = {(*a[0].find(channel))[i] - (*b[0].find(channel))[i],
                                              (*a[1].find(channel))[i] - (*b[1].find(channel))[i]};
                squares += difference[0] * difference[1];
                mean += (*a[0].find(channel))[i];
            }
        return std::sqrt(std::max(squares, 0.0) * 3 * kSize * kSize) / mean;
    }

    /// Pictures of the two must agree of the same material, and not of nearly the same.
    void check(const World& world) {
        constexpr int kBounces = 5;
        using Json = nlohmann::json;
        const auto rgb = [](const std::vector<double>& value) {
            return Json{{"type", "rgb"}, {"value", value}};
        };
        const auto diffuse = [&](double red) {
            return Json{{"type", "diffuse"}, {"reflectance", rgb({red, 0.5, 0.2})}};
        };
        // Of copper, hardly rough: Mitsuba masks light and eye apart, we and pbrt both at once,
        // which for a roughness of 0.3 seen along the sheet is told apart.
        const auto conductor = [&](double alpha) {
            return Json{{"type", "roughconductor"},
                        {"distribution", "ggx"},
                        {"alpha", alpha},
                        {"eta", rgb({0.2, 0.92, 1.1})},
                        {"k", rgb({3.91, 2.45, 2.14})}};
        };
        struct Case {
            std::string ours;
            Json same, other;
        };
        for (const Case& material :
             {Case{"\"diffuse\" \"rgb reflectance\" [0.7 0.5 0.2]", diffuse(0.7), diffuse(0.71)},
              {"\"conductor\" \"rgb eta\" [0.2 0.92 1.1] \"rgb k\" [3.91 2.45 2.14] "
               "\"float roughness\" 0.15 \"bool remaproughness\" false",
               conductor(0.15), conductor(0.17)}}) {
            const Image ours = by_us(world, material.ours, 5, kBounces);
            const auto difference = [&](const Json& bsdf) {
                return compare(
                    ours, by_mitsuba(world, {{"type", "twosided"}, {"bsdf", bsdf}}, 6, kBounces));
            };
            const ImageDifference same = difference(material.same),
                                  other = difference(material.other);
            std::printf(
                "%s: p %.2g, offset of the mean %.2f standard errors; nearly the same: p %.2g\n",
                material.ours.c_str(), same.p_value, same.mean_z, other.p_value);
            EXPECT_TRUE(same.tested);
            EXPECT_TRUE(same.agree) << material.ours;
            EXPECT_FALSE(other.agree) << material.ours;
        }
    }

    static inline const glm::vec3 kTowardsSun{-1.5f, 1.5f, 2.5f};
    tests::TemporaryFolder folder_;
    const World hills_{
        (folder_ / "hills.ply").string(), {0.8f, -2.6f, 3}, {0, 0, 0}, 30, 0.3f, 0.6f};
};

TEST_F(Mitsuba, RendersTheExportAsWeRenderTheCloth) {
    const auto export_as = [&](const char* file, const tests::Intensity& intensity) {
        write_measured(
            measured_fields(tests::synthetic_table(intensity), file, MeasuredColours::rgb),
            folder_ / file);
        return std::array{by_mitsuba(measured(file), 1), by_mitsuba(measured(file), 2)};
    };
    write_table(tests::synthetic_table(turned_satin), folder_ / "satin.bsdf");
    const std::string cloth = "\"cloth\" \"string filename\" \"satin.bsdf\"";
    const std::array ours{by_us(cloth, 1), by_us(cloth, 2)};

    const std::array theirs = export_as("measured.bsdf", turned_satin);
    const double difference = rms_difference(ours, theirs);
    std::printf("cloth here against its export in Mitsuba: RMS %.4f\n", difference);
    EXPECT_LT(difference, 0.02);
    // The wrong twins: a mirrored weave, and one turned by a quarter.
    const double mirrored = rms_difference(ours, export_as("mirrored.bsdf", mirrored_satin));
    const double turned = rms_difference(ours, export_as("turned.bsdf", quarter_turned_satin));
    std::printf("mirrored %.4f, turned %.4f\n", mirrored, turned);
    EXPECT_GT(mirrored, 0.1);
    EXPECT_GT(turned, 0.1);

    const std::string imported = "\"measured\" \"string filename\" \"measured.bsdf\"";
    const double same_file = rms_difference({by_us(imported, 3), by_us(imported, 4)}, theirs);
    std::printf("the same file here and in Mitsuba: RMS %.4f\n", same_file);
    EXPECT_LT(same_file, 0.005);
}

/// Ours as the spectral variants write theirs.
Image in_relative_xyz(Image image) {
    std::vector<float>&r = *image.find("R"), &g = *image.find("G"), &b = *image.find("B");
    for (size_t i = 0; i < r.size(); ++i) {
        const glm::vec3 xyz = relative_xyz({r[i], g[i], b[i]});
        r[i] = xyz.x;
        g[i] = xyz.y;
        b[i] = xyz.z;
    }
    return image;
}

TEST_F(Mitsuba, RendersTheSpectraOfTheExport) {
    const BsdfTable table = tests::synthetic_table(turned_satin);
    const auto theirs = [&](const char* file) {
        const auto render = [&](int seed) {
            return by_mitsuba(measured(file), seed, "scalar_spectral");
        };
        return std::array{render(1), render(2)};
    };
    MeasuredFields fields = measured_fields(table, "satin", MeasuredColours::spectra);
    write_measured(fields, folder_ / "spectra.bsdf");
    write_table(table, folder_ / "satin.bsdf");
    const auto ours = [&](const std::string& material) {
        return std::array{in_relative_xyz(by_us(material, 3)), in_relative_xyz(by_us(material, 4))};
    };
    const std::array cloth = ours("\"cloth\" \"string filename\" \"satin.bsdf\"");
    const std::array same_file = ours("\"measured\" \"string filename\" \"spectra.bsdf\"");
    const std::array spectral = theirs("spectra.bsdf");
    const double of_cloth = rms_difference(cloth, spectral);
    const double of_file = rms_difference(same_file, spectral);
    for (float& wavelength : fields.wavelengths) // the wrong twin: spectra that lie elsewhere
        wavelength += 10;
    write_measured(fields, folder_ / "shifted.bsdf");
    const double shifted = rms_difference(same_file, theirs("shifted.bsdf"));
    std::printf("X, Y, Z of the cloth here against its spectra in Mitsuba: RMS %.4f, of the same "
                "file %.4f, moved by 10 nm there %.4f\n",
                of_cloth, of_file, shifted);
    EXPECT_LT(of_cloth, 0.02);
    EXPECT_LT(of_file, 0.005);
    EXPECT_GT(shifted, 0.01);
}

TEST_F(Mitsuba, RendersDiffuseAndConductorAsWeDo) { check(hills_); }

TEST_F(Mitsuba, RendersTheSheetAsWeDo) {
    RAPPORT_SHARED_DATA_OR_SKIP(data);
    const std::filesystem::path sheet = folder_ / "sheet.ply";
    tests::write_bytes(sheet, flat_sheet(data.parent_path() / "bench" / "cloth200k.ply"));
    check({sheet.string(), {1.6f, -2.4f, 1.9f}, {0, 0, 0.15f}, 40, 1, 0});
}

} // namespace
} // namespace rapport
