#pragma once

#include "tests/support/scattering.h"

#include <functional>
#include <stdexcept>

// A cloth that has been sheared, measured anew, and rules by which the table of the unsheared cloth
// may stand for it.

namespace rapport::tests {

/// An assembly sheared as cloth is: the yarns keep their lengths and turn at the crossings, the
/// weft staying along x, the warp turned towards it by γ: (x, y) → (x + y·sin γ, y·cos γ). Fibres
/// keep their sections. The kernel's cells are rectangles, so γ is one of the angles at which the
/// sheared repeats close in one: after `rows` cells along the warp it has gone `columns` cells
/// aside, sin γ = columns·width / (rows·height). The chains close after one cell, as those of a
/// MicroElement do.
struct ShearedCloth {
    kernel::FibreAssembly fibres;
    double angle; ///< γ
};

inline ShearedCloth sheared(const kernel::FibreAssembly& assembly, int rows, int columns) {
    const glm::dvec2 cell = assembly.cell;
    const double sine = columns * cell.x / (rows * cell.y), cosine = std::sqrt(1 - square(sine));
    const auto moved = [&](const glm::dvec3& p) {
        return glm::dvec3(p.x + sine * p.y, cosine * p.y, p.z);
    };
    ShearedCloth result{{{cell.x, rows * cell.y * cosine}, {}}, std::asin(sine)};
    for (const kernel::FibreChain& chain : assembly.chains) {
        const bool is_warp = std::abs(chain.period.y) > 0.5 * cell.y;
        if (is_warp && std::abs(chain.period.y) > 1.5 * cell.y)
            throw std::invalid_argument("a chain that closes after several cells");
        // All rows of a warp fibre are one chain; a weft fibre has one in each row.
        kernel::FibreChain copy = chain;
        copy.points.clear();
        for (int row = 0; row < rows; ++row) {
            const glm::dvec3 offset =
                is_warp ? double(row) * chain.period : glm::dvec3(0, row * cell.y, 0);
            for (const glm::dvec3& point : chain.points)
                copy.points.push_back(moved(point + offset));
            if (is_warp && row + 1 < rows)
                continue;
            copy.period = moved(is_warp ? double(rows) * chain.period : chain.period);
            result.fibres.chains.push_back(copy);
            copy.points.clear();
        }
    }
    return result;
}

/// A rule leads from directions at a sheared cloth, where the weft lies along x and the warp at
/// 90° − γ, to those at the unsheared one, by a matrix on what is tangential; the result is
/// normalised.
struct ShearRule {
    const char* name;
    glm::dmat2 (*to_table)(double angle);
};

inline glm::dmat2 turned(double angle) {
    return {{std::cos(angle), std::sin(angle)}, {-std::sin(angle), std::cos(angle)}};
}

inline const std::vector<ShearRule> kShearRules{
    {"weft kept", [](double) { return glm::dmat2(1); }},
    {"warp kept", [](double angle) { return turned(angle); }},
    {"bisector kept",
     [](double angle) { return turned(angle / 2); }}, // polar, as yarns keep their length
    {"not orthogonalised",
     [](double angle) {
         return glm::transpose(glm::dmat2{{1, 0}, {std::sin(angle), std::cos(angle)}});
     }},
};

inline glm::dvec3 mapped(const glm::dmat2& map, const glm::dvec3& w) {
    return glm::normalize(glm::dvec3(map * glm::dvec2(w), w.z));
}

/// Where paths among clear fibres leave, in the bins of a sheared cloth's light from `incident`: by
/// the fibres of the cloth itself, with the unit matrix, or by those of the unsheared cloth, whose
/// directions `to_table` leads to. No energy is lost on the way.
inline ExitCounts sheared_exits(const kernel::FibreTracer& tracer, const glm::dmat2& to_table,
                                const IncidentDirection& incident, uint64_t paths, uint64_t seed) {
    const std::vector<FibreOptics> optics = clear_fibres(1.53, 1);
    const std::vector<FibreMedium> media = fibre_media(optics, 1, tracer);
    const IncidentPathTracer path_tracer{tracer, media, 1, 4096, false};
    const DirectionMesh mesh;
    const ExitBins exits(mesh, towards_light(incident));
    const glm::dvec3 towards = mapped(to_table, towards_light(incident));
    const IncidentDirection inside{incident.side, std::acos(std::abs(towards.z)),
                                   std::atan2(towards.y, towards.x)};
    const glm::dmat2 back = glm::inverse(to_table);
    constexpr size_t kBatches = 64;
    std::vector<ExitCounts> batches(kBatches, ExitCounts(2 * mesh.bins()));
    parallel_for(kBatches, [&](size_t batch) {
        IncidentPath path;
        for (uint64_t k = batch; k < paths; k += kBatches) {
            CounterRng rng(seed, Purpose::test, 0, k);
            path_tracer.trace(inside, rng, path);
            if (path.fate != PathFate::scattered)
                continue;
            const glm::dvec3 w = mapped(back, path.light.direction);
            ++batches[batch][(w.z > 0 ? 0 : mesh.bins()) + exits.bin(w)];
        }
    });
    ExitCounts counts(2 * mesh.bins());
    for (const ExitCounts& some : batches)
        for (size_t i = 0; i < counts.size(); ++i)
            counts[i] += some[i];
    return counts;
}

/// A sum over directions of light of how far two measurements are apart.
struct Departure {
    double squares = 0, flux2 = 0; ///< ∫(I − I′)² and (∫I)²/4π over the sphere

    /// RMS difference of the intensity over its mean, noise taken off.
    double value() const { return std::sqrt(std::max(0.0, squares) / flux2); }
    void add(const ExitCounts& truth, const ExitCounts& other, const IncidentDirection& incident,
             uint64_t paths) {
        const DirectionMesh mesh;
        const ExitBins exits(mesh, towards_light(incident));
        const auto total = static_cast<double>(paths);
        double flux = 0;
        for (size_t i = 0; i < truth.size(); ++i) {
            const double omega = exits.solid_angle(i % mesh.bins());
            // Of two counts, the sum is what noise adds to the square of the difference.
            squares +=
                (square(truth[i] - other[i]) - truth[i] - other[i]) / (omega * square(total));
            flux += truth[i] / total;
        }
        flux2 += square(flux) / (4 * kPi);
    }
};

} // namespace rapport::tests
