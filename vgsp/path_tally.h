#pragma once

#include "materials/table/bsdf_table.h"
#include "vgsp/goniophotometer.h"
#include "vgsp/incident_path.h"

namespace rapport {

/// What a fixed number of consecutive paths of one incident direction deposited: a list, because
/// most of a mesh's bins get nothing from so few.
struct PathBatch {
    std::vector<uint32_t> bins;              ///< block·B + bin of each scattered path
    std::vector<float> weights;              ///< [path, band]
    std::vector<double> unscattered, capped; ///< per band, sums of weights
    GoniophotometerCounts counts;
};

/// Traces paths [first, first + count) of direction number `direction` of the table.
PathBatch trace_batch(const IncidentPathTracer& paths, const BsdfTable& table, size_t direction,
                      uint64_t seed, uint64_t first, uint64_t count);

/// Sums over the paths of one incident direction, in double precision.
class PathTally {
  public:
    explicit PathTally(const BsdfTable& table);

    /// To be called in the order of the paths, for equal sums from equal seeds.
    void add(const PathBatch& batch);
    const GoniophotometerCounts& counts() const { return counts_; }

    /// ε²·N, what the square of the error of the luminous-intensity distribution over its mean
    /// (design: accuracy) would be for one path: 4π·Σ_b Var_b(w)/Ω_b / E[w]², w a path's scattered
    /// weight in the mean over the bands. Unbiased per bin, empty bins included. 0 if nothing
    /// scatters.
    double error_of_one_path() const;
    /// One standard error of that number, relative to it; infinite if nothing has scattered.
    double uncertainty() const;
    double accuracy() const; ///< ε of the mean over these paths; 0 if nothing scatters

    /// Fills the arrays of one direction.
    void write(BsdfTable& table, size_t direction) const;

  private:
    std::vector<double> solid_angle_; ///< per bin of both blocks
    size_t bands_;
    std::vector<double> sum_;       ///< [bin, band], of weights
    std::vector<double> sum_mean2_; ///< [bin], of squared band means of the weight
    std::vector<double> unscattered_, capped_;
    double sum_density2_ = 0; ///< Σ (w²/Ω)², for the uncertainty
    GoniophotometerCounts counts_;
};

/// Sums of what happened to the paths.
GoniophotometerCounts& operator+=(GoniophotometerCounts& a, const GoniophotometerCounts& b);

} // namespace rapport
