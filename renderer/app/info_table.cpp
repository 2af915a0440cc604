#include "materials/table/bsdf_table.h"
#include "materials/table/measured_fields.h"
#include "materials/table/reciprocity.h"
#include "renderer/app/info.h"

#include <algorithm>
#include <cmath>
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

void add_reciprocity(Info& info, const BsdfTable& table) {
    info.json["reciprocity"] = nullptr;
    const std::optional<ReciprocityGap> gap = reciprocity_gap(table);
    if (!gap)
        return;
    info.json["reciprocity"] = {{"gap", gap->gap}, {"error", gap->error}, {"noise", gap->noise}};
    info.text +=
        fmt::format("reciprocity gap {:.4f} ± {:.4f} of the mean; noise alone makes {:.4f}",
                    gap->gap, gap->error, gap->noise);
    if (gap->noise > 0)
        info.text += fmt::format(", {:.2f} times which it is", gap->gap / gap->noise);
    info.text += '\n';
}

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

/// What a table says in one set of dyes of light from each direction.
nlohmann::ordered_json incident_json(const BsdfTable& table) {
    const size_t bands = table.bands.count();
    const auto row = [&](const std::vector<float>& values, size_t direction) {
        return std::vector<double>(values.begin() + direction * bands,
                                   values.begin() + (direction + 1) * bands);
    };
    auto incident = nlohmann::ordered_json::array();
    for (size_t d = 0; d < table.directions(); ++d) {
        const IncidentDirection& from = table.incident[d];
        incident.push_back({{"side", from.side == Side::front ? "front" : "back"},
                            {"theta", degrees(from.theta)},
                            {"phi", degrees(from.phi)},
                            {"R", table.reflectance(d)},
                            {"T", table.transmittance(d)},
                            {"unscattered", row(table.unscattered, d)},
                            {"absorbed", row(table.absorbed, d)},
                            {"capped", row(table.capped, d)},
                            {"lost", row(table.lost, d)},
                            {"accuracy", table.accuracy[d]},
                            {"errors", error_json(table.error(d))},
                            {"paths", table.paths[d]}});
    }
    return incident;
}

/// Which of many directions a person wants to see: light along the normal, and at about 50° and
/// the steepest angle along weft and warp, of each side.
bool is_telling(const nlohmann::ordered_json& from, double steepest) {
    const double theta = from["theta"], phi = from["phi"];
    const bool along = std::abs(phi) < 0.01 || std::abs(phi - 90) < 0.01;
    return theta < 0.01 || (along && (std::abs(theta - 50) < 5 || theta > steepest - 0.01));
}

/// A line for each direction, or of many for some.
std::string incident_text(const nlohmann::ordered_json& incident) {
    constexpr size_t kFew = 24;
    double steepest = 0;
    for (const nlohmann::ordered_json& from : incident)
        steepest = std::max(steepest, from["theta"].get<double>());
    size_t left_out = 0;
    const auto numbers = [](const nlohmann::ordered_json& values) {
        return fmt::format("{:.4f}", fmt::join(values.get<std::vector<double>>(), " "));
    };
    std::string text;
    for (const nlohmann::ordered_json& from : incident) {
        if (incident.size() > kFew && !is_telling(from, steepest)) {
            ++left_out;
            continue;
        }
        text += fmt::format("{:5} θ {:4.1f}° φ {:5.1f}°: R {}, T {}, unscattered {}, absorbed {}, "
                            "accuracy {:.4f}\n",
                            from["side"].get<std::string>(), from["theta"].get<double>(),
                            from["phi"].get<double>(), numbers(from["R"]), numbers(from["T"]),
                            numbers(from["unscattered"]), numbers(from["absorbed"]),
                            from["accuracy"].get<double>());
    }
    if (left_out > 0)
        text += fmt::format("{} more directions: --json\n", left_out);
    return text;
}

} // namespace

Info table_info(const std::filesystem::path& path) {
    if (is_measured_file(path))
        return measured_info(path);
    const BsdfTable table = read_table(path);
    Info info;
    info.json["kind"] = "bsdf";
    info.json["accuracy"] = table.largest_accuracy();
    info.json["errors"] = error_json(table.largest_error());
    info.json["paths"] = std::accumulate(table.paths.begin(), table.paths.end(), uint64_t{0});
    info.json["bins"] = 2 * table.exits.bins(); // both hemispheres, as the accuracy counts them
    info.json["bands"] = table.bands.names;
    info.json["partial"] = table.partial();
    info.json["metadata"] = table.metadata;
    info.text =
        fmt::format("BSDF table{}: {} incident directions × {} exit bins × {} bands ({}), "
                    "accuracy {:.4f}, {} paths\n",
                    table.partial() ? " (partial)" : "", table.directions(), 2 * table.exits.bins(),
                    table.bands.count(), fmt::join(table.bands.names, ", "),
                    table.largest_accuracy(), info.json["paths"].get<uint64_t>());
    info.text += error_text(table.largest_error()) + '\n';
    add_reciprocity(info, table);

    info.json["incident"] = incident_json(table);
    info.text += incident_text(info.json["incident"]);
    for (const auto& [name, scattering] : table.colourways) {
        const BsdfTable dyed = table.in_colourway(name, path.string());
        const nlohmann::ordered_json incident = incident_json(dyed);
        info.json["colourways"][name] = {{"accuracy", dyed.largest_accuracy()},
                                         {"errors", error_json(dyed.largest_error())},
                                         {"incident", incident}};
        info.text += fmt::format("colourway {}: accuracy {:.4f}\n", name, dyed.largest_accuracy()) +
                     incident_text(incident);
    }
    for (const auto& [name, value] : table.metadata)
        if (value.find('\n') == std::string::npos)
            fmt::format_to(std::back_inserter(info.text), "{}: {}\n", name, value);
    return info;
}

} // namespace rapport
