#pragma once

#include "materials/table/direction_mesh.h"
#include "renderer/core/bands.h"
#include "renderer/core/tensor_file.h"

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace rapport {

enum class Side : uint8_t { front = 0, back = 1 };

/// A direction that light arrives from: θ from the normal of the side it arrives on, [0, π/2);
/// φ from +x (weft) towards +y (warp), on both sides.
struct IncidentDirection {
    Side side = Side::front;
    double theta = 0, phi = 0;
};

/// How far a measured direction is from the truth, by cause. The first three are RMS differences of
/// the intensity over both hemispheres, relative to its mean, in the mean over the bands.
struct MeasurementError {
    double noise = 0; ///< ε: of a finite number of paths
    double bins = 0;  ///< what a mesh twice as fine would still change
    /// Of a finite number of realisations of the random cloth; nothing is known of it from one.
    std::optional<double> realisation;
    double discarded = 0; ///< share of the incident flux that was given up, in the worst band
};

/// What a table holds of the light that is scattered by fibres in one set of dyes; BsdfTable tells
/// of the order.
struct Scattering {
    std::vector<float> intensity;   ///< [D, 2, B, bands]
    std::vector<float> unscattered; ///< [D, bands], share of incident flux that met no event
    std::vector<float> absorbed;    ///< [D, bands]
    std::vector<float> capped;      ///< [D, bands], given up: out of events, or lost
    std::vector<float> lost;        ///< [D, bands], the part of `capped` lost among the fibres

    std::vector<float> accuracy;  ///< [D], MeasurementError::noise
    std::vector<float> bin_error; ///< [D], MeasurementError::bins
    /// [D], MeasurementError::realisation; empty for a single realisation.
    std::vector<float> realisation_error;
};

/// A cloth's measured BSDF. What is stored is intensity I = f·cosθo [1/sr], per unit of incident
/// flux: bin means over a mesh of exit directions that moves with the highlights, for single points
/// of incidence. Index order: D incident directions × 2 (0 = reflected to the incident side, 1 =
/// transmitted) × B bins of a hemisphere × bands.
struct BsdfTable : Scattering {
    Bands bands;
    DirectionMesh exits; ///< laid out anew for each direction, see `exits_of`
    /// Of light that arrives on each side, the yarns about which its exits are charted.
    std::array<ConeAxis, 2> exit_axis{ConeAxis::warp, ConeAxis::warp};
    std::vector<IncidentDirection> incident;

    /// The rectangular grid of incidence behind a full table: axes in radians (ascending; φ starts
    /// at 0 and the circle is closed by wrapping), and for [side][θ][φ] the index into `incident`
    /// (at θ = 0 all φ share one). Empty for a partial table.
    std::vector<double> grid_theta, grid_phi;
    std::vector<uint32_t> grid_index; ///< [2, T, P]; kAbsent where a side was not measured
    static constexpr uint32_t kAbsent = ~0u;

    std::vector<uint64_t> paths; ///< [D]
    /// The same paths in other dyes, by the colourway's name.
    std::map<std::string, Scattering> colourways;

    /// Everything that decides the result (cloth source and hash, seed, parameters, program
    /// version), as text; never the time, the threads or a path.
    std::map<std::string, std::string> metadata;

    size_t directions() const { return incident.size(); }
    /// The bins of a direction, the same for light that is reflected and transmitted. To be kept no
    /// longer than the table.
    ExitBins exits_of(size_t direction) const;
    bool partial() const { return grid_index.empty(); }
    float& at(size_t direction, int block, size_t bin, size_t band);
    float at(size_t direction, int block, size_t bin, size_t band) const;
    /// Shares of the incident flux per band: Σ_b intensity·Ω over block 0 or 1.
    std::vector<double> reflectance(size_t direction) const;
    std::vector<double> transmittance(size_t direction) const;
    MeasurementError error(size_t direction) const;
    /// The largest of each over the directions and colourways: a table is as good as its worst.
    MeasurementError largest_error() const;
    float largest_accuracy() const; ///< its ε; 0 for a table without directions
    /// The table of that colourway alone, or, without a name, of the cloth's own dyes. FileError
    /// (`file` for the message) for a name that it does not have.
    BsdfTable in_colourway(const std::string& name, const std::string& file) const;
};

/// Lays out a table's directions and sizes its arrays (zeros).
///
/// The grid of a full table: θ = 0°, 10°, …, 80°, 88° and φ every 15°, 217 directions a side. The
/// time to measure is proportional to their number: accuracy ε takes 4π·Σ E[w²]/Ω / E[w]² / ε²
/// paths a direction (bins of solid angle Ω, path weights w): about 1600/ε² for a plain weave,
/// 2.3 times that for a satin, whose light falls into the narrow bins about the highlight.
BsdfTable make_full_table(const Bands& bands, bool front, bool back);
BsdfTable make_partial_table(const Bands& bands, std::vector<IncidentDirection> incident);

/// Tensor-file container. Reading validates every field; a damaged file is a FileError, and no
/// allocation is made before a size is checked against the file's. Writing validates the same
/// first: a table that could not be read back leaves no file, and what was there stays.
///
/// `format` numbers the layout; files of another are refused. `checksum`, a text, is of all fields
/// that are read, so that a flipped byte is refused.
/// The arrays bear the names of the members above (`intensity`, `unscattered`, `absorbed`,
/// `capped`, `lost`, `paths`, `accuracy`, `bin_error`, `realisation_error`, `grid_theta`,
/// `grid_phi`, `grid_index`), and besides them stand
/// `incident_side` (0 front, 1 back), `incident_theta`, `incident_phi`, the mesh of exits by
/// the edges of its bins, `exit_u` and `exit_v` (direction_mesh.h), `exit_axis` of either side (0
/// warp, 1 weft; exit_chart.h), `solid_angle` [D, columns] of each bin of a column [sr] (bin b is
/// in column b / rows, and rows are equal), `band_edges_nm` (absent for RGB), and as texts
/// `band_names` (a JSON array), `metadata` (a JSON object) and `description`. `intensity` is in
/// half precision, whose rounding is far below any noise, but for a number too large for it: then
/// all are in single. Angles are in radians, as in the other tables of this container, so that they
/// survive the round trip bit for bit. `grid_*` are absent from a partial table,
/// `realisation_error` from one of a single realisation. Where there are colourways, `colourways`
/// has their names (a JSON array), and the fields of the first are `colourway_0_intensity` and so
/// on. Other fields are ignored.
void write_table(const BsdfTable& table, const std::filesystem::path& path);
BsdfTable read_table(const std::filesystem::path& path);
/// As `read_table`, of the fields of the file at `path`, but that the checksum is not asked.
BsdfTable table_of(const TensorFile& fields, const std::filesystem::path& path);

/// FileError for a colourway that `file` has not, told those that it has.
[[noreturn]] void refuse_colourway(const std::string& name, const std::vector<std::string>& names,
                                   const std::string& file);

/// What belongs to the colourway `name` of a cloth; refused where there is none. The empty name, of
/// the cloth's own dyes, may be among them.
template <class T>
const T& colourway(const std::map<std::string, T>& colourways, const std::string& name,
                   const std::string& file) {
    if (const auto found = colourways.find(name); found != colourways.end())
        return found->second;
    std::vector<std::string> names;
    for (const auto& [known, value] : colourways)
        if (!known.empty())
            names.push_back(known);
    refuse_colourway(name, names, file);
}

} // namespace rapport
