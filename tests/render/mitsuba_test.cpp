#include "materials/table/export_measured.h"
#include "materials/table/table_bsdf.h"
#include "renderer/core/image.h"
#include "tests/support/file_bytes.h"
#include "tests/support/long_run.h"
#include "tests/support/run_program.h"
#include "tests/support/synthetic_tables.h"
#include "tests/support/temporary_folder.h"

#include <cstdlib>
#include <fmt/format.h>
#include <gtest/gtest.h>

// Mitsuba 3 renders what `export --to mitsuba` writes, where it is installed (pip install mitsuba):
// its pictures must be ours of the same cloth's reflection.

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

class Mitsuba : public testing::Test {
  protected:
    void SetUp() override {
        if (std::system("python3 -c 'import mitsuba' 2>/dev/null") != 0)
            GTEST_SKIP() << "python3 has no mitsuba";
        tests::write_bytes(folder_ / "hills.ply", hills());
    }

    Image by_mitsuba(const std::string& file, int seed) {
        const std::string out = (folder_ / "mitsuba.exr").string();
        const std::string command =
            fmt::format("python3 {}/tests/render/mitsuba_render.py {} {} {} {} {} {} >/dev/null",
                        RAPPORT_SOURCE_DIR, (folder_ / "hills.ply").string(),
                        (folder_ / file).string(), out, kSize, samples(), seed);
        if (std::system(command.c_str()) != 0)
            throw std::runtime_error("Mitsuba failed: " + command);
        return read_exr(out);
    }

    Image by_us(const std::string& material, int seed) {
        const std::string out = (folder_ / "rapport.exr").string();
        tests::write_bytes(
            folder_ / "scene.pbrt",
            fmt::format(
                "Scale -1 1 1\nLookAt 0.8 -2.6 3  0 0 0  0 0 1\n"
                "Camera \"perspective\" \"float fov\" 30\n"
                "Film \"rgb\" \"integer xresolution\" {0} \"integer yresolution\" {0}\n"
                "Sampler \"independent\" \"integer pixelsamples\" {1}\n"
                "Integrator \"path\" \"integer maxdepth\" 1\nWorldBegin\n"
                "LightSource \"infinite\" \"rgb L\" [0.3 0.3 0.3]\n"
                "LightSource \"distant\" \"rgb L\" [0.6 0.6 0.6] \"point3 from\" [-1.5 1.5 2.5] "
                "\"point3 to\" [0 0 0]\n"
                "Material {2}\nShape \"plymesh\" \"string filename\" \"hills.ply\"\n",
                kSize, samples(), material));
        const tests::ProgramRun run = tests::run_program(
            {"render", "scene.pbrt", "-o", out, "--quiet", "--seed", std::to_string(seed)},
            folder_.path().string());
        EXPECT_EQ(run.status, 0) << run.err;
        return read_exr(out);
    }

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

    tests::TemporaryFolder folder_;
};

TEST_F(Mitsuba, RendersTheExportAsWeRenderTheCloth) {
    const auto export_as = [&](const char* file, const tests::Intensity& intensity) {
        write_measured(
            measured_fields(tests::synthetic_table(intensity), file, MeasuredColours::rgb),
            folder_ / file);
        return std::array{by_mitsuba(file, 1), by_mitsuba(file, 2)};
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

    const std::string measured = "\"measured\" \"string filename\" \"measured.bsdf\"";
    const double same_file = rms_difference({by_us(measured, 3), by_us(measured, 4)}, theirs);
    std::printf("the same file here and in Mitsuba: RMS %.4f\n", same_file);
    EXPECT_LT(same_file, 0.005);
}

} // namespace
} // namespace rapport
