#include "renderer/app/line_chart.h"

#include "renderer/app/svg.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace rapport {
namespace {

constexpr double kWidth = 420, kHeight = 240; ///< of a panel's axes [px]
constexpr double kLeft = 64, kRight = 16, kTop = 34, kBottom = 48, kLegend = 30;

/// Told apart by people who see colours differently (Okabe & Ito 2008).
constexpr std::array kColours{"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9"};

/// 1, 2 or 5 times a power of ten, so that `range` takes four to ten of them.
double tick_for(double range) {
    const double power = std::pow(10.0, std::floor(std::log10(range)) - 1);
    for (const double factor : {1.0, 2.0, 5.0, 10.0})
        if (range / (factor * power) <= 8)
            return factor * power;
    return 20 * power;
}

struct Axes {
    double left, top; ///< on the picture [px]
    double x_low, x_high, x_tick;
    double y_high, y_tick; ///< from zero

    double x(double value) const { return left + kWidth * (value - x_low) / (x_high - x_low); }
    double y(double value) const { return top + kHeight * (1 - value / y_high); }
};

void draw_axes(Svg& drawing, const Axes& axes, const ChartPanel& panel) {
    const double right = axes.left + kWidth, bottom = axes.top + kHeight;
    const std::string grid = "stroke=\"#dddddd\"";
    for (double x = std::ceil(axes.x_low / axes.x_tick) * axes.x_tick;
         x <= axes.x_high * (1 + 1e-9); x += axes.x_tick) {
        drawing.line(axes.x(x), axes.top, axes.x(x), bottom, grid);
        drawing.text(axes.x(x), bottom + 16, "middle", fmt::format("{:g}", x));
    }
    const int ticks = static_cast<int>(std::round(axes.y_high / axes.y_tick));
    for (int i = 0; i <= ticks; ++i) {
        const double y = i * axes.y_tick;
        drawing.line(axes.left, axes.y(y), right, axes.y(y), grid);
        drawing.text(axes.left - 6, axes.y(y) + 4, "end", fmt::format("{:g}", y));
    }
    drawing.add("<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"none\" "
                "stroke=\"#333333\"/>\n",
                axes.left, axes.top, kWidth, kHeight);
    drawing.text(axes.left + kWidth / 2, axes.top - 10, "middle", panel.title,
                 " font-weight=\"bold\"");
    drawing.text(axes.left + kWidth / 2, bottom + 36, "middle", panel.x_label);
    const double x = axes.left - 48, y = axes.top + kHeight / 2;
    drawing.text(x, y, "middle", panel.y_label,
                 fmt::format(" transform=\"rotate(-90 {:.1f} {:.1f})\"", x, y).c_str());
}

void draw_curve(Svg& drawing, const Axes& axes, const ChartCurve& curve, const char* colour) {
    if (curve.mark)
        drawing.line(axes.x(*curve.mark), axes.top, axes.x(*curve.mark), axes.top + kHeight,
                     fmt::format("stroke=\"{}\" stroke-dasharray=\"2 4\"", colour));
    drawing.add("<polygon fill=\"{}\" fill-opacity=\"0.25\" points=\"", colour);
    for (size_t i = 0; i < curve.x.size(); ++i)
        drawing.add("{:.1f},{:.1f} ", axes.x(curve.x[i]), axes.y(curve.y[i] + curve.error[i]));
    for (size_t i = curve.x.size(); i-- > 0;)
        drawing.add("{:.1f},{:.1f} ", axes.x(curve.x[i]),
                    axes.y(std::max(0.0, curve.y[i] - curve.error[i])));
    drawing.add("\"/>\n<polyline fill=\"none\" stroke=\"{}\" stroke-width=\"1.5\" points=\"",
                colour);
    for (size_t i = 0; i < curve.x.size(); ++i)
        drawing.add("{:.1f},{:.1f} ", axes.x(curve.x[i]), axes.y(curve.y[i]));
    drawing.add("\"/>\n");
}

void draw_legend(Svg& drawing, const ChartPanel& panel) {
    double x = kLeft;
    for (size_t i = 0; i < panel.curves.size(); ++i) {
        const std::string& label = panel.curves[i].label;
        drawing.line(
            x, 16, x + 24, 16,
            fmt::format("stroke=\"{}\" stroke-width=\"3\"", kColours[i % kColours.size()]));
        drawing.text(x + 30, 20, "start", label);
        x += 56 + 7.0 * static_cast<double>(label.size());
    }
}

/// What the curves of every `columns`-th panel reach, with their errors; never 0.
double highest(std::span<const ChartPanel> panels, size_t column, size_t columns) {
    double top = 0;
    for (size_t i = column; i < panels.size(); i += columns)
        for (const ChartCurve& curve : panels[i].curves)
            for (size_t k = 0; k < curve.y.size(); ++k)
                top = std::max(top, curve.y[k] + curve.error[k]);
    return top > 0 ? top : 1;
}

} // namespace

std::string line_chart_svg(std::span<const ChartPanel> panels, int columns, double x_low,
                           double x_high, double x_tick) {
    const double column_width = kLeft + kWidth + kRight, row_height = kTop + kHeight + kBottom;
    const size_t wide = static_cast<size_t>(columns), rows = (panels.size() + wide - 1) / wide;
    const double width = static_cast<double>(columns) * column_width;
    const double height = kLegend + static_cast<double>(rows) * row_height;
    Svg drawing(width, height);
    if (!panels.empty())
        draw_legend(drawing, panels[0]);
    for (size_t i = 0; i < panels.size(); ++i) {
        const size_t column = i % wide, row = i / wide;
        const double top = highest(panels, column, wide), tick = tick_for(top);
        const Axes axes{static_cast<double>(column) * column_width + kLeft,
                        kLegend + static_cast<double>(row) * row_height + kTop,
                        x_low,
                        x_high,
                        x_tick,
                        std::ceil(top / tick) * tick,
                        tick};
        draw_axes(drawing, axes, panels[i]);
        for (size_t k = 0; k < panels[i].curves.size(); ++k)
            draw_curve(drawing, axes, panels[i].curves[k], kColours[k % kColours.size()]);
    }
    return std::move(drawing).take();
}

} // namespace rapport
