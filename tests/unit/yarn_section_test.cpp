#include "renderer/core/error.h"
#include "renderer/core/math.h"
#include "vgsp/yarn_section.h"

#include <gtest/gtest.h>

namespace rapport {
namespace {

using glm::dvec2;

YarnSpec parallel_yarn(int fibres, double width, double height, double diameter) {
    YarnSpec yarn;
    yarn.fibres = fibres;
    yarn.width_um = width;
    yarn.height_um = height;
    yarn.fibre.diameter_um = diameter;
    return yarn;
}

YarnSpec twisted_yarn(int fibres, double width, double diameter, double twist) {
    YarnSpec yarn = parallel_yarn(fibres, width, width, diameter);
    yarn.section = YarnSection::twisted;
    yarn.twist_per_m = twist;
    return yarn;
}

/// All fibres of the section when its packing has turned by `angle`.
std::vector<dvec2> all_fibres(const SectionLayout& section, double angle) {
    std::vector<dvec2> found;
    for (const dvec2& fibre : section.fibres)
        for (int k = 0; k < section.copies(fibre); ++k)
            found.push_back(section.place(fibre, angle + 2 * kPi * k / section.symmetry));
    return found;
}

double least_distance(const std::vector<dvec2>& fibres) {
    double least = 1e9;
    for (size_t i = 0; i < fibres.size(); ++i)
        for (size_t j = 0; j < i; ++j)
            least = std::min(least, length(fibres[i] - fibres[j]));
    return least;
}

double least_distance_to(const std::vector<dvec2>& fibres, dvec2 p) {
    double least = 1e9;
    for (const dvec2& fibre : fibres)
        least = std::min(least, length(fibre - p));
    return least;
}

/// By how much the fibres stick out of the outline.
double protrusion(const std::vector<dvec2>& fibres, const SectionLayout& section) {
    double most = -1e9;
    for (const dvec2& fibre : fibres)
        for (int k = 0; k < 180; ++k) {
            const double t = k * kPi / 90;
            const double support = std::hypot(section.outline.half_width * std::cos(t),
                                              section.outline.half_height * std::sin(t));
            most = std::max(most, dot(fibre, dvec2(std::cos(t), std::sin(t))) +
                                      section.fibre_radius - support);
        }
    return most;
}

std::string refusal(const YarnSpec& yarn) {
    try {
        lay_out_section(yarn, "silk.toml", "warp");
    } catch (const FileError& error) {
        return error.what();
    }
    return "";
}

TEST(YarnSection, HexagonalNumbersFillACircleExactly) {
    // 1 + 6 + 12 + 18 fibres: seven in a row.
    const SectionLayout section = lay_out_section(parallel_yarn(37, 70, 70, 10), "", "");
    ASSERT_EQ(section.fibres.size(), 37u);
    EXPECT_NEAR(least_distance(section.fibres), 10, 1e-3);
    EXPECT_LT(protrusion(section.fibres, section), 1e-3);
}

TEST(YarnSection, ParallelFibresStayInsideAndApart) {
    for (int fibres : {1, 2, 3, 5, 12, 19, 40, 150})
        for (double ratio : {1.0, 2.0, 6.0, 0.5})
            for (double flatten : {1.0, 0.7}) {
                const double height = 20 * std::sqrt(fibres / ratio) + 20;
                YarnSpec yarn = parallel_yarn(fibres, ratio * height, height, 6);
                if (ratio < 1)
                    yarn.width_um = height;
                yarn.flatten = flatten;
                const SectionLayout section = lay_out_section(yarn, "", "");
                EXPECT_EQ(section.symmetry, 1);
                ASSERT_EQ(section.fibres.size(), size_t(fibres));
                EXPECT_GE(least_distance(section.fibres), 6 * (1 - 1e-6));
                EXPECT_LT(protrusion(section.fibres, section), 1e-3);
                for (const dvec2& fibre : section.fibres) // the same from both ends of the yarn
                    EXPECT_LT(least_distance_to(section.fibres, {-fibre.x, fibre.y}), 1e-9);
                EXPECT_DOUBLE_EQ(section.outline.half_height, height * flatten / 2);
                EXPECT_DOUBLE_EQ(section.outline.half_width, yarn.width_um / flatten / 2);
            }
}

TEST(YarnSection, TwistedFibresStayInsideAndApartHoweverTheyTurn) {
    for (int fibres : {1, 2, 3, 4, 5, 6, 7, 8, 10, 12, 13, 19, 20, 37, 50, 61})
        for (double flatten : {1.0, 0.75}) {
            YarnSpec yarn = twisted_yarn(fibres, 40 + 20 * std::sqrt(fibres), 8, 500);
            yarn.flatten = flatten;
            const SectionLayout section = lay_out_section(yarn, "", "");
            const double outermost = length(section.fibres.back());
            const double tilt = std::atan(2e-6 * kPi * 500 * outermost / flatten);
            for (double angle : {0.0, 0.3, 1.0, 1.6}) {
                const std::vector<dvec2> found = all_fibres(section, angle);
                ASSERT_EQ(found.size(), size_t(fibres));
                EXPECT_GE(least_distance(found) * std::cos(tilt), 8 * (1 - 1e-9));
                EXPECT_LT(protrusion(found, section), 1e-6);
            }
        }
}

TEST(YarnSection, PackingTurnsOntoItself) {
    for (auto [fibres, order] :
         {std::pair{7, 6}, {37, 6}, {12, 6}, {3, 3}, {10, 3}, {5, 2}, {8, 2}})
        EXPECT_EQ(lay_out_section(twisted_yarn(fibres, 300, 5, 300), "", "").symmetry, order);
}

TEST(YarnSection, PositiveTwistTurnsFromUpTowardsAcross) {
    const SectionLayout section = lay_out_section(twisted_yarn(7, 300, 5, 300), "", "");
    const dvec2 turned = section.place({0, 10}, 0.1);
    EXPECT_NEAR(turned.x, 10 * std::sin(0.1), 1e-12);
    EXPECT_NEAR(turned.y, 10 * std::cos(0.1), 1e-12);
}

TEST(YarnSection, NamesTheSizeThatWouldDo) {
    EXPECT_EQ(refusal(parallel_yarn(37, 70, 70, 10)), "");
    const std::string text = refusal(parallel_yarn(37, 69, 69, 10));
    EXPECT_NE(text.find("silk.toml:warp: expected a section of at least 70"), std::string::npos)
        << text;
    EXPECT_NE(text.find("found 69 µm across"), std::string::npos) << text;

    // Tilted fibres need more room: ρ = A/√(1 − (A·twist)²) with A = 3 diameters.
    const double a = 30, twist = 2e-6 * kPi * 2000;
    const double needed = 2 * (a / std::sqrt(1 - square(a * twist)) + 5);
    EXPECT_EQ(refusal(twisted_yarn(37, needed + 1e-3, 10, 2000)), "");
    EXPECT_NE(refusal(twisted_yarn(37, needed - 1e-3, 10, 2000)), "");
    EXPECT_NE(refusal(twisted_yarn(37, 70, 10, 6000)).find("twist"), std::string::npos);
}

TEST(YarnSection, RefusesWhatIsNoYarn) {
    EXPECT_NE(refusal(parallel_yarn(0, 70, 70, 10)), "");
    EXPECT_NE(refusal(parallel_yarn(5, -70, 70, 10)), "");
    EXPECT_NE(refusal(parallel_yarn(5, 70, std::nan(""), 10)), "");
    EXPECT_NE(refusal(parallel_yarn(5, 70, 70, 0)), "");
    EXPECT_NE(refusal(parallel_yarn(1, 70, 5, 10)), "");
    YarnSpec yarn = parallel_yarn(5, 70, 70, 10);
    yarn.flatten = 0;
    EXPECT_NE(refusal(yarn), "");
    yarn = twisted_yarn(7, 70, 5, 300);
    yarn.height_um = 60;
    EXPECT_NE(refusal(yarn), "");
}

YarnSpec plied_yarn(int plies, int fibres, double twist, double ply_twist) {
    YarnSpec yarn = twisted_yarn(fibres, 120, 12, twist);
    yarn.section = YarnSection::plied;
    yarn.plies = plies;
    yarn.ply_twist_per_m = ply_twist;
    return yarn;
}

/// All fibres of a plied yarn's section after `s` µm.
std::vector<dvec2> plied_fibres(const SectionLayout& section, const YarnSpec& yarn, double s) {
    std::vector<dvec2> found;
    const double turn = 2 * kPi * s * 1e-6;
    for (int ply = 0; ply < section.plies; ++ply)
        for (const dvec2& fibre : section.fibres)
            for (int k = 0; k < section.copies(fibre); ++k)
                found.push_back(
                    section.place(fibre, turn * yarn.twist_per_m + 2 * kPi * k / section.symmetry,
                                  turn * yarn.ply_twist_per_m + 2 * kPi * ply / section.plies));
    return found;
}

TEST(PliedSection, HoldsItsFibresApartAllAlong) {
    for (const auto& [plies, twist, ply_twist] :
         {std::tuple(2, 800.0, -500.0), {2, 600.0, 600.0}, {3, -700.0, 450.0}, {5, 0.0, 300.0}})
        for (double flatten : {1.0, 0.85}) {
            YarnSpec yarn = plied_yarn(plies, 19, twist, ply_twist);
            yarn.flatten = flatten;
            const SectionLayout section = lay_out_section(yarn, "y.toml", "warp");
            for (double s : {0.0, 130.0, 777.0}) {
                const std::vector<dvec2> fibres = plied_fibres(section, yarn, s);
                ASSERT_EQ(fibres.size(), size_t(19 * plies));
                EXPECT_GE(least_distance(fibres), 12 - 1e-6) << plies << ' ' << flatten;
                EXPECT_LE(protrusion(fibres, section), 1e-6) << plies << ' ' << flatten;
                // Fibres move past each other: no nearer than a diameter at any offset along.
                const double step = 2;
                const std::vector<dvec2> later = plied_fibres(section, yarn, s + step);
                for (size_t i = 0; i < fibres.size(); ++i)
                    for (size_t j = 0; j < i; ++j) {
                        EXPECT_GE(std::hypot(length(fibres[i] - later[j]), step), 12 - 1e-2);
                    }
            }
        }
    const SectionLayout two = lay_out_section(plied_yarn(2, 19, 800, -500), "y.toml", "warp");
    EXPECT_DOUBLE_EQ(two.outline.half_width, 120); // two singles side by side
}

TEST(PliedSection, SaysWhatSizeIsNeeded) {
    YarnSpec yarn = plied_yarn(2, 37, 900, 500);
    yarn.width_um = yarn.height_um = 70;
    try {
        lay_out_section(yarn, "y.toml", "weft");
        ADD_FAILURE() << "accepted";
    } catch (const FileError& error) {
        double size = 0;
        ASSERT_EQ(std::sscanf(error.expected.c_str(), "a section of at least %lf", &size), 1)
            << error.what();
        yarn.width_um = yarn.height_um = size;
        EXPECT_NO_THROW(lay_out_section(yarn, "y.toml", "weft"));
    }
}

} // namespace
} // namespace rapport
