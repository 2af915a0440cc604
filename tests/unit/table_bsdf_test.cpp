#include "materials/table/table_bsdf.h"

#include "materials/table/bin_reconstruction.h"
#include "renderer/core/error.h"
#include "renderer/core/rng.h"
#include "tests/support/synthetic_tables.h"

#include <functional>
#include <gtest/gtest.h>
#include <vector>

namespace rapport {
namespace {

using tests::satin_intensity;

glm::vec3 direction(double theta_degrees, double phi_degrees, Side side = Side::front) {
    const glm::dvec3 w = spherical_direction(radians(theta_degrees), radians(phi_degrees));
    return {w.x, w.y, side == Side::front ? w.z : -w.z};
}

const TableBsdf& satin() {
    static const TableBsdf bsdf(tests::synthetic_table(satin_intensity, 0.04), "satin.bsdf");
    return bsdf;
}

/// ∫ f over a bin of the front (or back) hemisphere, by a midpoint rule.
glm::dvec3 integrate_bin(const ExitBins& exits, size_t bin, Side side,
                         const std::function<Rgb(const glm::vec3&)>& f, int steps = 6) {
    glm::dvec3 sum(0);
    for (int i = 0; i < steps; ++i)
        for (int j = 0; j < steps; ++j) {
            glm::vec3 w(exits.direction(bin, (2 * i + 1.0) / steps - 1, (2 * j + 1.0) / steps - 1));
            w.z = side == Side::front ? w.z : -w.z;
            sum += glm::dvec3(f(w));
        }
    return sum * (exits.solid_angle(bin) / square(steps));
}

/// Eyes on both sides: on nodes, between them, at the pole, and beyond the last node.
std::vector<glm::vec3> eyes() {
    std::vector<glm::vec3> all;
    for (const Side side : {Side::front, Side::back})
        for (const auto& [theta, phi] :
             {std::pair(0.0, 0.0), {20.0, 45.0}, {33.0, 127.0}, {64.0, 352.0}, {89.5, 200.0}})
            all.push_back(direction(theta, phi, side));
    return all;
}

TEST(BinReconstruction, KeepsMeansAndStaysPositive) {
    const DirectionMesh mesh(12, 8);
    const ExitBins exits(mesh, spherical_direction(1.0, 2.0));
    CounterRng rng(3, Purpose::test, 0, 0);
    std::vector<Rgb> means; // noise with empty bins: the steepest slopes there are
    for (size_t bin = 0; bin < mesh.bins(); ++bin)
        means.emplace_back(rng.uniform_float(), rng.bits() % 3 ? 0 : 1, rng.bits() % 2 ? 0 : 5);
    means[17] = Rgb(0);
    const std::vector<BinPlane> planes = reconstruct(mesh, exits, means);
    ASSERT_EQ(planes.size(), mesh.bins());
    for (size_t bin = 0; bin < mesh.bins(); ++bin) {
        EXPECT_EQ(planes[bin].at(0, 0), means[bin]);
        EXPECT_LT(std::abs(planes[bin].slope_xi) + std::abs(planes[bin].slope_eta), 1);
    }
}

TEST(BinReconstruction, FollowsASmoothLobe) {
    // A lobe of 20° half-width at half maximum beside the highlights; error against piecewise
    // constant.
    const DirectionMesh mesh(36, 36);
    const ExitBins exits(mesh, glm::dvec3(0.3, 0.1, std::sqrt(0.9)));
    const glm::vec3 centre = direction(37, 20);
    const auto lobe = [&](const glm::vec3& w) {
        return std::exp(11.5f * (glm::dot(w, centre) - 1));
    };
    std::vector<Rgb> means;
    for (size_t bin = 0; bin < mesh.bins(); ++bin)
        means.emplace_back(integrate_bin(exits, bin, Side::front,
                                         [&](const glm::vec3& w) { return Rgb(lobe(w)); }) /
                           exits.solid_angle(bin));
    const std::vector<BinPlane> planes = reconstruct(mesh, exits, means);
    CounterRng rng(4, Purpose::test, 0, 0);
    double planar = 0, constant = 0;
    for (int i = 0; i < 100000; ++i) {
        const size_t bin = rng.bits() % mesh.bins();
        const float xi = 2 * rng.uniform_float() - 1, eta = 2 * rng.uniform_float() - 1;
        const float truth = lobe(glm::vec3(exits.direction(bin, xi, eta)));
        planar += square(planes[bin].at(xi, eta).r - truth) * exits.solid_angle(bin);
        constant += square(means[bin].r - truth) * exits.solid_angle(bin);
    }
    EXPECT_LT(planar, constant / square(4.0));
}

TEST(BinReconstruction, SamplesItsPlane) {
    // First moments of the density (1 + a·ξ + b·η)/4 over the square: a/3 and b/3.
    for (const auto& [a, b] : {std::pair(0.0f, 0.0f), {0.7f, -0.3f}, {-1.0f, 0.0f}, {0.0f, 1.0f}}) {
        constexpr int kSteps = 97, kTurns = 101; // coprime: no turn falls on a density throughout
        const auto middle = [](int i) { return (i + 0.5f) / kSteps; };
        double mean[2] = {0, 0};
        for (int i = 0; i < kSteps; ++i)
            for (int j = 0; j < kSteps; ++j)
                for (int k = 0; k < kTurns; ++k) {
                    const Float4 place = sample_plane(Float4{a, b}, Float4{middle(i), middle(j)},
                                                      four((k + 0.5f) / kTurns));
                    for (const int lane : {0, 1})
                        mean[lane] += (2 * place[lane] - 1) / (kTurns * square(kSteps));
                }
        EXPECT_NEAR(mean[0], a / 3, 1e-3) << a << " " << b;
        EXPECT_NEAR(mean[1], b / 3, 1e-3) << a << " " << b;
    }
}

TEST(TableBsdf, KeepsTheEnergyOfEveryBin) {
    // Eyes exactly on a node: each bin's integral is the stored mean times its solid angle.
    const TableBsdf& bsdf = satin();
    const BsdfTable& table = bsdf.table();
    for (const size_t d : {size_t{0}, size_t{30}, table.directions() / 2, table.directions() - 1}) {
        const IncidentDirection& from = table.incident[d];
        const glm::vec3 eye = direction(degrees(from.theta), degrees(from.phi), from.side);
        const ExitBins exits = table.exits_of(d);
        // A root is rounded by half a step of 1/65 535 of the largest density over the chart's
        // area, which moves a density x by √(x·largest)/65 535.
        const auto area = [&](size_t bin) {
            const DirectionMesh::Bounds b = table.exits.bounds(bin);
            return (b.u_high - b.u_low) * (b.v_high - b.v_low);
        };
        double largest = 0;
        for (int block = 0; block < 2; ++block)
            for (size_t bin = 0; bin < table.exits.bins(); ++bin)
                for (size_t band = 0; band < 3; ++band)
                    largest = std::max(largest, table.at(d, block, bin, band) *
                                                    exits.solid_angle(bin) / area(bin));
        for (int block = 0; block < 2; ++block)
            for (size_t bin = 0; bin < table.exits.bins(); ++bin) {
                const Side side =
                    (from.side == Side::front) == (block == 0) ? Side::front : Side::back;
                const glm::dvec3 flux =
                    integrate_bin(exits, bin, side,
                                  [&](const glm::vec3& light) { return bsdf.eval(eye, light); });
                for (size_t band = 0; band < 3; ++band) {
                    const double stored = table.at(d, block, bin, band) * exits.solid_angle(bin);
                    ASSERT_NEAR(flux[static_cast<int>(band)], stored,
                                std::sqrt(stored * largest * area(bin)) / 65535 + 1e-4 * stored)
                        << d << " " << block << " " << bin;
                }
            }
    }
}

TEST(TableBsdf, IntegralsAreAlbedoAndOne) {
    // In the eye's own bins the interpolant is a plane in each, which midpoints integrate exactly;
    // what is left is rounding, between the nodes as on them.
    const TableBsdf& bsdf = satin();
    const DirectionMesh& mesh = bsdf.table().exits;
    for (const glm::vec3& eye : eyes()) {
        // Beyond the last node the chart stands still.
        const double theta = std::min(std::acos(double(std::abs(eye.z))), radians(88.0));
        const ExitBins exits(mesh, spherical_direction(theta, azimuth(glm::dvec3(eye))),
                             bsdf.table().exit_axis[eye.z > 0 ? 0 : 1]);
        const Rgb albedo = bsdf.albedo(eye);
        glm::dvec3 scattered(0), density(0);
        for (const Side side : {Side::front, Side::back})
            for (size_t bin = 0; bin < mesh.bins(); ++bin) {
                scattered += integrate_bin(exits, bin, side, [&](const glm::vec3& light) {
                    return bsdf.eval(eye, light);
                });
                density += integrate_bin(exits, bin, side, [&](const glm::vec3& light) {
                    return Rgb(bsdf.pdf(eye, light));
                });
            }
        for (int channel = 0; channel < 3; ++channel)
            EXPECT_NEAR(scattered[channel], albedo[channel], 1e-5);
        EXPECT_NEAR(density.x, 1, 1e-5);
    }
}

TEST(TableBsdf, AlbedoLiesBetweenThatOfTheNodesAround) {
    const TableBsdf& bsdf = satin();
    const Rgb at_20 = bsdf.albedo(direction(20, 30)), at_30 = bsdf.albedo(direction(30, 30));
    const Rgb between = bsdf.albedo(direction(24, 30));
    EXPECT_NEAR(between.r, 0.6f * at_20.r + 0.4f * at_30.r, 1e-5);
    EXPECT_NE(at_20.r, at_30.r);
    EXPECT_EQ(bsdf.albedo(direction(89.9, 30)), bsdf.albedo(direction(88.5, 30)));
    // Round the circle: from 345° to 360° towards 0°.
    const Rgb last = bsdf.albedo(direction(40, 345)), first = bsdf.albedo(direction(40, 0));
    EXPECT_NEAR(bsdf.albedo(direction(40, 357)).g, 0.2f * last.g + 0.8f * first.g, 1e-5);
}

TEST(TableBsdf, NothingSpikesTowardsTheHorizon) {
    // From the last but one θ of the table to the horizon, all φ: the brightest light is as bright
    // as at one of the two nodes, albedo lies between theirs, and no light changes suddenly: in a
    // quarter of a degree by a 1/32 of the way between the nodes, and as the highlight moves.
    const TableBsdf& bsdf = satin();
    const BsdfTable& table = bsdf.table();
    const double low = degrees(table.grid_theta.end()[-2]), high = degrees(table.grid_theta.back());
    for (const Side side : {Side::front, Side::back})
        for (const double phi : {0.0, 7.0, 45.0, 90.0, 187.0, 262.0}) {
            std::vector<glm::vec3> lights;
            const ExitBins exits(table.exits, spherical_direction(radians(high), radians(phi)),
                                 table.exit_axis[static_cast<size_t>(side)]);
            for (size_t bin = 0; bin < table.exits.bins(); ++bin)
                for (const double xi : {-0.9, 0.0, 0.9})
                    for (const float up : {-1.0f, 1.0f}) {
                        lights.emplace_back(exits.direction(bin, xi, 0.5 * xi));
                        lights.back().z *= up;
                    }
            const auto seen = [&](double theta) {
                std::vector<float> intensity;
                for (const glm::vec3& light : lights)
                    intensity.push_back(bsdf.eval(direction(theta, phi, side), light).r);
                return intensity;
            };
            const auto albedo = [&](double theta) {
                return bsdf.albedo(direction(theta, phi, side)).r;
            };
            std::vector<float> before = seen(low);
            const float brightest =
                std::max(std::ranges::max(before), std::ranges::max(seen(high)));
            const auto [least, most] = std::minmax({albedo(low), albedo(high)});
            for (int step = 1; step <= 40; ++step) {
                const double theta = std::min(low + 0.25 * step, 89.99);
                const std::vector<float> now = seen(theta);
                for (size_t i = 0; i < now.size(); ++i) {
                    ASSERT_LE(now[i], 1.02f * brightest) << theta << " " << phi;
                    ASSERT_NEAR(now[i], before[i], 0.05f * brightest) << theta << " " << phi;
                }
                EXPECT_GE(albedo(theta), least - 1e-5f) << theta << " " << phi;
                EXPECT_LE(albedo(theta), most + 1e-5f) << theta << " " << phi;
                before = now;
            }
        }
}

TEST(TableBsdf, HighlightsMoveBetweenNodesInsteadOfDoubling) {
    // A narrow ridge on the cone of the warp, or on that of the weft. Half-way between nodes it
    // still stands where it should, as high as at a node; where a blend in place would leave its
    // double it has fallen. Charted about the wrong yarns it loses a fifth at least.
    constexpr double kWidth = 0.06;
    for (const int axis : {0, 1}) {
        const auto ridge = [&](const IncidentDirection& from, const glm::dvec3& out, size_t) {
            const glm::dvec3 in = spherical_direction(from.theta, from.phi);
            return 0.1 * std::exp(-square((in[axis] + out[axis]) / kWidth));
        };
        const auto charted = [&](ConeAxis about) {
            BsdfTable table = make_full_table(Bands{}, true, true);
            table.exit_axis = {about, about};
            tests::fill_table(table, ridge, 0);
            return TableBsdf(std::move(table), "");
        };
        const TableBsdf bsdf = charted(axis == 0 ? ConeAxis::weft : ConeAxis::warp);
        const TableBsdf wrong = charted(axis == 0 ? ConeAxis::warp : ConeAxis::weft);
        for (const double theta : {15.0, 35.0})
            for (const Side side : {Side::front, Side::back}) {
                const glm::vec3 node = direction(theta + 5, 45, side);
                const glm::vec3 eye = direction(theta, 45, side);
                for (const float beside : {-0.1f, 0.1f}) {
                    const auto on_ridge = [&](const glm::vec3& incident) {
                        glm::vec3 out(-incident.x, -incident.y, 0);
                        out[1 - axis] += beside;
                        out.z = std::sqrt(1 - glm::dot(out, out));
                        return out;
                    };
                    const float at_node = bsdf.eval(node, on_ridge(node)).g;
                    EXPECT_NEAR(bsdf.eval(eye, on_ridge(eye)).g, at_node, 0.15 * at_node);
                    EXPECT_LT(bsdf.eval(eye, on_ridge(node)).g, 0.8f * at_node);
                    EXPECT_LT(wrong.eval(eye, on_ridge(eye)).g, 0.8f * at_node);
                }
            }
    }
}

TEST(TableBsdf, SampleEvalAndPdfAgree) {
    // A sample has the value of the place that was drawn, from which its direction is rounded: by
    // 2e-6 of the chart's half (fast_angles.h), 3e-5 of half a row, which is 0.0625 wide. As much
    // of a plane's relative slope is forgiven, and, once in 10,000 at most, a step over an edge: 2
    // are expected, 10 are allowed (chance of more: 1e-5).
    const TableBsdf& bsdf = satin();
    CounterRng rng(6, Purpose::test, 0, 0);
    for (const glm::vec3& eye : eyes()) {
        const Rgb albedo = bsdf.albedo(eye);
        int over_edges = 0;
        for (int i = 0; i < 20000; ++i) {
            const auto sample =
                bsdf.sample(eye, rng.uniform_float(), {rng.uniform_float(), rng.uniform_float()});
            ASSERT_TRUE(sample);
            ASSERT_NEAR(glm::length(sample->light), 1, 1e-6);
            ASSERT_GT(sample->pdf, 0);
            const TableBsdf::Value there = bsdf.eval_and_pdf(eye, sample->light);
            ASSERT_EQ(there.intensity, bsdf.eval(eye, sample->light));
            ASSERT_EQ(there.pdf, bsdf.pdf(eye, sample->light));
            bool same = std::abs(there.pdf / sample->pdf - 1) < 1e-4f;
            for (int channel = 0; channel < 3; ++channel)
                same &= std::abs(sample->weight[channel] * sample->pdf / there.intensity[channel] -
                                 1) < 1e-4f;
            over_edges += !same;
            // No sample weighs more than another: the mean over the channels is the albedo's.
            ASSERT_NEAR(sample->weight.r + sample->weight.g + sample->weight.b,
                        albedo.r + albedo.g + albedo.b, 1e-5);
        }
        EXPECT_LE(over_edges, 10);
    }
}

TEST(TableBsdf, EndsOfTheRandomNumbersAreSafe) {
    const TableBsdf& bsdf = satin();
    const float below_one = 0x1.fffffep-1f;
    for (const glm::vec3& eye : eyes())
        for (const float choice : {0.0f, 0x1p-24f, 0.5f, below_one})
            for (const float u : {0.0f, below_one})
                for (const float v : {0.0f, below_one}) {
                    const auto sample = bsdf.sample(eye, choice, {u, v});
                    ASSERT_TRUE(sample);
                    EXPECT_NE(sample->light.z, 0);
                    EXPECT_TRUE(std::isfinite(sample->weight.r) && std::isfinite(sample->pdf));
                    EXPECT_LT(sample->weight.r, 3);
                }
}

TEST(TableBsdf, TheEyeTakesTheIncidenceSlot) {
    // Deliberately not reciprocal: all light leaves about +x, whatever it came from, and more of it
    // from grazing incidence. With the slots exchanged eval(eye, light) would follow the light's θ.
    const TableBsdf bsdf(
        tests::synthetic_table([](const IncidentDirection& from, const glm::dvec3& out, size_t) {
            const bool reflected = (out.z > 0) == (from.side == Side::front);
            return reflected ? (0.02 + 0.05 * from.theta) * (1 + out.x) : 0;
        }),
        "");
    const glm::vec3 steep = direction(10, 180), flat = direction(70, 0);
    EXPECT_NEAR(bsdf.eval(steep, flat).g,
                (0.02 + 0.05 * radians(10.0)) * (1 + std::sin(radians(70.0))), 1e-3);
    EXPECT_NEAR(bsdf.eval(flat, steep).g,
                (0.02 + 0.05 * radians(70.0)) * (1 - std::sin(radians(10.0))), 1e-3);
    EXPECT_GT(bsdf.albedo(flat).g, 1.5f * bsdf.albedo(steep).g);
}

TEST(TableBsdf, SidesAndBlocksKeepTheirPlaces) {
    // front→front 0.1, front→back 0.2, back→back 0.3, back→front 0.4: share of the flux, even.
    BsdfTable table =
        tests::synthetic_table([](const IncidentDirection& from, const glm::dvec3& out, size_t) {
            const bool front = from.side == Side::front, up = out.z > 0;
            return (front ? (up ? 0.1 : 0.2) : (up ? 0.4 : 0.3)) / (2 * kPi);
        });
    for (size_t d = 0; d < table.directions(); ++d) {
        const float unscattered = table.incident[d].side == Side::front ? 0.25f : 0.125f;
        for (size_t band = 0; band < 3; ++band)
            table.unscattered[3 * d + band] = unscattered;
    }
    const TableBsdf bsdf(std::move(table), "");
    const glm::vec3 up = direction(50, 75), down = direction(30, 135, Side::back);
    const float even = static_cast<float>(1 / (2 * kPi));
    EXPECT_NEAR(bsdf.eval(up, up).r, 0.1f * even, 1e-6);
    EXPECT_NEAR(bsdf.eval(up, down).r, 0.2f * even, 1e-6);
    EXPECT_NEAR(bsdf.eval(down, down).r, 0.3f * even, 1e-6);
    EXPECT_NEAR(bsdf.eval(down, up).r, 0.4f * even, 1e-6);
    EXPECT_NEAR(bsdf.albedo(up).r, 0.3f, 1e-5);
    EXPECT_NEAR(bsdf.albedo(down).r, 0.7f, 1e-5);
    EXPECT_NEAR(bsdf.unscattered(up).r, 0.25f, 1e-6);
    EXPECT_NEAR(bsdf.unscattered(down).r, 0.125f, 1e-6);
}

TEST(TableBsdf, NothingScattersOnTheHorizonOrFromABlackCloth) {
    const glm::vec3 horizon(1, 0, 0), up(0, 0, 1);
    const TableBsdf& bsdf = satin();
    EXPECT_EQ(bsdf.eval(horizon, up), Rgb(0));
    EXPECT_EQ(bsdf.eval(up, horizon), Rgb(0));
    EXPECT_EQ(bsdf.pdf(horizon, up), 0);
    EXPECT_EQ(bsdf.pdf(up, horizon), 0);
    EXPECT_FALSE(bsdf.sample(horizon, 0.5f, {0.5f, 0.5f}));
    EXPECT_EQ(bsdf.unscattered(horizon), Rgb(0));
    EXPECT_EQ(bsdf.albedo(horizon), Rgb(0));

    const TableBsdf black(tests::small_synthetic_table([](const IncidentDirection&,
                                                          const glm::dvec3&, size_t) { return 0; }),
                          "");
    EXPECT_EQ(black.eval(up, up), Rgb(0));
    EXPECT_EQ(black.pdf(up, up), 0);
    EXPECT_FALSE(black.sample(up, 0.5f, {0.5f, 0.5f}));
}

TEST(TableBsdf, DarkNodesBesideBrightOnesAreNeverSampled) {
    // Scatters for θ ≥ 20° only, and only to one side of the highlight: between 10° and 20° one
    // node has all the weight.
    const TableBsdf bsdf(
        tests::synthetic_table([](const IncidentDirection& from, const glm::dvec3& out, size_t) {
            const bool reflected = (out.z > 0) == (from.side == Side::front);
            const glm::dvec3 in = spherical_direction(from.theta, from.phi);
            return from.theta > 0.3 && reflected && out.y > -in.y ? 0.1 : 0.0;
        }),
        "");
    CounterRng rng(7, Purpose::test, 0, 0);
    const glm::vec3 eye = direction(11, 5);
    EXPECT_FALSE(bsdf.sample(direction(9, 5), 0.3f, {0.5f, 0.5f}));
    for (int i = 0; i < 10000; ++i) {
        const auto sample =
            bsdf.sample(eye, rng.uniform_float(), {rng.uniform_float(), rng.uniform_float()});
        ASSERT_TRUE(sample);
        ASSERT_GT(sample->light.z, 0);
        ASSERT_GT(sample->light.y, -eye.y - 1e-6f);
    }
}

TEST(TableBsdf, SpectralBandsBecomeColour) {
    // Equal in all bands is white; one green band alone lies outside sRGB and must not go negative.
    const Bands bands = Bands::from_edges({400, 500, 520, 700});
    BsdfTable grey = make_full_table(bands, true, true), green = grey;
    tests::fill_table(
        grey, [](const IncidentDirection&, const glm::dvec3&, size_t) { return 0.5 / (4 * kPi); });
    tests::fill_table(green, [](const IncidentDirection&, const glm::dvec3&, size_t band) {
        return band == 1 ? 0.5 / (4 * kPi) : 0;
    });
    const glm::vec3 eye = direction(30, 30);
    const Rgb white = TableBsdf(grey, "").albedo(eye);
    for (int channel = 0; channel < 3; ++channel)
        EXPECT_NEAR(white[channel], 0.5, 1e-3);
    const Rgb expected = bands.to_rgb()[1] * 0.5f;
    EXPECT_LT(expected.r, 0);
    const Rgb colour = TableBsdf(green, "").albedo(eye);
    EXPECT_GE(colour.r, 0);
    EXPECT_GT(colour.g, colour.r);
    EXPECT_NEAR(luminance(colour), luminance(expected), 1e-4);
}

TEST(TableBsdf, SaturatedSpectraMakeNoEnergy) {
    // Magenta and orange are brighter than white in the red of linear sRGB. That channel alone is
    // taken down to 1, together with what passes straight through; a colour within stays.
    const Bands bands = Bands::from_edges({400, 500, 520, 700});
    const auto leaving = [&](const Rgb& spectrum, const glm::vec3& eye) {
        BsdfTable table = tests::small_synthetic_table(
            [&](const IncidentDirection&, const glm::dvec3&, size_t band) {
                return 0.75 * spectrum[static_cast<int>(band)] / (4 * kPi);
            },
            0, bands);
        for (size_t i = 0; i < table.unscattered.size(); ++i)
            table.unscattered[i] = 0.25f * spectrum[static_cast<int>(i % 3)];
        const TableBsdf bsdf(std::move(table), "");
        return bsdf.albedo(eye) + bsdf.unscattered(eye);
    };
    const auto linear = [&](const Rgb& spectrum) {
        const std::vector<Rgb> rgb = bands.to_rgb();
        return glm::mat3(rgb[0], rgb[1], rgb[2]) * spectrum;
    };
    const Rgb magenta(0.98f, 0, 0.98f), dim = 0.5f * magenta, orange(0, 0, 0.98f);
    ASSERT_GT(linear(magenta).r, 1.1f);
    for (const glm::vec3& eye : eyes()) {
        const Rgb bright = leaving(magenta, eye), within = leaving(dim, eye);
        for (int channel = 0; channel < 3; ++channel) {
            EXPECT_NEAR(bright[channel], std::min(linear(magenta)[channel], 1.0f), 1e-4);
            EXPECT_NEAR(within[channel], linear(dim)[channel], 1e-4);
        }
        EXPECT_NEAR(leaving(orange, eye).r, 1, 1e-4);
        EXPECT_GT(leaving(orange, eye).g, 0.75f);
    }
}

TEST(TableBsdf, RefusesTablesWithGaps) {
    const auto message = [](BsdfTable table) {
        try {
            TableBsdf(std::move(table), "half.bsdf");
        } catch (const FileError& error) {
            EXPECT_EQ(error.path, "half.bsdf");
            return error.found;
        }
        return std::string("no error");
    };
    EXPECT_EQ(message(make_full_table(Bands{}, true, false)), "no back side");
    EXPECT_EQ(message(make_full_table(Bands{}, false, true)), "no front side");
    EXPECT_EQ(message(make_partial_table(Bands{}, {{Side::front, 0, 0}})),
              "a partial table of 1 directions of incidence");
}

} // namespace
} // namespace rapport
