#include "renderer/scene/shape/fibre_swatch.h"

#include "vgsp/measure_cloth.h"

#include <limits>

namespace rapport {
namespace {

std::shared_ptr<const kernel::FibreTracer> traced_fibres(const Cloth& cloth, uint64_t seed) {
    return std::make_shared<const kernel::FibreTracer>(
        build_micro_element(cloth, {.seed = seed}).fibres);
}

/// The cloth's optics in the dyes of one colourway.
std::vector<FibreOptics> dyed_optics(const Cloth& cloth, const kernel::FibreTracer& tracer,
                                     const std::string& colourway, uint64_t seed) {
    const ClothOptics optics = cloth_optics(cloth, tracer, {.seed = seed});
    if (colourway.empty())
        return optics.fibres;
    return optics.dyed(rapport::colourway(optics.colourways, colourway, cloth.path.string()));
}

} // namespace

/// Where a line leaves the box.
struct FibreSwatch::Exit {
    double distance = std::numeric_limits<double>::infinity();
    glm::dvec3 normal{0};
};

FibreSwatch::FibreSwatch(const Cloth& cloth, const glm::dvec2& size, const std::string& colourway,
                         uint64_t seed)
    : FibreSwatch(traced_fibres(cloth, seed), cloth, size, colourway, seed) {}

FibreSwatch::FibreSwatch(std::shared_ptr<const kernel::FibreTracer> tracer, const Cloth& cloth,
                         const glm::dvec2& size, const std::string& colourway, uint64_t seed)
    : FibreSwatch(tracer, dyed_optics(cloth, *tracer, colourway, seed), cloth.bands, size) {}

FibreSwatch::FibreSwatch(std::shared_ptr<const kernel::FibreTracer> tracer,
                         const std::vector<FibreOptics>& optics, const Bands& bands,
                         const glm::dvec2& size)
    : tracer_(std::move(tracer)), low_(-0.5 * size, tracer_->z_min()),
      high_(0.5 * size, tracer_->z_max()), media_(media_of_groups(optics, bands.count(), *tracer_)),
      band_rgb_(bands.to_rgb()) {}

FibreSwatch::Exit FibreSwatch::exit(const glm::dvec3& position, const glm::dvec3& direction) const {
    Exit exit;
    for (int axis = 0; axis < 3; ++axis) {
        if (direction[axis] == 0)
            continue;
        const double wall = direction[axis] > 0 ? high_[axis] : low_[axis];
        const double distance = std::max((wall - position[axis]) / direction[axis], 0.0);
        if (distance < exit.distance) {
            exit.distance = distance;
            exit.normal = glm::dvec3(0);
            exit.normal[axis] = std::copysign(1.0, direction[axis]);
        }
    }
    return exit;
}

FibreSwatch::Passage FibreSwatch::passage(const glm::dvec3& position, const glm::dvec3& direction,
                                          const Exit& exit, const Rgb& weight,
                                          bool scattered) const {
    return {position + direction * exit.distance, direction, exit.normal, weight, scattered};
}

std::optional<FibreSwatch::Passage> FibreSwatch::follow(const glm::dvec3& position,
                                                        const glm::dvec3& direction,
                                                        CounterRng& rng) const {
    const size_t groups = media_.size(), channels = band_rgb_.size() / groups;
    const size_t group =
        groups == 1 ? 0 : std::min(static_cast<size_t>(rng.uniform() * groups), groups - 1);
    const IncidentPathTracer tracer{*tracer_, media_[group], channels,
                                    GoniophotometerSettings{}.max_events, true};
    IncidentPath path;
    path.start(in_cloth(position), direction, media_[group].size(), channels);
    for (;;) {
        const glm::dvec3 from = position + path.light.travelled;
        const glm::dvec3 along = path.light.direction;
        const bool scattered = path.light.events > 0;
        const std::optional<PathFate> fate = tracer.step(path, rng);
        const bool left = fate == PathFate::scattered || fate == PathFate::unscattered;
        if (fate && !left)
            return std::nullopt;
        if (!left && over_cloth(position + path.light.travelled))
            continue;
        optical_depths(path.light, media_[group], path.optical_depth);
        Rgb weight(0);
        for (size_t channel = 0; channel < channels; ++channel)
            weight += static_cast<float>(groups * path.weight(channel)) *
                      band_rgb_[group * channels + channel];
        return passage(from, along, exit(from, along), weight, scattered);
    }
}

std::optional<FibreSwatch::Passage> FibreSwatch::pass(const glm::dvec3& position,
                                                      const glm::dvec3& direction) const {
    const Exit exit = this->exit(position, direction);
    const kernel::FibreTracer::Entry entry =
        tracer_->enter(in_cloth(position), direction, kernel::FibreTracer::kNone);
    if (entry.flight == kernel::FibreTracer::Flight::lost ||
        (entry.flight == kernel::FibreTracer::Flight::enters &&
         entry.point.distance < exit.distance))
        return std::nullopt;
    return passage(position, direction, exit, Rgb(1), false);
}

} // namespace rapport
