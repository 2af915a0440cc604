#include "renderer/app/scan_files.h"

#include "renderer/app/line_chart.h"

#include <gtest/gtest.h>
#include <regex>
#include <sstream>

namespace rapport {
namespace {

/// A scan whose intensity tells the bin and the band.
PlaneScan numbered_scan(double plane, double theta) {
    constexpr size_t kBins = 2 * PlaneScan::kAngles;
    PlaneScan scan{{Side::front, radians(theta), radians(plane)},
                   Bands{},
                   std::vector<double>(3 * kBins),
                   std::vector<double>(3 * kBins, 0.5),
                   std::vector<double>(kBins),
                   std::vector<double>(kBins, 0.25),
                   0.1,
                   1000};
    for (size_t i = 0; i < 3 * kBins; ++i)
        scan.intensity[i] = static_cast<double>(i);
    for (size_t i = 0; i < kBins; ++i)
        scan.mean_intensity[i] = static_cast<double>(3 * i + 1);
    return scan;
}

size_t count(const std::string& text, const std::string& pattern) {
    const std::regex regex(pattern);
    return std::distance(std::sregex_iterator(text.begin(), text.end(), regex), {});
}

TEST(ScanFiles, CsvHasALinePerAngle) {
    const std::vector<PlaneScan> scans{numbered_scan(0, 30), numbered_scan(90, 45)};
    std::istringstream lines(scan_csv(scans));
    std::vector<std::string> all;
    for (std::string line; std::getline(lines, line);)
        all.push_back(line);
    ASSERT_EQ(all.size(), 1u + 2 * 2 * PlaneScan::kAngles);
    EXPECT_EQ(all[0],
              "side,plane,theta_in,exit,angle,mean,mean_error,R,R_error,G,G_error,B,B_error");
    EXPECT_EQ(all[1], "front,0,30,reflected,-88.5,1,0.25,0,0.5,1,0.5,2,0.5");
    EXPECT_EQ(all[1 + PlaneScan::kAngles],
              "front,0,30,transmitted,-88.5,358,0.25,357,0.5,358,0.5,359,0.5");
    EXPECT_EQ(all.back().substr(0, 31), "front,90,45,transmitted,88.5,71");
}

TEST(ScanFiles, SvgHasTwoPanelsToAPlane) {
    const std::vector<PlaneScan> scans{numbered_scan(0, 0), numbered_scan(0, 30),
                                       numbered_scan(90, 0), numbered_scan(90, 30)};
    const std::string svg = scan_svg(scans);
    EXPECT_EQ(count(svg, ">(reflected|transmitted): "), 4u);
    EXPECT_EQ(count(svg, "along the warp"), 2u);
    EXPECT_EQ(count(svg, "<polyline"), 8u);
    EXPECT_EQ(count(svg, "stroke-dasharray"), 8u);
    EXPECT_EQ(count(svg, ">θ = 30°<"), 1u) << "one legend";
    EXPECT_EQ(count(svg, "nan|inf"), 0u);
}

TEST(LineChart, PutsPointsWhereTheirValuesAre) {
    const std::vector<ChartPanel> panels{
        {"a < b & c", "x", "y", {{"one", {0, 10}, {0, 4}, {0, 0}, {}}}}};
    const std::string svg = line_chart_svg(panels, 1, 0, 10, 5);
    EXPECT_NE(svg.find("a &lt; b &amp; c"), svg.npos);
    std::smatch rectangle, line;
    ASSERT_TRUE(std::regex_search(
        svg, rectangle,
        std::regex(R"re(<rect x="(\d+)" y="(\d+)" width="(\d+)" height="(\d+)" fill="none")re")));
    ASSERT_TRUE(std::regex_search(
        svg, line, std::regex(R"re(<polyline.*points="([\d.]+),([\d.]+) ([\d.]+),([\d.]+) ")re")));
    const auto value = [](const std::smatch& match, int i) { return std::stod(match[i]); };
    EXPECT_EQ(value(line, 1), value(rectangle, 1));
    EXPECT_EQ(value(line, 3), value(rectangle, 1) + value(rectangle, 3));
    EXPECT_EQ(value(line, 2), value(rectangle, 2) + value(rectangle, 4)) << "zero is at the bottom";
    EXPECT_EQ(value(line, 4), value(rectangle, 2)) << "and a whole number of ticks at the top";
}

TEST(LineChart, DrawsNothingWithoutData) {
    EXPECT_NE(line_chart_svg({}, 2, -1, 1, 1).find("</svg>"), std::string::npos);
    const std::vector<ChartPanel> dark{{"dark", "x", "y", {{"none", {0, 1}, {0, 0}, {0, 0}, 0.5}}}};
    EXPECT_EQ(count(line_chart_svg(dark, 1, 0, 1, 1), "nan|inf"), 0u);
}

} // namespace
} // namespace rapport
