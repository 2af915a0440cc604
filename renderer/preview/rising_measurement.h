#pragma once

#include "renderer/scene/shape/fibre_swatch.h"
#include "vgsp/measure_cloth.h"

#include <map>
#include <memory>

namespace rapport {

/// Told of a measurement while it goes on.
using MeasuringWatch = std::function<void(const GoniophotometerProgress&)>;

/// Measures a cloth in rounds, of whose results the mean is taken, so that there is a table soon
/// and a better one after every round. The first round is hasty: fibres of coarser cylinders,
/// colours solved for by fewer paths; its table is dropped once the second is there. All others
/// trace equally many paths in the same micro-element, each with random numbers of its own.
class RisingMeasurement {
  public:
    explicit RisingMeasurement(std::shared_ptr<const Cloth> cloth) : cloth_(std::move(cloth)) {}

    using Swatches = std::map<std::string, std::shared_ptr<const FibreSwatch>>;

    /// One more round. Throws FileError for a cloth that cannot exist, and Stopped, leaving all as
    /// it was.
    void advance(const StopSignal& stopped, const MeasuringWatch& watch = {});

    int rounds() const { return rounds_; }
    /// Of all sides and directions; ε is that of the mean, errors of rounds being independent.
    const BsdfTable& table() const { return table_; }
    uint64_t paths() const { return table_.paths.empty() ? 0 : table_.paths[0]; } ///< per direction
    const std::shared_ptr<const Cloth>& cloth() const { return cloth_; }
    /// The fibres of the last round by colourway, "" being as they are otherwise: a square of some
    /// threads to look at; nothing before the first.
    Swatches swatches() const { return bench_ ? bench_->swatches : Swatches(); }

  private:
    struct Bench {
        bool hasty;
        std::shared_ptr<const kernel::FibreTracer> tracer;
        std::array<ConeAxis, 2> facing_yarns;
        ClothOptics optics;
        Swatches swatches;
    };
    std::unique_ptr<const Bench> set_up(bool hasty, const GoniophotometerSettings& settings) const;

    std::shared_ptr<const Cloth> cloth_;
    std::unique_ptr<const Bench> bench_; ///< of the last round
    BsdfTable table_;
    int rounds_ = 0;
};

/// Makes `mean`, of some paths, the mean over those of `more` too, which has the same directions
/// and colourways. The bins' own error, which paths do not lessen, stays.
void add_to_mean(BsdfTable& mean, const BsdfTable& more);

} // namespace rapport
