#pragma once

#include "materials/table/measured_fields.h"

#include <cmath>

namespace rapport::tests {

/// A small made-up `measured` reflectance of `phis` azimuths of incidence that stand for one part
/// in `symmetry` of the circle; every field differs along every axis.
inline MeasuredFields small_measured(size_t phis = 5, int symmetry = 1) {
    MeasuredFields fields;
    fields.description = "made up";
    fields.theta = {0, 0.5f, 1.2f};
    for (size_t p = 0; p < phis; ++p)
        fields.phi.push_back(static_cast<float>(
            -kPi + 2 * kPi / symmetry * (phis > 1 ? double(p) / double(phis - 1) : 0)));
    const size_t slices = phis * fields.theta.size();
    const auto grid = [](size_t count, size_t rows, size_t columns, double base) {
        MeasuredGrid made{rows, columns, {}};
        for (size_t i = 0; i < count * rows * columns; ++i)
            made.values.push_back(static_cast<float>(base + 0.4 * std::sin(1.7 * double(i))));
        return made;
    };
    fields.ndf = grid(1, 3, 4, 1.1);
    fields.sigma = grid(1, 3, 3, 0.7);
    fields.vndf = grid(slices, 9, 7, 0.5);
    fields.luminance = grid(slices, 4, 4, 0.6);
    fields.rgb = grid(3 * slices, 4, 4, 0.5);
    return fields;
}

} // namespace rapport::tests
