#include "materials/table/export_radiance.h"
#include "materials/table/table_bsdf.h"
#include "renderer/core/rng.h"
#include "tests/support/run_program.h"
#include "tests/support/synthetic_tables.h"
#include "tests/support/temporary_folder.h"

#include <cstdlib>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

// Radiance itself reads what `export --to radiance` writes, where its programs are installed (pip
// install pyradiance numpy): what it sees of light from one direction in another must be the
// table's.

namespace rapport {
namespace {

double mirrored(const IncidentDirection& from, const glm::dvec3& out, size_t band) {
    return tests::slanted_intensity({from.side, from.theta, -from.phi}, {out.x, -out.y, out.z},
                                    band);
}
double turned_over(const IncidentDirection& from, const glm::dvec3& out, size_t band) {
    return tests::slanted_intensity(
        {from.side == Side::front ? Side::back : Side::front, from.theta, from.phi},
        {out.x, out.y, -out.z}, band);
}

struct Pair {
    glm::vec3 eye, light;
};

/// On all four ways, off the horizon.
std::vector<Pair> pairs() {
    std::vector<Pair> pairs;
    for (int i = 0; i < 24; ++i) {
        CounterRng rng(0, Purpose::test, 0, i);
        const auto direction = [&](bool up) {
            const float theta = 1.2f * rng.uniform_float();
            const glm::vec3 w =
                spherical_direction(theta, static_cast<float>(2 * kPi) * rng.uniform_float());
            return up ? w : -w;
        };
        const glm::vec3 eye = direction(i % 2 == 0);
        pairs.push_back({eye, direction(i / 2 % 2 == 0)});
    }
    return pairs;
}

nlohmann::json list(const glm::vec3& v) { return {v.x, v.y, v.z}; }

TEST(Radiance, SeesOfTheExportWhatTheTableSays) {
    if (std::system("python3 -c 'import pyradiance, numpy' 2>/dev/null") != 0)
        GTEST_SKIP() << "python3 has no pyradiance or no numpy";
    const tests::TemporaryFolder folder;
    nlohmann::json asked;
    for (const Pair& pair : pairs())
        asked.push_back({list(pair.eye), list(pair.light)});
    const auto by_radiance = [&](const tests::Intensity& intensity) {
        export_radiance(tests::synthetic_table(intensity), "cloth", folder / "cloth.xml");
        const tests::ProgramRun run =
            tests::run_executable("python3", {RAPPORT_SOURCE_DIR "/tests/render/radiance_render.py",
                                              (folder / "cloth.xml").string(), asked.dump()});
        EXPECT_EQ(run.status, 0) << run.err;
        return nlohmann::json::parse(run.out).get<std::vector<double>>();
    };
    const TableBsdf table(tests::synthetic_table(tests::slanted_intensity), "");
    std::vector<double> ours;
    for (const Pair& pair : pairs())
        ours.push_back(luminance(table.eval(pair.eye, pair.light)) / std::abs(pair.light.z));
    const auto rms_difference = [&](const std::vector<double>& theirs) {
        double squares = 0, sum = 0;
        for (size_t i = 0; i < ours.size(); ++i) {
            squares += square(theirs[i] - ours[i]);
            sum += square(ours[i]);
        }
        return std::sqrt(squares / sum);
    };
    const double same = rms_difference(by_radiance(tests::slanted_intensity));
    const double of_mirrored = rms_difference(by_radiance(mirrored));
    const double of_turned_over = rms_difference(by_radiance(turned_over));
    std::printf("RMS difference %.4f; mirrored %.4f, turned over %.4f\n", same, of_mirrored,
                of_turned_over);
    EXPECT_LT(same, 0.05);
    EXPECT_GT(of_mirrored, 0.1);
    EXPECT_GT(of_turned_over, 0.1);
}

} // namespace
} // namespace rapport
