#include "materials/table/bsdf_table.h"

#include "renderer/core/error.h"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <stdexcept>

namespace rapport {
namespace {

constexpr int kGridThetaDegrees[] = {0, 10, 20, 30, 40, 50, 60, 70, 80, 88};
constexpr int kGridPhiStepDegrees = 15;

void size_arrays(BsdfTable& table) {
    const size_t directions = table.directions();
    const size_t bands = table.bands.count();
    table.intensity.assign(directions * 2 * table.exits.bins() * bands, 0);
    table.unscattered.assign(directions * bands, 0);
    table.absorbed.assign(directions * bands, 0);
    table.capped.assign(directions * bands, 0);
    table.lost.assign(directions * bands, 0);
    table.accuracy.assign(directions, 0);
    table.bin_error.assign(directions, 0);
    table.paths.assign(directions, 0);
}

std::vector<double> flux(const BsdfTable& table, size_t direction, int block) {
    std::vector<double> sum(table.bands.count());
    const ExitBins exits = table.exits_of(direction);
    for (size_t bin = 0; bin < table.exits.bins(); ++bin) {
        const double solid_angle = exits.solid_angle(bin);
        for (size_t band = 0; band < sum.size(); ++band)
            sum[band] += table.at(direction, block, bin, band) * solid_angle;
    }
    return sum;
}

size_t intensity_index(const BsdfTable& table, size_t direction, int block, size_t bin,
                       size_t band) {
    return ((direction * 2 + block) * table.exits.bins() + bin) * table.bands.count() + band;
}

MeasurementError error_of(const Scattering& scattering, size_t direction, size_t bands) {
    MeasurementError error{scattering.accuracy[direction], scattering.bin_error[direction],
                           std::nullopt, 0};
    if (!scattering.realisation_error.empty())
        error.realisation = scattering.realisation_error[direction];
    const auto first = scattering.capped.begin() + static_cast<ptrdiff_t>(direction * bands);
    error.discarded = *std::max_element(first, first + static_cast<ptrdiff_t>(bands));
    return error;
}

} // namespace

float& BsdfTable::at(size_t direction, int block, size_t bin, size_t band) {
    return intensity[intensity_index(*this, direction, block, bin, band)];
}

float BsdfTable::at(size_t direction, int block, size_t bin, size_t band) const {
    return intensity[intensity_index(*this, direction, block, bin, band)];
}

ExitBins BsdfTable::exits_of(size_t direction) const {
    const IncidentDirection& from = incident[direction];
    return {exits, spherical_direction(from.theta, from.phi),
            exit_axis[static_cast<size_t>(from.side)]};
}

std::vector<double> BsdfTable::reflectance(size_t direction) const {
    return flux(*this, direction, 0);
}

std::vector<double> BsdfTable::transmittance(size_t direction) const {
    return flux(*this, direction, 1);
}

MeasurementError BsdfTable::error(size_t direction) const {
    return error_of(*this, direction, bands.count());
}

MeasurementError BsdfTable::largest_error() const {
    MeasurementError largest;
    const auto add = [&](const Scattering& scattering) {
        for (size_t d = 0; d < directions(); ++d) {
            const MeasurementError here = error_of(scattering, d, bands.count());
            largest.noise = std::max(largest.noise, here.noise);
            largest.bins = std::max(largest.bins, here.bins);
            largest.realisation = std::max(largest.realisation, here.realisation); // none is least
            largest.discarded = std::max(largest.discarded, here.discarded);
        }
    };
    add(*this);
    for (const auto& [name, scattering] : colourways)
        add(scattering);
    return largest;
}

float BsdfTable::largest_accuracy() const { return static_cast<float>(largest_error().noise); }

BsdfTable BsdfTable::in_colourway(const std::string& name, const std::string& file) const {
    BsdfTable table = *this;
    table.colourways.clear();
    if (name.empty())
        return table;
    static_cast<Scattering&>(table) = colourway(colourways, name, file);
    return table;
}

void refuse_colourway(const std::string& name, const std::vector<std::string>& names,
                      const std::string& file) {
    throw FileError(file, "",
                    names.empty() ? "no colourway's name, the cloth having none"
                                  : fmt::format("a colourway: {}", fmt::join(names, ", ")),
                    fmt::format("\"{}\"", name));
}

BsdfTable make_full_table(const Bands& bands, bool front, bool back) {
    if (!front && !back)
        throw std::invalid_argument("make_full_table: no side to measure");
    BsdfTable table;
    table.bands = bands;
    for (const int theta : kGridThetaDegrees)
        table.grid_theta.push_back(radians(static_cast<double>(theta)));
    for (int phi = 0; phi < 360; phi += kGridPhiStepDegrees)
        table.grid_phi.push_back(radians(static_cast<double>(phi)));

    for (const Side side : {Side::front, Side::back}) {
        const bool measured = side == Side::front ? front : back;
        for (const double theta : table.grid_theta)
            for (const double phi : table.grid_phi) {
                const bool shared = theta == 0 && phi > 0;
                if (measured && !shared)
                    table.incident.push_back({side, theta, phi});
                table.grid_index.push_back(measured
                                               ? static_cast<uint32_t>(table.incident.size() - 1)
                                               : BsdfTable::kAbsent);
            }
    }
    size_arrays(table);
    return table;
}

BsdfTable make_partial_table(const Bands& bands, std::vector<IncidentDirection> incident) {
    BsdfTable table;
    table.bands = bands;
    table.incident = std::move(incident);
    size_arrays(table);
    return table;
}

} // namespace rapport
