#include "renderer/core/error.h"
#include "renderer/core/math.h"
#include "renderer/core/parallel.h"
#include "vgsp/micro_element.h"
#include "vgsp/weave.h"

#include <gtest/gtest.h>
#include <map>

namespace rapport {
namespace {

using glm::dvec2, glm::dvec3;
using kernel::FibreChain;

YarnSpec parallel_yarn(int fibres, double width, double height, double diameter) {
    YarnSpec yarn;
    yarn.fibres = fibres;
    yarn.width_um = width;
    yarn.height_um = height;
    yarn.fibre.diameter_um = diameter;
    return yarn;
}

Cloth cloth_of(const Draft& draft, const YarnSpec& warp, const YarnSpec& weft) {
    Cloth cloth;
    cloth.path = "silk.toml";
    cloth.draft = draft;
    cloth.ends_per_cm = 36;
    cloth.picks_per_cm = 30;
    cloth.warp = warp;
    cloth.weft = weft;
    return cloth;
}

/// Unequal yarns and setts.
Cloth filament_cloth(const std::string& weave = "plain") {
    return cloth_of(named_weave(weave), parallel_yarn(19, 110, 110, 20),
                    parallel_yarn(12, 140, 90, 18));
}

Cloth twisted_cloth(double twist, int fibres = 19, const std::string& weave = "plain") {
    Cloth cloth = filament_cloth(weave);
    for (YarnSpec* yarn : {&cloth.warp, &cloth.weft}) {
        *yarn = parallel_yarn(fibres, 120, 120, 20);
        yarn->section = YarnSection::twisted;
        yarn->twist_per_m = twist;
    }
    return cloth;
}

std::string refusal(const Cloth& cloth) {
    try {
        build_micro_element(cloth);
    } catch (const FileError& error) {
        return error.what();
    }
    return "";
}

dvec3 point(const FibreChain& chain, long k) {
    const long n = long(chain.points.size()), periods = (k >= 0 ? k : k - n + 1) / n;
    return chain.points[k - periods * n] + double(periods) * chain.period;
}

double largest_turn_degrees(const MicroElement& element) {
    double least = 1;
    for (const FibreChain& chain : element.fibres.chains)
        for (size_t k = 0; k < chain.points.size(); ++k)
            least = std::min(least, dot(normalize(point(chain, k + 1) - point(chain, k)),
                                        normalize(point(chain, k + 2) - point(chain, k + 1))));
    return degrees(std::acos(least));
}

/// Heights of the fibre's axis wherever its endless chain passes coordinate `at` of `axis` (0 = x,
/// 1 = y), with the other coordinate.
std::vector<dvec2> passes(const FibreChain& chain, int axis, double at) {
    std::vector<dvec2> found;
    const long n = long(chain.points.size());
    for (long k = -n; k < n; ++k) {
        const dvec3 a = point(chain, k), b = point(chain, k + 1);
        if ((a[axis] <= at) == (b[axis] <= at))
            continue;
        const dvec3 p = a + (at - a[axis]) / (b[axis] - a[axis]) * (b - a);
        found.push_back({p[1 - axis], p.z});
    }
    return found;
}

/// The mean height of the fibres of the yarn at `across`, where it passes `at`.
double yarn_height(const MicroElement& element, uint32_t kind, double across, double at) {
    const int along = kind == kWarpFibre ? 1 : 0;
    double sum = 0;
    int count = 0;
    for (const FibreChain& chain : element.fibres.chains) {
        if (chain.kind != kind)
            continue;
        for (const dvec2& p : passes(chain, along, at))
            if (std::abs(p.x - across) < 80)
                sum += p.y, ++count;
    }
    return sum / count;
}

/// The largest distance of the joints of `a` from the fibres of `b`, both endless; `map` takes a
/// point of a to where b should have it.
template <class Map> double departure(const MicroElement& a, const MicroElement& b, Map map) {
    const dvec2 cell = b.fibres.cell;
    double largest = 0;
    for (size_t c = 0; c < a.fibres.chains.size(); c += 3)
        for (size_t k = 0; k < a.fibres.chains[c].points.size(); k += 17) {
            const dvec3 p = map(a.fibres.chains[c].points[k]);
            double nearest = 1e9;
            for (const FibreChain& chain : b.fibres.chains)
                for (long j = 0; j < long(chain.points.size()); ++j) {
                    const dvec3 start = point(chain, j), edge = point(chain, j + 1) - start;
                    dvec3 offset = p - start;
                    const dvec2 middle(start + 0.5 * edge);
                    const dvec2 shift = round((dvec2(p) - middle) / cell) * cell;
                    offset -= dvec3(shift, 0);
                    const double t = glm::clamp(dot(offset, edge) / dot(edge, edge), 0.0, 1.0);
                    nearest = std::min(nearest, length(offset - t * edge));
                }
            largest = std::max(largest, nearest);
        }
    return largest;
}

TEST(MicroElement, WarpIsOverOrUnderAsTheDraftSays) {
    for (const char* weave : {"plain", "twill 2/2 Z", "twill 3/1 S", "satin 5/2", "basket 2"}) {
        const Cloth cloth = filament_cloth(weave);
        const MicroElement element = build_micro_element(cloth);
        const double end_spacing = 1e4 / 36, pick_spacing = 1e4 / 30;
        EXPECT_NEAR(element.fibres.cell.x, cloth.draft.ends * end_spacing, 1e-9);
        EXPECT_NEAR(element.fibres.cell.y, cloth.draft.picks * pick_spacing, 1e-9);
        for (int pick = 0; pick < cloth.draft.picks; ++pick)
            for (int end = 0; end < cloth.draft.ends; ++end) {
                const double x = (end + 0.5) * end_spacing, y = (pick + 0.5) * pick_spacing;
                const double gap =
                    yarn_height(element, kWarpFibre, x, y) - yarn_height(element, kWeftFibre, y, x);
                // The axes are half of both heights apart; the weft's fibres may not lie quite
                // evenly about theirs.
                EXPECT_NEAR(gap, cloth.draft.up(end, pick) ? 100 : -100, 4) << weave;
            }
    }
}

TEST(MicroElement, TurnsStayWithinTheLimit) {
    Cloth flat = filament_cloth("satin 5/2");
    flat.warp = parallel_yarn(20, 100, 110, 14);
    flat.warp.flatten = 0.75;
    Cloth flat_twisted = twisted_cloth(700, 7);
    flat_twisted.weft.flatten = 0.8;
    for (const Cloth& cloth : {filament_cloth(), flat, twisted_cloth(500), flat_twisted})
        for (double limit : {1.0, 5.0}) {
            MicroElementOptions options;
            options.max_turn_degrees = limit;
            EXPECT_LE(largest_turn_degrees(build_micro_element(cloth, options)), limit + 1e-6);
        }
}

TEST(MicroElement, FloatsTakeFewSegments) {
    const MicroElement satin =
        build_micro_element(cloth_of(named_weave("satin 5/2"), parallel_yarn(37, 120, 120, 12),
                                     parallel_yarn(37, 120, 120, 12)));
    EXPECT_EQ(satin.fibres.chains.size(), 370u);
    EXPECT_LT(satin.segments, 200000u);
}

TEST(MicroElement, ChainsCloseOverWholeCells) {
    for (const Cloth& cloth : {filament_cloth("twill 2/1 S"), twisted_cloth(450)}) {
        const MicroElement element = build_micro_element(cloth);
        const auto segments = kernel::fibre_segments(element.fibres); // throws otherwise
        EXPECT_EQ(segments.size(), element.segments);
        for (const FibreChain& chain : element.fibres.chains) {
            EXPECT_EQ(chain.period.z, 0);
            EXPECT_GT(length(chain.period), 0);
        }
        // No fibre twice: the chains through a cell's edge are as many as the fibres that cross it.
        std::map<uint32_t, double> crossing;
        for (const FibreChain& chain : element.fibres.chains) {
            const int along = chain.kind == kWarpFibre ? 1 : 0;
            crossing[chain.kind] += chain.period[along] / element.fibres.cell[along];
        }
        EXPECT_NEAR(crossing[kWarpFibre], cloth.warp.fibres * cloth.draft.ends * element.repeats_x,
                    1e-9);
        EXPECT_NEAR(crossing[kWeftFibre], cloth.weft.fibres * cloth.draft.picks * element.repeats_y,
                    1e-9);
    }
}

/// Turns of the twisted fibre about the one in the centre of its warp yarn; Z positive.
double turns_about(const FibreChain& centre, const FibreChain& chain) {
    // In plan the fibre swings about the centre as the sine of its turn. On the face, the fibres of
    // a Z-twisted yarn held upright rise to the right, as the stroke of the letter.
    const double middle = centre.points[0].x;
    double turns = 0;
    for (size_t k = 0; k < chain.points.size(); ++k) {
        const dvec3 a = point(chain, long(k)), b = point(chain, long(k) + 1);
        if ((a.x < middle) == (b.x < middle))
            continue;
        const std::vector<dvec2> axis = passes(centre, 1, std::fmod(a.y, centre.period.y));
        const bool on_the_face = a.z > axis.front().y;
        const bool to_the_right = b.x > a.x;
        turns += on_the_face == to_the_right ? 0.5 : -0.5;
    }
    return turns;
}

TEST(MicroElement, TwistTurnsTheFibresAsOftenAsAskedAndTheRightWay) {
    for (double twist : {450.0, -450.0, 900.0}) {
        const MicroElement element = build_micro_element(twisted_cloth(twist, 7));
        EXPECT_LE(std::abs(element.twist_rounding_warp), 0.02);
        EXPECT_LE(std::abs(element.twist_rounding_weft), 0.02);
        // The first warp yarn: the centre, and what winds round it.
        const FibreChain& centre = element.fibres.chains[0];
        ASSERT_EQ(centre.period.y, element.fibres.cell.y);
        double fibres = 1;
        for (size_t c = 1; fibres < 7; ++c) {
            const FibreChain& chain = element.fibres.chains[c];
            const double axis_length = chain.period.y * (1 + element.crimp_warp);
            const double turns = turns_about(centre, chain);
            EXPECT_NEAR(turns, twist * 1e-6 * (1 + element.twist_rounding_warp) * axis_length,
                        1e-6);
            EXPECT_NEAR(turns, std::round(turns), 1e-9); // closed
            fibres += chain.period.y / element.fibres.cell.y;
        }
        EXPECT_DOUBLE_EQ(fibres, 7);
    }
}

TEST(MicroElement, PliedYarnsCloseWithAllTheirFibres) {
    for (int plies : {2, 3}) {
        Cloth cloth = filament_cloth();
        cloth.warp = parallel_yarn(7, 62, 62, 16);
        cloth.warp.section = YarnSection::plied;
        cloth.warp.plies = plies;
        cloth.warp.twist_per_m = 700;
        cloth.warp.ply_twist_per_m = -600;
        const MicroElement element = build_micro_element(cloth);
        EXPECT_LE(std::abs(element.twist_rounding_warp), 0.02);
        double fibres = 0;
        for (const FibreChain& chain : element.fibres.chains)
            if (chain.kind == kWarpFibre)
                fibres += chain.period.y / element.fibres.cell.y;
        EXPECT_NEAR(fibres, 2 * 7 * plies * element.repeats_x, 1e-9);
        EXPECT_EQ(kernel::fibre_segments(element.fibres).size(), element.segments);
        EXPECT_LT(element.overlap_fraction, 0.01);
        EXPECT_LE(largest_turn_degrees(element), 1 + 1e-6);
    }
}

TEST(MicroElement, UnequalYarnsTouchAtEveryCrossing) {
    Cloth cloth = filament_cloth("twill 2/1 Z");
    cloth.yarns = {{"thick", parallel_yarn(19, 130, 130, 20)},
                   {"thin", parallel_yarn(7, 80, 70, 16)},
                   {"flat", parallel_yarn(12, 140, 60, 14)}};
    cloth.draft = tiled(cloth.draft, 6, 3);
    cloth.draft.warp_yarns = {0, 0, 1, 0, 1, 1};
    cloth.draft.weft_yarns = {2, 1, 2};
    const MicroElement element = build_micro_element(cloth);
    EXPECT_LT(element.overlap_fraction, 0.001);
    // Kinds: the named yarns alone. Counts of fibres by kind.
    std::map<uint32_t, double> crossing;
    for (const FibreChain& chain : element.fibres.chains)
        crossing[chain.kind] += chain.period.y / element.fibres.cell.y;
    EXPECT_NEAR(crossing[0], 3 * 19, 1e-9);
    EXPECT_NEAR(crossing[1], 3 * 7, 1e-9);
    EXPECT_NEAR(crossing[2], 0, 1e-9); // only in the weft

    // The highest fibres of an end under a pick meet the lowest of the pick, without a gap.
    const double end_spacing = 1e4 / 36, pick_spacing = 1e4 / 30;
    const double half[] = {65, 35, 30};
    for (int pick = 0; pick < 3; ++pick)
        for (int end = 0; end < 6; ++end) {
            const double x = (end + 0.5) * end_spacing, y = (pick + 0.5) * pick_spacing;
            const auto mean_height = [&](bool warp) {
                double sum = 0;
                int count = 0;
                for (const FibreChain& chain : element.fibres.chains)
                    if ((chain.period.y > 0) == warp)
                        for (const dvec2& p : passes(chain, warp ? 1 : 0, warp ? y : x))
                            if (std::abs(p.x - (warp ? x : y)) < 80)
                                sum += p.y, ++count;
                return sum / count;
            };
            const double apart =
                half[cloth.draft.warp_yarns[end]] + half[cloth.draft.weft_yarns[pick]];
            EXPECT_NEAR(mean_height(true) - mean_height(false),
                        cloth.draft.up(end, pick) ? apart : -apart, 4);
        }
}

TEST(MicroElement, EqualNamedYarnsMakeTheSameCloth) {
    const Cloth simple = filament_cloth("satin 5/2");
    Cloth named = simple;
    named.yarns = {{"a", simple.warp}, {"b", simple.weft}, {"c", simple.warp}};
    named.draft.warp_yarns = {0, 2, 2, 0, 2};
    named.draft.weft_yarns = {1, 1, 1, 1, 1};
    const MicroElement a = build_micro_element(simple), b = build_micro_element(named);
    EXPECT_EQ(a.segments, b.segments);
    EXPECT_LT(departure(a, b, [](const dvec3& p) { return p; }), 1e-6);
}

TEST(MicroElement, WeighsItsFibres) {
    Cloth cloth = filament_cloth();
    EXPECT_FALSE(build_micro_element(cloth).mass_g_per_m2);
    cloth.warp.fibre.density_g_cm3 = 1.5;
    EXPECT_FALSE(build_micro_element(cloth).mass_g_per_m2);
    cloth.weft.fibre.density_g_cm3 = 1.2;
    const MicroElement element = build_micro_element(cloth);
    // tex · threads per metre · (1 + crimp): 1 tex on 1000 threads per metre weighs 1 g/m².
    const double warp = 19 * fibre_dtex(20, 1.5) / 10 * 3.6 * (1 + element.crimp_warp);
    const double weft = 12 * fibre_dtex(18, 1.2) / 10 * 3.0 * (1 + element.crimp_weft);
    EXPECT_NEAR(*element.mass_g_per_m2, warp + weft, 0.01 * (warp + weft));
}

TEST(MicroElement, TakesTheFewestRepeatsThatTwistAllows) {
    EXPECT_EQ(build_micro_element(filament_cloth()).repeats_x, 1);
    const MicroElement element = build_micro_element(twisted_cloth(450));
    // 19 fibres have a six-fold packing.
    const double per_repeat = 450e-6 * 6 * (1 + element.crimp_warp) * 2 * 1e4 / 30;
    for (int repeats = 1; repeats <= element.repeats_y; ++repeats) {
        const double turns = per_repeat * repeats;
        const bool closes = std::abs(std::round(turns) / turns - 1) <= 0.02;
        EXPECT_EQ(closes, repeats == element.repeats_y) << repeats;
    }
}

TEST(MicroElement, FibresDoNotOverlap) {
    EXPECT_EQ(build_micro_element(filament_cloth()).overlap_fraction, 0);
    EXPECT_EQ(build_micro_element(filament_cloth("satin 5/2")).overlap_fraction, 0);
    EXPECT_LT(build_micro_element(twisted_cloth(600)).overlap_fraction, 0.01);
}

TEST(MicroElement, MovingTheWindowMovesTheFibres) {
    const Cloth cloth = filament_cloth("twill 3/1 Z");
    Cloth moved = cloth;
    for (int pick = 0; pick < 4; ++pick)
        for (int end = 0; end < 4; ++end)
            moved.draft.set_up(end, pick, cloth.draft.up((end + 1) % 4, (pick + 3) % 4));
    MicroElementOptions options;
    options.dither = false;
    const dvec3 shift(-1e4 / 36, -3e4 / 30, 0);
    const MicroElement a = build_micro_element(cloth, options);
    const MicroElement b = build_micro_element(moved, options);
    EXPECT_EQ(a.segments, b.segments);
    // Chords leave their arcs by 0.01 µm.
    EXPECT_LT(departure(a, b, [&](const dvec3& p) { return p + shift; }), 0.05);
    EXPECT_GT(departure(a, b, [&](const dvec3& p) { return p; }), 5);
}

TEST(MicroElement, TurningTheDraftTurnsTheFibres) {
    Cloth cloth = filament_cloth("twill 3/1 Z");
    cloth.warp = parallel_yarn(8, 100, 100, 20);
    cloth.crimp_balance = 0.4;
    Cloth turned = cloth;
    std::swap(turned.warp, turned.weft);
    std::swap(turned.ends_per_cm, turned.picks_per_cm);
    turned.crimp_balance = 0.6;
    const int n = 4;
    for (int pick = 0; pick < n; ++pick)
        for (int end = 0; end < n; ++end)
            turned.draft.set_up(pick, n - 1 - end, !cloth.draft.up(end, pick));
    MicroElementOptions options;
    options.dither = false;
    const MicroElement a = build_micro_element(cloth, options);
    const MicroElement b = build_micro_element(turned, options);
    // A quarter turn clockwise: end e becomes pick n − 1 − e, pick p becomes end p.
    const auto quarter = [&](const dvec3& p) { return dvec3(p.y, a.fibres.cell.x - p.x, p.z); };
    EXPECT_LT(departure(a, b, quarter), 0.05);
    EXPECT_DOUBLE_EQ(a.crimp_warp, b.crimp_weft);
    EXPECT_DOUBLE_EQ(a.warp_cover, b.weft_cover);
}

TEST(MicroElement, BalanceSharesTheCrimp) {
    Cloth cloth = filament_cloth();
    cloth.crimp_balance = 0;
    const MicroElement straight_warp = build_micro_element(cloth);
    EXPECT_NEAR(straight_warp.crimp_warp, 0, 1e-9);
    EXPECT_GT(straight_warp.crimp_weft, 0.1);
    EXPECT_NEAR(straight_warp.thickness_um, 2 * (110 + 90) / 2 + 90, 1e-9);
    cloth.crimp_balance = 1;
    EXPECT_NEAR(build_micro_element(cloth).crimp_weft, 0, 1e-9);
}

TEST(MicroElement, ReportsCoverAndThickness) {
    const MicroElement element = build_micro_element(filament_cloth());
    const double warp = 110 * 36e-4, weft = 140 * 30e-4;
    EXPECT_NEAR(element.warp_cover, warp, 1e-12);
    EXPECT_NEAR(element.weft_cover, weft, 1e-12);
    EXPECT_NEAR(element.cover_factor, warp + weft - warp * weft, 1e-12);
    EXPECT_NEAR(element.thickness_um, 100 + 110, 1e-9);
    for (const FibreChain& chain : element.fibres.chains)
        for (const dvec3& p : chain.points)
            EXPECT_LE(std::abs(p.z) + chain.radius, element.thickness_um / 2 + 1e-2);
}

TEST(MicroElement, DitherMovesJointsAlongTheFibresOnly) {
    MicroElementOptions plain, other;
    plain.dither = false;
    other.seed = 1;
    const MicroElement a = build_micro_element(filament_cloth(), plain);
    const MicroElement b = build_micro_element(filament_cloth());
    const MicroElement c = build_micro_element(filament_cloth(), other);
    EXPECT_NE(a.fibres.chains[3].points[0], b.fibres.chains[3].points[0]);
    EXPECT_NE(c.fibres.chains[3].points[0], b.fibres.chains[3].points[0]);
    EXPECT_LT(departure(a, b, [](const dvec3& p) { return p; }), 0.05);
}

TEST(MicroElement, DoesNotDependOnTheThreads) {
    const auto built = [](int threads) {
        set_thread_count(threads);
        return build_micro_element(twisted_cloth(500));
    };
    const MicroElement a = built(1), b = built(3);
    set_thread_count(0);
    ASSERT_EQ(a.fibres.chains.size(), b.fibres.chains.size());
    for (size_t c = 0; c < a.fibres.chains.size(); ++c)
        EXPECT_EQ(a.fibres.chains[c].points, b.fibres.chains[c].points);
    EXPECT_EQ(a.overlap_fraction, b.overlap_fraction);
}

TEST(MicroElement, RefusesClothsThatCannotExist) {
    Cloth cloth = filament_cloth();
    cloth.picks_per_cm = 80; // yarns 140 µm wide
    EXPECT_EQ(refusal(cloth), "silk.toml:picks_per_cm: expected at most 71.42 for a weft yarn 140 "
                              "µm wide (yarns too thick for the sett), found 80");
    cloth = filament_cloth();
    cloth.ends_per_cm = 60;
    const std::string jammed = refusal(cloth);
    EXPECT_NE(jammed.find("silk.toml:ends_per_cm: expected at most "), std::string::npos) << jammed;
    EXPECT_NE(jammed.find("too thick for the sett"), std::string::npos) << jammed;
    // The sett that the message names is possible, and the next one is not.
    cloth.ends_per_cm = std::stod(jammed.substr(jammed.find("at most ") + 8));
    EXPECT_EQ(refusal(cloth), "");
    cloth.ends_per_cm += 0.02;
    EXPECT_NE(refusal(cloth), "");

    cloth = filament_cloth();
    cloth.warp.fibres = 60;
    EXPECT_NE(refusal(cloth).find("silk.toml:warp: expected a section of at least"),
              std::string::npos);
    cloth = twisted_cloth(0.5);
    EXPECT_NE(refusal(cloth).find("twist_per_m = 0.5"), std::string::npos) << refusal(cloth);
    for (double sett : {0.0, -3.0, std::nan("")}) {
        cloth = filament_cloth();
        cloth.ends_per_cm = sett;
        EXPECT_NE(refusal(cloth).find("ends_per_cm"), std::string::npos);
    }
    // Chance makes bends that the mean deviation does not tell of.
    cloth = filament_cloth();
    cloth.warp = parallel_yarn(7, 110, 110, 12);
    cloth.warp.irregularity = {.migration_um = 24.1, .deviation_degrees = 45};
    EXPECT_NE(refusal(cloth).find("silk.toml:deviation_degrees"), std::string::npos)
        << refusal(cloth);
    cloth = filament_cloth();
    cloth.crimp_balance = 1.5;
    EXPECT_NE(refusal(cloth).find("crimp_balance"), std::string::npos);
    cloth = filament_cloth("twill 30/30 Z");
    cloth.warp.fibres = 5000;
    cloth.warp.fibre.diameter_um = 1;
    EXPECT_NE(refusal(cloth).find("cylinders"), std::string::npos) << refusal(cloth);
}

} // namespace
} // namespace rapport
