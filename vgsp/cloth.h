#pragma once

#include "renderer/core/bands.h"
#include "vgsp/draft.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace rapport {

/// The dielectric fibres of a yarn.
struct FibreSpec {
    double diameter_um = 0;
    double refractive_index = 0;
    /// Volume absorption per band [1/µm], Beer–Lambert. Exactly one of this and `color` is given;
    /// neither means clear fibres.
    std::optional<std::vector<double>> absorption_per_um;
    /// The albedo (linear sRGB) that a cloth wholly of this yarn should have under diffuse light;
    /// solved for absorption (colour_solver.h).
    std::optional<std::vector<double>> color;
    /// Share of the light that each passage or reflection at a fibre's surface takes, [0, 1].
    double surface_absorption = 0;
};

enum class YarnSection {
    parallel, ///< fibres parallel to the yarn axis, elliptic section
    twisted,  ///< fibres wound round the axis, circular section
};

struct YarnSpec {
    YarnSection section = YarnSection::parallel;
    int fibres = 0;         ///< number of fibres in the section
    double width_um = 0;    ///< of the section in the plane of the cloth, before flattening
    double height_um = 0;   ///< across it; equal to the width for twisted yarns
    double twist_per_m = 0; ///< turns per metre of yarn axis; + = Z, − = S
    /// Height of the flattened section over the original height, (0, 1]; the width grows by its
    /// inverse, and the fibres' own sections stay round.
    double flatten = 1;
    FibreSpec fibre;
};

/// A woven cloth, as its file says it: the trade's units are kept.
struct Cloth {
    std::string name;
    Draft draft;
    double ends_per_cm = 0;  ///< warp sett
    double picks_per_cm = 0; ///< weft sett
    /// Warp's share of the crimp: h_warp / (h_warp + h_weft), [0, 1].
    double crimp_balance = 0.5;
    YarnSpec warp, weft;
    Bands bands;

    /// Where it came from, for messages, and its text (with the draft's) for the table's metadata.
    std::filesystem::path path;
    std::string source;
};

/// Reads a cloth `.toml` (see the example in scenes/cloths/). A draft file is named relative to it.
/// Unknown keys, units left out, and values outside their domain are FileErrors with the line.
/// `draft_override` replaces the draft that the file names.
Cloth read_cloth(const std::filesystem::path& path,
                 const std::optional<std::filesystem::path>& draft_override = {});

/// The built-in viscose cloth woven to `draft_path` (a bare `.wif` in place of a cloth).
Cloth viscose_cloth(const std::filesystem::path& draft_path);

} // namespace rapport
