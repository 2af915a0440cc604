#include "materials/table/direction_mesh.h"

#include <stdexcept>
#include <string>

namespace rapport {
namespace {

// Of the chart tests/bench/charts/parameterisation.svg.
constexpr double kFinestColumn = 0.15, kFinestRow = 0.25;

} // namespace

DirectionMesh::Axis::Axis(int count, double finest)
    : middle(count / 2), half_finest(static_cast<float>(finest / 2)),
      growth(static_cast<float>(1 - finest)),
      steps(static_cast<float>(0.5 * count / (1 - finest))) {
    if (count < 2 || count > kMost || count % 2 != 0)
        throw std::invalid_argument("DirectionMesh: columns and rows must be even, 2 to " +
                                    std::to_string(kMost) + ", not " + std::to_string(count));
    for (int i = 0; i <= count; ++i) {
        const double t = static_cast<double>(2 * i - count) / count, size = std::abs(t);
        edges.push_back(std::copysign(finest * size + (1 - finest) * square(size), t));
    }
}

DirectionMesh::DirectionMesh(int columns, int rows)
    : u_(columns, kFinestColumn), v_(rows, kFinestRow) {}

DirectionMesh::Bounds DirectionMesh::bounds(size_t bin) const {
    const size_t column = bin / rows(), row = bin % rows();
    return {u_.edges[column], u_.edges[column + 1], v_.edges[row], v_.edges[row + 1]};
}

size_t ExitBins::quarter(const glm::dvec3& w) const {
    const DirectionMesh::Place place = mesh_.place(chart_.point(w));
    return 4 * place.bin + 2 * (place.xi >= 0) + (place.eta >= 0);
}

double ExitBins::solid_angle(size_t bin) const {
    const DirectionMesh::Bounds b = mesh_.bounds(bin);
    return (b.u_high - b.u_low) * (b.v_high - b.v_low) / chart_.density(mesh_.point({bin, 0, 0}));
}

glm::dvec3 ExitBins::direction(size_t bin, double xi, double eta) const {
    return chart_.direction(mesh_.point({bin, xi, eta}));
}

} // namespace rapport
