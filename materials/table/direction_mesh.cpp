#include "materials/table/direction_mesh.h"

#include <fmt/format.h>
#include <stdexcept>

namespace rapport {
DirectionMesh::DirectionMesh(int columns, int rows) : middle_(columns / 2), rows_(rows) {
    if (columns < 2 || columns > kMost || columns % 2 != 0 || rows < 1 || rows > kMost)
        throw std::invalid_argument(fmt::format("DirectionMesh: expected an even number of columns "
                                                "from 2 to {0} and 1 to {0} rows, not {1} and {2}",
                                                kMost, columns, rows));
    for (int i = 0; i <= columns; ++i) {
        const double t = static_cast<double>(2 * i - columns) / columns, size = std::abs(t);
        u_edges_.push_back(std::copysign(kFinest * size + (1 - kFinest) * square(size), t));
    }
    for (int i = 0; i <= rows; ++i)
        v_edges_.push_back(static_cast<double>(2 * i - rows) / rows);
}

DirectionMesh::Bounds DirectionMesh::bounds(size_t bin) const {
    const size_t column = bin / rows_, row = bin % rows_;
    return {u_edges_[column], u_edges_[column + 1], v_edges_[row], v_edges_[row + 1]};
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
