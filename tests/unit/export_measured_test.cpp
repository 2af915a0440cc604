#include "materials/table/export_measured.h"

#include "materials/table/measured_brdf.h"
#include "materials/table/table_bsdf.h"
#include "renderer/core/error.h"
#include "renderer/core/rng.h"
#include "tests/support/synthetic_tables.h"
#include "tests/support/temporary_folder.h"

#include <atomic>
#include <gtest/gtest.h>

namespace rapport {
namespace {

/// A streak along the direction at 30° from the weft, without mirror symmetry.
double streak(const IncidentDirection& from, const glm::dvec3& out, size_t band) {
    const bool reflected = (out.z > 0) == (from.side == Side::front);
    constexpr double kDiffuse[] = {0.25, 0.1, 0.05};
    if (!reflected)
        return 0.3 * kDiffuse[band % 3] * std::abs(out.z);
    const glm::dvec3 sum = spherical_direction(from.theta, from.phi) + out;
    const double across = 0.866 * sum.x + 0.5 * sum.y, along = 0.866 * sum.y - 0.5 * sum.x;
    return kDiffuse[band % 3] / kPi * std::abs(out.z) +
           0.3 * std::exp(-square(across / 0.9) - square(along / 0.35));
}
const BsdfTable& table() {
    static const BsdfTable made = tests::synthetic_table(streak, 0.05);
    return made;
}

/// RMS difference over the mean, at directions between all nodes; of the mirrored cloth if wanted.
double difference(const MeasuredFields& fields, const BsdfTable& of, bool mirrored = false) {
    const MeasuredBrdf file(fields);
    const TableBsdf truth(of, "");
    const glm::vec3 mirror(1, mirrored ? -1 : 1, 1);
    double squares = 0, sum = 0;
    int count = 0;
    for (double theta = 4; theta < 80; theta += 13)
        for (double phi = 2; phi < 360; phi += 37)
            for (double theta_o = 3; theta_o < 88; theta_o += 6)
                for (double phi_o = 0; phi_o < 360; phi_o += 11, ++count) {
                    const glm::vec3 eye(spherical_direction(radians(theta), radians(phi)));
                    const glm::vec3 light(spherical_direction(radians(theta_o), radians(phi_o)));
                    const Rgb expected = truth.eval(mirror * eye, mirror * light);
                    squares += square(glm::distance(file.eval_and_pdf(eye, light).value, expected));
                    sum += glm::length(expected);
                }
    return std::sqrt(squares * count) / sum;
}

TEST(ExportMeasured, IsTheReflectionOfTheFace) {
    const MeasuredFields fields = measured_fields(table(), "streak", MeasuredColours::rgb);
    EXPECT_LT(difference(fields, table()), 0.05);
    EXPECT_GT(difference(fields, table(), true), 0.3);

    EXPECT_FLOAT_EQ(fields.phi.front(), -static_cast<float>(kPi)); // the whole circle, as pbrt asks
    EXPECT_FLOAT_EQ(fields.phi.back(), static_cast<float>(kPi));
    EXPECT_TRUE(fields.wavelengths.empty()); // Mitsuba's RGB variants refuse a file that has them
}

TEST(ExportMeasured, KeepsTheEnergyAndTellsWhatItLost) {
    const tests::TemporaryFolder folder;
    std::atomic<double> progress = 0;
    const MeasuredLosses losses =
        export_measured(table(), "streak", MeasuredColours::rgb, folder / "a.bsdf",
                        [&](double fraction) { progress = fraction; });
    EXPECT_EQ(progress, 1);
    EXPECT_TRUE(is_measured_file(folder / "a.bsdf"));
    EXPECT_NEAR(losses.unscattered, 0.05, 1e-6);
    EXPECT_NEAR(losses.transmitted, 0.3 * kPi * (0.25 + 0.1 + 0.05) / 3, 1e-3);
    // The cloth is alike on both sides; its table, about the warp on one and the weft on the other,
    // has other bins that the streak is integrated over.
    EXPECT_NEAR(losses.back_transmitted, losses.transmitted, 1e-4);
    EXPECT_NEAR(losses.back_reflected, losses.kept, 1e-4);
    EXPECT_GT(losses.kept, 0.1);
    std::printf("%.1f MB: resolution %.4f, albedo within %.4f\n",
                1e-6 * double(std::filesystem::file_size(folder / "a.bsdf")), losses.resolution,
                losses.largest_albedo_error);
    EXPECT_LT(losses.resolution, 0.06);
    EXPECT_LT(losses.largest_albedo_error, 0.1);

    const MeasuredBrdf file(read_measured(folder / "a.bsdf"));
    const TableBsdf truth(table(), "");
    for (const double theta : {0.0, 33.0, 77.0}) {
        const glm::vec3 eye(spherical_direction(radians(theta), 0.4));
        glm::dvec3 reflected(0);
        constexpr int kSteps = 200;
        for (int i = 0; i < kSteps; ++i)
            for (int j = 0; j < kSteps; ++j)
                reflected +=
                    truth.eval(eye, glm::vec3(spherical_direction(std::acos((i + 0.5) / kSteps),
                                                                  2 * kPi * (j + 0.5) / kSteps))) *
                    static_cast<float>(2 * kPi / square(kSteps));
        for (int channel = 0; channel < 3; ++channel)
            EXPECT_NEAR(file.albedo(eye)[channel] / reflected[channel], 1, 0.01);
    }
}

/// The largest of the luminances of weights over that of the albedo, of grazing eyes between the
/// file's incidences.
float largest_weight(const MeasuredBrdf& file) {
    float largest = 0;
    CounterRng rng(1, Purpose::test, 0, 0);
    for (int i = 0; i < 400000; ++i) {
        const auto turn = static_cast<float>(2 * kPi * (i % 64 + 0.3) / 64);
        const glm::vec3 eye = spherical_direction(radians(87.0f + 0.7f * float(i % 4)), turn);
        const glm::vec3 light = file.sample(eye, {rng.uniform_float(), rng.uniform_float()});
        const MeasuredBrdf::Value both = file.eval_and_pdf(eye, light);
        if (both.pdf > 0)
            largest =
                std::max(largest, luminance(both.value) / both.pdf / luminance(file.albedo(eye)));
    }
    return largest;
}

TEST(ExportMeasured, WeighsNoSampleMuchHeavierThanAnother) {
    MeasuredFields fields = measured_fields(table(), "streak", MeasuredColours::rgb);
    const float largest = largest_weight(MeasuredBrdf(fields));
    // The wrong twin: a density that ends with the last nodes above the horizon.
    size_t i = 0;
    for (const float phi : fields.phi)
        for (const float theta : fields.theta)
            for (size_t row = 0; row < fields.vndf.rows; ++row)
                for (size_t column = 0; column < fields.vndf.columns; ++column, ++i) {
                    const glm::vec3 eye = spherical_direction(theta, phi);
                    const glm::vec3 m =
                        measured_direction({float(column) / float(fields.vndf.columns - 1),
                                            float(row) / float(fields.vndf.rows - 1)});
                    if ((2 * glm::dot(m, eye) * m - eye).z <= 0)
                        fields.vndf.values[i] = 0;
                }
    const float of_twin = largest_weight(MeasuredBrdf(fields));
    std::printf("largest weight over the albedo %.2f, where the density ends early %.2f\n", largest,
                of_twin);
    EXPECT_LT(largest, 15);
    EXPECT_GT(of_twin, 3 * largest);
}

TEST(ExportMeasured, SpectraOfAnRgbTableHaveItsColours) {
    const BsdfTable small = tests::small_synthetic_table(streak);
    const MeasuredFields fields = measured_fields(small, "", MeasuredColours::spectra);
    EXPECT_TRUE(fields.rgb.empty());
    EXPECT_EQ(fields.wavelengths.size(), 3u);
    const MeasuredBrdf rgb(measured_fields(small, "", MeasuredColours::rgb)), spectra(fields);
    const glm::vec3 eye(spherical_direction(0.5, 0.4)), light(spherical_direction(0.3, 2.0));
    for (int channel = 0; channel < 3; ++channel)
        EXPECT_NEAR(spectra.eval_and_pdf(eye, light).value[channel],
                    rgb.eval_and_pdf(eye, light).value[channel], 1e-4);
}

TEST(ExportMeasured, SpectralTablesKeepTheirBands) {
    const BsdfTable spectral = tests::small_synthetic_table(
        [](const IncidentDirection&, const glm::dvec3& out, size_t band) {
            return 0.03 * double(band + 1) * std::abs(out.z);
        },
        0, Bands::from_edges({400, 450, 500, 600, 700}));
    const MeasuredFields fields = measured_fields(spectral, "", MeasuredColours::spectra);
    EXPECT_EQ(fields.wavelengths, (std::vector<float>{425, 475, 550, 650}));
    const size_t slice = fields.spectra.rows * fields.spectra.columns;
    const size_t node = 7 * slice / 16; // of the first incidence: the ratios are those of the bands
    for (size_t band = 1; band < 4; ++band)
        EXPECT_NEAR(fields.spectra.values[band * slice + node] / fields.spectra.values[node],
                    double(band + 1), 1e-3);
}

TEST(ExportMeasured, RefusesAPartialTable) {
    EXPECT_THROW(measured_fields(make_partial_table(Bands{}, {{}}), "x", MeasuredColours::rgb),
                 FileError);
}

} // namespace
} // namespace rapport
