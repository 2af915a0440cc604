#include "materials/table/bsdf_table.h"
#include "materials/table/measured_fields.h"
#include "renderer/app/info.h"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <iterator>
#include <numeric>

namespace rapport {

std::string error_text(const MeasurementError& error) {
    return fmt::format("errors: noise {:.4f}, bins {:.4f}, realisation {}, discarded energy {:.1e}",
                       error.noise, error.bins,
                       error.realisation ? fmt::format("{:.4f}", *error.realisation)
                                         : "unknown (of a single one)",
                       error.discarded);
}

namespace {

nlohmann::ordered_json error_json(const MeasurementError& error) {
    nlohmann::ordered_json json{{"noise", error.noise}, {"bins", error.bins}};
    json["realisation"] = nullptr;
    if (error.realisation)
        json["realisation"] = *error.realisation;
    json["discarded"] = error.discarded;
    return json;
}

} // namespace

namespace {

Info measured_info(const std::filesystem::path& path) {
    const MeasuredFields fields = read_measured(path);
    Info info;
    info.json = {{"kind", "measured"},
                 {"description", fields.description},
                 {"isotropic", fields.isotropic()},
                 {"phi", fields.phi.size()},
                 {"theta", fields.theta.size()},
                 {"side", fields.luminance.rows},
                 {"rgb", !fields.rgb.empty()},
                 {"wavelengths", fields.wavelengths}};
    info.text = fmt::format(
        "Measured reflectance (Dupuy & Jakob): {}\n"
        "{}, {} azimuths × {} polar angles of incidence, {} × {} nodes each{}{}\n",
        fields.description,
        fields.isotropic() ? "isotropic"
                           : fmt::format("anisotropic, {}-fold symmetric", fields.symmetry()),
        fields.phi.size(), fields.theta.size(), fields.luminance.rows, fields.luminance.columns,
        fields.rgb.empty() ? "" : ", RGB",
        fields.wavelengths.empty()
            ? ""
            : fmt::format(", {} wavelengths from {:g} to {:g} nm", fields.wavelengths.size(),
                          fields.wavelengths.front(), fields.wavelengths.back()));
    return info;
}

} // namespace

Info table_info(const std::filesystem::path& path) {
    if (is_measured_file(path))
        return measured_info(path);
    const BsdfTable table = read_table(path);
    const size_t bands = table.bands.count();
    const auto row = [&](const std::vector<float>& values, size_t direction) {
        return std::vector<double>(values.begin() + direction * bands,
                                   values.begin() + (direction + 1) * bands);
    };

    Info info;
    info.json["kind"] = "bsdf";
    info.json["accuracy"] = table.largest_accuracy();
    info.json["errors"] = error_json(table.largest_error());
    info.json["paths"] = std::accumulate(table.paths.begin(), table.paths.end(), uint64_t{0});
    info.json["bins"] = 2 * table.exits.bins(); // both hemispheres, as the accuracy counts them
    info.json["bands"] = table.bands.names;
    info.json["partial"] = table.partial();
    info.json["metadata"] = table.metadata;
    info.text = fmt::format("BSDF table{}: {} incident directions × {} exit bins × {} bands ({}), "
                            "accuracy {:.4f}, {} paths\n",
                            table.partial() ? " (partial)" : "", table.directions(),
                            2 * table.exits.bins(), bands, fmt::join(table.bands.names, ", "),
                            table.largest_accuracy(), info.json["paths"].get<uint64_t>());
    info.text += error_text(table.largest_error()) + '\n';

    auto& incident = info.json["incident"] = nlohmann::ordered_json::array();
    for (size_t d = 0; d < table.directions(); ++d) {
        const IncidentDirection& from = table.incident[d];
        const char* side = from.side == Side::front ? "front" : "back";
        const std::vector<double> r = table.reflectance(d), t = table.transmittance(d);
        incident.push_back({{"side", side},
                            {"theta", degrees(from.theta)},
                            {"phi", degrees(from.phi)},
                            {"R", r},
                            {"T", t},
                            {"unscattered", row(table.unscattered, d)},
                            {"absorbed", row(table.absorbed, d)},
                            {"capped", row(table.capped, d)},
                            {"lost", row(table.lost, d)},
                            {"accuracy", table.accuracy[d]},
                            {"errors", error_json(table.error(d))},
                            {"paths", table.paths[d]}});
        fmt::format_to(std::back_inserter(info.text),
                       "{:5} θ {:4.1f}° φ {:5.1f}°: R {:.4f}, T {:.4f}, unscattered {:.4f}, "
                       "absorbed {:.4f}, accuracy {:.4f}\n",
                       side, degrees(from.theta), degrees(from.phi), fmt::join(r, " "),
                       fmt::join(t, " "), fmt::join(row(table.unscattered, d), " "),
                       fmt::join(row(table.absorbed, d), " "), table.accuracy[d]);
    }
    for (const auto& [name, value] : table.metadata)
        if (value.find('\n') == std::string::npos)
            fmt::format_to(std::back_inserter(info.text), "{}: {}\n", name, value);
    return info;
}

} // namespace rapport
