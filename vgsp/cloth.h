#pragma once

#include "renderer/core/bands.h"
#include "vgsp/draft.h"
#include "vgsp/per_band.h"

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

// A cloth file is TOML 1.0. These are all its keys; any other is an error, and so is the lack of
// one that has neither a default nor "optional" beside it.
//
//   key                  unit  value                   default   meaning
//   name                       text                    the file  for messages and metadata
//   draft                      text                    -         a .wif, relative to this file
//   weave                      text                    -         see named_weave() in draft.h
//   rows                       texts of 0 and 1        -         pick 1 first, 1 = warp up
//                                                                (exactly one of these three)
//   crimp_balance              [0, 1]                  0.5       warp's share of the crimp height
//   bands.edges_nm       nm    2 or more, increasing   R, G, B   band b ends at edges b and b + 1
//
//   warp.ends_per_cm     1/cm  (0, 1000]                         sett of the warp
//   weft.picks_per_cm    1/cm  (0, 1000]                         sett of the weft
//
//   In [warp] and in [weft], where not all threads are alike, instead of the yarn's keys:
//   order                      names of yarns          -         of the threads in turn, the first
//                                                                first, again and again
//   colors                     table of yarns          -         number of a colour of the draft =
//                                                                name of the yarn of its threads
//
//   In [warp] and in [weft], and in each [yarn.NAME] that they name, of the yarn:
//   section                    "parallel", "twisted",            how its fibres lie
//                              "plied"
//   fibres                     whole, 1 … 10 000       -         number of fibres in the section
//   tex                  g/km  (0, 10 000]             -         of the yarn: as many fibres as
//                                                                weigh it (exactly one of these
//                                                                two)
//   width_um, height_um  µm    (0, 10 000]                       parallel: axes of the ellipse
//   diameter_um          µm    (0, 10 000]                       else: of the circle
//   twist_per_m          1/m   [−100 000, 100 000]               else: turns; + is Z, − is S
//   plies                      whole, 2 … 6                      plied: number of singles, of each
//                                                                of which the keys above tell
//   ply_twist_per_m      1/m   [−100 000, 100 000]               plied: turns; + is Z, − is S
//   flatten                    (0, 1]                  1         see YarnSpec
//   migration_um         µm    [0, 100]                0         see Irregularity
//   deviation_degrees    °     [0, 30]                 0         see Irregularity
//   spacing_jitter_um    µm    [0, 100]                0         see Irregularity
//   stray_fibres               [0, 1]                  0         see Irregularity
//
//   In [warp.fibre], [weft.fibre] and each [yarn.NAME.fibre]:
//   diameter_um          µm    (0, 1000]               -         of the round fibre
//   dtex                 dg/km (0, 10 000]             -         its fineness instead, with density
//                                                                (exactly one of these two)
//   density_g_cm3        g/cm³ (0, 25]                 optional  needed by dtex, tex and for mass
//   diameter_variation         [0, 0.3]                0         see FibreSpec
//   refractive_index           [1, 4]                            per band, or one for all bands,
//                                                                which are then traced together
//   absorption_per_um    1/µm  0 or more               0         per band, or one for all bands
//   color                      [0, 1)                  optional  per band, instead of absorption
//   surface_absorption         [0, 1]                  0         see FibreSpec
//   roughness                  [0, 1]                  0         see FibreSpec
//
//   In each [colourway.NAME], the same cloth in other dyes; at most 32, measured together:
//   warp, weft, yarn.NAME      table                   its own   of the yarn, where all threads are
//                                                                alike: its `color` or its
//                                                                `absorption_per_um`, as of a fibre

namespace rapport {

/// What dims light within a fibre. At most one of the two is given; neither means clear.
struct Dye {
    /// Volume absorption per band [1/µm], Beer–Lambert.
    std::optional<std::vector<double>> absorption_per_um;
    /// The albedo per band (of the default bands: linear sRGB) that a cloth wholly of this yarn
    /// should have under diffuse light; solved for absorption (colour_solver.h).
    std::optional<std::vector<double>> color;

    bool operator==(const Dye&) const = default;
};

/// The dielectric fibres of a yarn.
struct FibreSpec : Dye {
    double diameter_um = 0;
    std::optional<double> density_g_cm3;
    /// Coefficient of variation of the diameter from fibre to fibre: standard deviation over mean
    /// of a normal distribution cut off at three standard deviations.
    double diameter_variation = 0;
    PerBand refractive_index = 1;
    /// Share of the light that each passage or reflection at a fibre's surface takes, [0, 1].
    double surface_absorption = 0;
    /// Of the surface: the width α of the Trowbridge–Reitz (GGX) distribution of its facets'
    /// normals (fibre_boundary.h); half of the surface is tilted by more than arctan α. 0 = smooth,
    /// and so is below 1e-6.
    double roughness = 0;

    bool operator==(const FibreSpec&) const = default;
};

/// Fineness [dtex: grams per 10 km] of a round fibre and its diameter [µm]: d = 20·√(dtex/(π·ρ)), ρ
/// the density [g/cm³] (W. E. Morton, J. W. S. Hearle, Physical Properties of Textile Fibres).
double fibre_diameter_um(double dtex, double density_g_cm3);
double fibre_dtex(double diameter_um, double density_g_cm3);

/// How a yarn's fibres depart from the perfect arrangement (the paper, section 6). All zero: not at
/// all. Each is drawn anew for every yarn of the cell, from the micro-element's seed.
struct Irregularity {
    /// Standard deviation, across and up, of a fibre's wandering from its place along the yarn, and
    /// that of its tangent's angle. Both or neither are zero: the wandering is a Gaussian process
    /// of autocorrelation exp(−s²/2ℓ²), so their ratio is its correlation length ℓ along the yarn.
    double migration_um = 0, deviation_degrees = 0;
    double spacing_jitter_um = 0; ///< standard deviation, per direction, of the fibres' places
    /// Share of the fibres at the yarn's surface that leave it in loops, where they are not held
    /// down by the crossed yarns.
    double stray_fibres = 0;

    /// ℓ [µm]; infinite without migration.
    double correlation_length_um() const;
    bool operator==(const Irregularity&) const = default;
};

enum class YarnSection {
    parallel, ///< fibres parallel to the yarn axis, elliptic section
    twisted,  ///< fibres wound round the axis, circular section
    plied,    ///< twisted yarns ("singles") side by side wound round the axis
};

struct YarnSpec {
    YarnSection section = YarnSection::parallel;
    int fibres = 0;         ///< number of fibres in the section, or in that of a single
    double width_um = 0;    ///< of that section in the plane of the cloth, before flattening
    double height_um = 0;   ///< across it; equal to the width for twisted yarns
    double twist_per_m = 0; ///< turns per metre of yarn axis; + = Z, − = S
    int plies = 1;          ///< number of singles; 1 unless plied
    /// Turns of the singles round each other. `twist_per_m` is theirs as they were spun, to which
    /// plying adds its own: so a Z single plied S loses twist, as it does on the machine.
    double ply_twist_per_m = 0;
    /// Height of the flattened section over the original height, (0, 1]; the width grows by its
    /// inverse, and the fibres' own sections stay round.
    double flatten = 1;
    Irregularity irregularity;
    FibreSpec fibre;

    bool operator==(const YarnSpec&) const = default;
};

struct NamedYarn {
    std::string name;
    YarnSpec yarn;

    bool operator==(const NamedYarn&) const = default;
};

/// A woven cloth, as its file says it: the trade's units are kept.
struct Cloth {
    std::string name;
    /// As it was given, or repeated as often as an order of yarns asks; weavable() trims and
    /// reduces it. Its warp_yarns and weft_yarns are indices into `yarns`.
    Draft draft;
    double ends_per_cm = 0;  ///< warp sett
    double picks_per_cm = 0; ///< weft sett
    /// Warp's share of the crimp, as Peirce's heights would be: h_warp / (h_warp + h_weft), [0, 1].
    /// So much stiffer are picks than ends, of both together (crossing_lift.h).
    double crimp_balance = 0.5;
    YarnSpec warp, weft; ///< of all threads, unless the draft has the yarns of each
    std::vector<NamedYarn> yarns;
    Bands bands;
    /// By the colourway's name and the yarn's place (YarnKind): the dyes of those yarns that are
    /// not dyed as they are otherwise.
    using ColourwayDyes = std::map<std::string, std::map<std::string, Dye>>;
    ColourwayDyes colourways;

    /// Where it came from, for messages, and cloth_text() for the table's metadata.
    std::filesystem::path path;
    std::string source;
};

/// Reads a cloth file. Unknown keys, missing ones, values of the wrong type or outside their
/// domain, and a draft that cannot be woven are FileErrors with the line. `draft_override` replaces
/// the draft that the file names.
Cloth read_cloth(const std::filesystem::path& path,
                 const std::optional<std::filesystem::path>& draft_override = {});

/// The built-in viscose cloth woven to `draft_path` (a bare `.wif` in place of a cloth).
Cloth viscose_cloth(const std::filesystem::path& draft_path);

/// A cloth `.toml`, or a bare `.wif` as viscose; FileError for another ending.
Cloth load_cloth(const std::filesystem::path& path);

struct YarnKind {
    std::string place; ///< in the file: "warp", "weft" or "yarn.NAME"
    const YarnSpec* yarn;
};

/// The kinds of yarn in the cloth; a fibre's kind is an index into these. First the warp and the
/// weft, each if all its threads are alike, then the named yarns.
std::vector<YarnKind> yarn_kinds(const Cloth& cloth);

/// The cloth as a cloth file that stands alone: keys in a fixed order, numbers to their last digit,
/// the weave as the rows that are woven, so that whatever decides the interlacement, yarns or
/// fibres changes the text, and comments, layout and paths do not. Reading it back gives the same
/// text. FileError if the draft cannot be woven.
std::string cloth_text(const Cloth& cloth);

} // namespace rapport
