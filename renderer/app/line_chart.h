#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace rapport {

struct ChartCurve {
    std::string label;
    std::vector<double> x, y;
    std::vector<double> error;  ///< of y, drawn as a band of ± 1; as long as y
    std::optional<double> mark; ///< an x that the curve refers to, drawn as a dotted line
};

/// One diagram: its curves are coloured in order, the same everywhere on the chart.
struct ChartPanel {
    std::string title, x_label, y_label;
    std::vector<ChartCurve> curves;
};

/// An SVG picture of the panels, `columns` to a row. All x axes span [x_low, x_high]; the y axes of
/// a column span from zero to what its curves need, so that the rows compare. The legend is the
/// first panel's.
std::string line_chart_svg(std::span<const ChartPanel> panels, int columns, double x_low,
                           double x_high, double x_tick);

} // namespace rapport
