#include "renderer/preview/rising_measurement.h"

#include <cmath>

namespace rapport {
namespace {

// The hasty round: a table of the quickstart's satin in less than two seconds on two cores.
constexpr double kHastyTurnDegrees = 4;
constexpr uint64_t kHastyColourPaths = 4096, kHastyPaths = 64;

constexpr uint64_t kPaths = 256; ///< per direction and round: so few need no pilot

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
    throw_if(settings.stopped);
    kernel::FibreTracer tracer(element.fibres);
    ClothOptics optics = cloth_optics(*cloth_, tracer, settings);
    return std::unique_ptr<const Bench>(new Bench{hasty, std::move(tracer), std::move(optics)});
}

void RisingMeasurement::advance(const StopSignal& stopped) {
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
    measure(bench_->tracer, bench_->optics.fibres, settings, table, {}, {},
            bench_->optics.colourways);
    if (rounds_ <= 1)
        table_ = std::move(table);
    else
        add_to_mean(table_, table);
    ++rounds_;
}

} // namespace rapport
