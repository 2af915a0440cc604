#include "renderer/app/scan_files.h"

#include "renderer/app/line_chart.h"

#include <fmt/format.h>
#include <iterator>

namespace rapport {
namespace {

const char* side_name(const PlaneScan& scan) {
    return scan.incident.side == Side::front ? "front" : "back";
}

bool same_plane(const PlaneScan& a, const PlaneScan& b) {
    return a.incident.side == b.incident.side && a.incident.phi == b.incident.phi;
}

ChartCurve curve_of(const PlaneScan& scan, int block) {
    ChartCurve curve;
    curve.label = fmt::format("θ = {:g}°", degrees(scan.incident.theta));
    curve.mark = -degrees(scan.incident.theta);
    for (int i = 0; i < PlaneScan::kAngles; ++i) {
        curve.x.push_back(degrees(PlaneScan::angle(i)));
        curve.y.push_back(scan.mean_intensity[block * PlaneScan::kAngles + i]);
        curve.error.push_back(scan.mean_error[block * PlaneScan::kAngles + i]);
    }
    return curve;
}

std::string plane_title(const PlaneScan& scan) {
    const double phi = std::round(1e6 * degrees(scan.incident.phi)) / 1e6;
    const char* along = std::fmod(phi, 180.0) == 0    ? " (along the weft)"
                        : std::fmod(phi, 180.0) == 90 ? " (along the warp)"
                                                      : "";
    return fmt::format("light on the {}, plane φ = {:g}°{}", side_name(scan), phi, along);
}

} // namespace

std::string scan_csv(std::span<const PlaneScan> scans) {
    std::string text = "side,plane,theta_in,exit,angle,mean,mean_error";
    const auto out = std::back_inserter(text);
    if (!scans.empty())
        for (const std::string& band : scans[0].bands.names)
            fmt::format_to(out, ",{0},{0}_error", band);
    text += '\n';
    for (const PlaneScan& scan : scans)
        for (int bin = 0; bin < 2 * PlaneScan::kAngles; ++bin) {
            fmt::format_to(out, "{},{:.9g},{:.9g},{},{:.9g},{:.6g},{:.3g}", side_name(scan),
                           degrees(scan.incident.phi), degrees(scan.incident.theta),
                           bin < PlaneScan::kAngles ? "reflected" : "transmitted",
                           degrees(PlaneScan::angle(bin % PlaneScan::kAngles)),
                           scan.mean_intensity[bin], scan.mean_error[bin]);
            const size_t bands = scan.bands.count();
            for (size_t band = 0; band < bands; ++band)
                fmt::format_to(out, ",{:.6g},{:.3g}", scan.intensity[bin * bands + band],
                               scan.error[bin * bands + band]);
            text += '\n';
        }
    return text;
}

std::string scan_svg(std::span<const PlaneScan> scans) {
    std::vector<ChartPanel> panels;
    for (size_t i = 0; i < scans.size(); ++i) {
        if (i == 0 || !same_plane(scans[i - 1], scans[i]))
            for (const char* exit : {"reflected", "transmitted"})
                panels.push_back({fmt::format("{}: {}", exit, plane_title(scans[i])),
                                  "angle of exit [°], positive towards the light",
                                  "intensity [1/sr]",
                                  {}});
        for (const int block : {0, 1})
            panels[panels.size() - 2 + block].curves.push_back(curve_of(scans[i], block));
    }
    return line_chart_svg(panels, 2, -90, 90, 30);
}

} // namespace rapport
