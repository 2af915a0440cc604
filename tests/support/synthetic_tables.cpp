#include "tests/support/synthetic_tables.h"

#include <cmath>

namespace rapport::tests {
namespace {

/// Midpoints of 4 × 4 equal solid angles of each bin, on the hemisphere of +z.
constexpr int kSteps = 4;
std::vector<glm::dvec3> places_in_bins(const ExitBins& exits, size_t bins) {
    std::vector<glm::dvec3> places;
    for (size_t bin = 0; bin < bins; ++bin)
        for (int i = 0; i < kSteps; ++i)
            for (int j = 0; j < kSteps; ++j)
                places.push_back(
                    exits.direction(bin, (2 * i + 1.0) / kSteps - 1, (2 * j + 1.0) / kSteps - 1));
    return places;
}

} // namespace

void fill_table(BsdfTable& table, const Intensity& intensity, double unscattered) {
    const size_t bands = table.bands.count();
    for (size_t d = 0; d < table.directions(); ++d) {
        const std::vector<glm::dvec3> places =
            places_in_bins(table.exits_of(d), table.exits.bins());
        const IncidentDirection& from = table.incident[d];
        for (int block = 0; block < 2; ++block)
            for (size_t bin = 0; bin < table.exits.bins(); ++bin)
                for (size_t band = 0; band < bands; ++band) {
                    double sum = 0;
                    for (size_t i = bin * square(kSteps); i < (bin + 1) * square(kSteps); ++i) {
                        glm::dvec3 out = places[i];
                        if ((from.side == Side::front) != (block == 0))
                            out.z = -out.z;
                        sum += intensity(from, out, band);
                    }
                    table.at(d, block, bin, band) = static_cast<float>(sum / square(kSteps));
                }
        const auto reflected = table.reflectance(d), transmitted = table.transmittance(d);
        for (size_t band = 0; band < bands; ++band) {
            table.unscattered[d * bands + band] = static_cast<float>(unscattered);
            table.absorbed[d * bands + band] =
                static_cast<float>(1 - unscattered - reflected[band] - transmitted[band]);
        }
        table.accuracy[d] = 0.25f;
        table.paths[d] = 1000 + d;
    }
    table.metadata = {{"cloth", "synthetic"}, {"seed", "0"}};
}

BsdfTable synthetic_table(const Intensity& intensity, double unscattered) {
    BsdfTable table = make_full_table(Bands{}, true, true);
    table.exit_axis = {ConeAxis::warp, ConeAxis::weft};
    fill_table(table, intensity, unscattered);
    return table;
}

BsdfTable small_synthetic_table(const Intensity& intensity, double unscattered,
                                const Bands& bands) {
    const std::vector<double> thetas = {0, 0.6, 1.4}, phis = {0, kPi / 2, kPi, 3 * kPi / 2};
    std::vector<IncidentDirection> incident;
    std::vector<uint32_t> grid_index;
    for (const Side side : {Side::front, Side::back})
        for (const double theta : thetas)
            for (const double phi : phis) {
                if (theta > 0 || phi == 0)
                    incident.push_back({side, theta, phi});
                grid_index.push_back(static_cast<uint32_t>(incident.size() - 1));
            }
    BsdfTable table = make_partial_table(bands, incident);
    table.grid_theta = thetas;
    table.grid_phi = phis;
    table.grid_index = grid_index;
    table.exits = DirectionMesh(12, 8);
    table.exit_axis = {ConeAxis::warp, ConeAxis::weft};
    table.intensity.resize(table.directions() * 2 * table.exits.bins() * table.bands.count());
    fill_table(table, intensity, unscattered);
    return table;
}

double satin_intensity(const IncidentDirection& from, const glm::dvec3& out, size_t band) {
    constexpr double kDiffuse[] = {0.45, 0.2, 0.1}, kTransmitted[] = {0.2, 0.1, 0.05};
    const bool front = from.side == Side::front;
    const bool reflected = (out.z > 0) == front;
    const double cosine = std::cos(from.theta);
    if (!reflected)
        return (front ? 1.0 : 1.2) * kTransmitted[band] / kPi * std::abs(out.z) * (0.5 + cosine);
    const glm::dvec3 in = spherical_direction(from.theta, from.phi);
    const double across = (in.x + out.x) / (front ? 0.4 : 0.25);
    const double along = (in.y + out.y) / 0.25;
    const double highlight = std::exp(-square(across) - square(along));
    return (kDiffuse[band] / kPi * std::abs(out.z) + 0.6 * highlight) * (0.4 + 0.6 * cosine);
}

double slanted_intensity(const IncidentDirection& from, const glm::dvec3& out, size_t band) {
    const bool front = from.side == Side::front, reflected = (out.z > 0) == front;
    constexpr double kDiffuse[] = {0.3, 0.15, 0.08};
    const double angle = radians(30.0 + (front ? 0 : 60) + (reflected ? 0 : 90));
    const glm::dvec3 sum = spherical_direction(from.theta, from.phi) + out;
    const double across = std::cos(angle) * sum.x + std::sin(angle) * sum.y;
    const double along = std::cos(angle) * sum.y - std::sin(angle) * sum.x;
    return (reflected ? 0.6 : 0.4) *
           (kDiffuse[band] / kPi * std::abs(out.z) +
            0.3 * std::exp(-square(across / 0.9) - square(along / 0.5)) * std::abs(out.z));
}

} // namespace rapport::tests
