#pragma once

#include "materials/table/bsdf_table.h"
#include "vgsp/goniophotometer.h"
#include "vgsp/incident_path.h"

namespace rapport {

/// What traces the paths of one incident direction: one tracer for each realisation of the cloth,
/// and again for each group of bands that cannot share a path (see FibreOptics::refractive_index).
struct PathTracers {
    size_t realisations = 1, groups = 1;
    std::vector<IncidentPathTracer> tracers; ///< [group, realisation]

    const IncidentPathTracer& at(size_t group, size_t realisation) const {
        return tracers[group * realisations + realisation];
    }
};

/// What a fixed number of consecutive paths of one incident direction deposited, in one group of
/// bands: a list, because most of a mesh's bins get nothing from so few.
struct PathBatch {
    size_t group = 0;
    std::vector<uint32_t> quarters; ///< block·4B + quarter of a bin of each scattered path
    std::vector<float> weights;     ///< [path, channel], channels being sets of dyes × bands
    std::vector<double> unscattered, capped, lost; ///< per channel, sums of weights
    std::vector<uint64_t> paths, deposits;         ///< of each realisation, in order
    GoniophotometerCounts counts;
};

/// Traces paths [first, first + count) of direction number `direction` of the table in one group of
/// bands. The realisations share the paths out equally, each taking those that follow one another.
/// Throws Stopped.
PathBatch trace_batch(const PathTracers& tracers, const BsdfTable& table, size_t direction,
                      size_t group, uint64_t seed, uint64_t first, uint64_t count,
                      const StopSignal& stopped);

/// Sums over the paths of one incident direction in one set of dyes, in double precision.
class PathTally {
  public:
    PathTally(const BsdfTable& table, size_t direction, size_t realisations, size_t groups);

    /// To be called in the order of the paths, for equal sums from equal seeds.
    void add(const PathBatch& batch, size_t dyes = 0);
    const GoniophotometerCounts& counts() const { return counts_; }
    /// Paths in each group of bands.
    uint64_t paths() const { return counts_.paths / groups_; }

    /// ε²·N, what the square of the error of the luminous-intensity distribution over its mean
    /// (design: accuracy) would be for one path: 4π·Σ_b Var_b(w)/Ω_b / E[w]², w a path's scattered
    /// weight in the mean over the bands. Unbiased per bin, empty bins included. 0 if nothing
    /// scatters.
    double error_of_one_path() const;
    double accuracy() const; ///< ε of the mean over these paths; 0 if nothing scatters
    /// MeasurementError::bins: each bin's mean against those of its four quarters. What noise adds
    /// to the sum of squares is subtracted without bias; where it leaves less than nothing, 0.
    double bin_error() const;
    /// MeasurementError::realisation, σ/√R from the means of R realisations, noise subtracted in
    /// the same way. Not a number for a single realisation.
    double realisation_error() const;

    /// Fills the arrays of one direction.
    void write(Scattering& scattering, size_t direction) const;

    /// All sums in a fixed order, for a checkpoint, and back.
    std::vector<double> sums() const;
    std::vector<uint64_t> path_counts() const;
    /// Throws std::invalid_argument for lists of another length.
    void restore(std::span<const double> sums, std::span<const uint64_t> path_counts);

  private:
    double total() const; ///< E[w]
    /// 4π/E[w]², or 0 where nothing scatters: makes Σ_b (ΔΦ_b)²/Ω_b of fluxes the squared error.
    double scale() const;

    std::vector<double> solid_angle_; ///< per bin of both blocks
    size_t bands_, groups_;
    std::vector<double> sum_;         ///< [bin, band], of weights
    std::vector<double> sum_mean2_;   ///< [bin], of squared band means of the weight
    std::vector<double> quarter_;     ///< [bin, 4], of band means
    std::vector<double> realisation_; ///< [bin, realisation], of band means; empty for one
    std::vector<double> unscattered_, capped_, lost_;
    std::vector<uint64_t> realisation_paths_; ///< in all groups
    GoniophotometerCounts counts_;
};

/// The variance between the means of R ≥ 2 realisations of one number, without bias, so that it may
/// be below 0: from each one's sum over its paths, the sum of all squares, and each one's paths, of
/// which there are more than R.
double variance_between(std::span<const double> sums, double squares,
                        std::span<const double> paths);

/// Sums of what happened to the paths.
GoniophotometerCounts& operator+=(GoniophotometerCounts& a, const GoniophotometerCounts& b);

} // namespace rapport
