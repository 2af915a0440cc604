#include "materials/table/export_csv.h"

#include "renderer/core/atomic_file.h"

#include <fmt/format.h>

namespace rapport {
namespace {

/// A field with a comma, a quote or a line break is quoted, as in RFC 4180.
std::string csv_field(const std::string& text) {
    if (text.find_first_of(",\"\r\n") == std::string::npos)
        return text;
    std::string quoted = "\"";
    for (const char c : text)
        quoted.append(c == '"' ? 2 : 1, c);
    return quoted + '"';
}

/// One line per block, bin and band of an incident direction.
fmt::memory_buffer csv_lines(const BsdfTable& table, size_t direction,
                             const std::vector<std::string>& bands) {
    const IncidentDirection& incident = table.incident[direction];
    const std::string from =
        fmt::format("{},{:.9g},{:.9g}", incident.side == Side::front ? "front" : "back",
                    degrees(incident.theta), degrees(incident.phi));
    const ExitBins exits = table.exits_of(direction);
    fmt::memory_buffer lines;
    for (int block = 0; block < 2; ++block)
        for (size_t bin = 0; bin < table.exits.bins(); ++bin) {
            const glm::dvec3 centre = exits.direction(bin);
            const double theta = degrees(std::acos(centre.z)), phi = degrees(azimuth(centre));
            for (size_t band = 0; band < bands.size(); ++band)
                fmt::format_to(std::back_inserter(lines), "{},{:.9g},{:.9g},{:.9g},{},{}\n", from,
                               block == 0 ? theta : 180 - theta, phi, exits.solid_angle(bin),
                               bands[band], table.at(direction, block, bin, band));
        }
    return lines;
}

} // namespace

void export_csv(const BsdfTable& table, const std::filesystem::path& path) {
    std::vector<std::string> bands;
    for (const std::string& name : table.bands.names)
        bands.push_back(csv_field(name));
    write_stream_atomically(path, [&](std::ofstream& out) {
        out << "side,theta_i,phi_i,theta_o,phi_o,solid_angle,band,intensity\n";
        for (size_t direction = 0; direction < table.directions(); ++direction) {
            const fmt::memory_buffer lines = csv_lines(table, direction, bands);
            out.write(lines.data(), static_cast<std::streamsize>(lines.size()));
        }
    });
}

} // namespace rapport
