#include "renderer/preview/rising_measurement.h"

#include <algorithm>
#include <cmath>

namespace rapport {
namespace {

// The hasty round: 2.7 s of one core for the table of a cotton twill, of 944 fibres to the cell.
constexpr double kHastyTurnDegrees = 6;
constexpr uint64_t kHastyColourPaths = 4096, kHastyPaths = 48;

constexpr uint64_t kPaths = 256; ///< per direction and round: so few need no pilot

constexpr double kSwatchThreads = 6; ///< of the coarser system, along a side of the swatch

void mix(std::vector<float>& mean, const std::vector<float>& more, double share) {
    for (size_t i = 0; i < mean.size(); ++i)
        mean[i] = static_cast<float>(mean[i] + share * (more[i] - mean[i]));
}

void mix(Scattering& mean, const Scattering& more, double share) {
    mix(mean.intensity, more.intensity, share);
    mix(mean.unscattered, more.unscattered, share);
    mix(mean.absorbed, more.absorbed, share);
    mix(mean.capped, more.capped, share);
    mix(mean.lost, more.lost, share);
    for (size_t i = 0; i < mean.accuracy.size(); ++i)
        mean.accuracy[i] = static_cast<float>(
            std::hypot((1 - share) * mean.accuracy[i], share * more.accuracy[i]));
}

} // namespace

void add_to_mean(BsdfTable& mean, const BsdfTable& more) {
    const double before = static_cast<double>(mean.paths.at(0));
    const double share = more.paths.at(0) / (before + more.paths.at(0));
    mix(mean, more, share);
    for (auto& [name, dyes] : mean.colourways)
        mix(dyes, more.colourways.at(name), share);
    for (size_t d = 0; d < mean.paths.size(); ++d)
        mean.paths[d] += more.paths[d];
}

std::unique_ptr<const RisingMeasurement::Bench>
RisingMeasurement::set_up(bool hasty, const GoniophotometerSettings& settings) const {
    MicroElementOptions geometry{.stopped = settings.stopped};
    if (hasty)
        geometry.max_turn_degrees = kHastyTurnDegrees;
    const MicroElement element = build_micro_element(*cloth_, geometry);
    const auto tracer =
        std::make_shared<const kernel::FibreTracer>(element.fibres, settings.stopped);
    ClothOptics optics = cloth_optics(*cloth_, *tracer, settings);
    const double side = kSwatchThreads * 1e4 / std::min(cloth_->ends_per_cm, cloth_->picks_per_cm);
    Swatches swatches;
    const auto add = [&](const std::string& colourway, const std::vector<FibreOptics>& fibres) {
        swatches[colourway] =
            std::make_shared<const FibreSwatch>(tracer, fibres, cloth_->bands, glm::dvec2(side));
    };
    add("", optics.fibres);
    for (const auto& [name, dyes] : optics.colourways)
        add(name, optics.dyed(dyes));
    return std::unique_ptr<const Bench>(
        new Bench{hasty, tracer, facing_yarns(*tracer), std::move(optics), std::move(swatches)});
}

void RisingMeasurement::advance(const StopSignal& stopped, const MeasuringWatch& watch) {
    const bool hasty = rounds_ == 0;
    GoniophotometerSettings settings;
    settings.stopped = stopped;
    settings.max_paths = hasty ? kHastyPaths : kPaths;
    if (hasty)
        settings.colour_paths = kHastyColourPaths;
    if (!bench_ || bench_->hasty != hasty)
        bench_ = set_up(hasty, settings);
    settings.seed = static_cast<uint64_t>(rounds_);
    BsdfTable table = make_full_table(cloth_->bands, true, true);
    table.exit_axis = bench_->facing_yarns;
    measure(*bench_->tracer, bench_->optics.fibres, settings, table, watch, {},
            bench_->optics.colourways);
    if (rounds_ <= 1)
        table_ = std::move(table);
    else
        add_to_mean(table_, table);
    ++rounds_;
}

} // namespace rapport
