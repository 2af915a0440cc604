#pragma once

#include "renderer/core/parallel.h"
#include "tests/support/scattering.h"
#include "vgsp/incident_path.h"

namespace rapport::tests {

/// The mirror images that the weft of a plain weave makes of light from θ = 30° in its plane, a
/// chart of the paper's kind: density over the angle of exit in that plane [1/rad], of what leaves
/// within 15° of it, from −90° to 90°. All fibres are black, so that nothing else is seen.
struct MirrorImages {
    static constexpr int kSteps = 60;
    static constexpr double kTheta = radians(30.0);
    static double angle(int step) { return (step + 0.5) * kPi / kSteps - kPi / 2; }

    std::vector<double> density = std::vector<double>(kSteps), error = density;
    size_t segments = 0; ///< of the cell
    int fibres = 0;
};

/// With fibres cut into segments that turn by at most `max_turn_degrees`.
inline MirrorImages mirror_images(double max_turn_degrees, bool dither, int paths, uint64_t seed) {
    const YarnSpec yarn = loose_yarn(100, 16);
    const MicroElement element =
        build_micro_element(cloth_of(named_weave("plain"), yarn, yarn, 57, 57),
                            {.max_turn_degrees = max_turn_degrees, .dither = dither, .seed = seed});
    const kernel::FibreTracer tracer(element.fibres);
    const std::vector<FibreMedium> media =
        fibre_media(std::vector<FibreOptics>{{1.53, {1}, 1}, {1.53, {1}, 0}}, 1, tracer);
    const IncidentPathTracer tracing{tracer, media, 1, 4096, true};
    const IncidentDirection incident{Side::front, MirrorImages::kTheta, 0};

    constexpr int kBatch = 1 << 14;
    std::vector<std::vector<double>> counts((paths + kBatch - 1) / kBatch,
                                            std::vector<double>(MirrorImages::kSteps));
    parallel_for(counts.size(), [&](size_t batch) {
        IncidentPath path;
        for (int k = 0; k < kBatch; ++k) {
            CounterRng rng(seed, Purpose::test, batch, k);
            tracing.trace(incident, rng, path);
            const glm::dvec3& exit = path.light.direction;
            if (path.fate != PathFate::scattered || exit.z <= 0 ||
                std::abs(exit.y) > std::sin(radians(15.0)))
                continue;
            const double turn = (std::atan2(exit.x, exit.z) + kPi / 2) / kPi;
            const int step =
                std::min(MirrorImages::kSteps - 1, static_cast<int>(turn * MirrorImages::kSteps));
            counts[batch][step] += path.weight(0);
        }
    });
    MirrorImages images;
    images.segments = element.segments;
    images.fibres = static_cast<int>(element.fibres.chains.size());
    const double unit =
        1.0 / (static_cast<double>(counts.size()) * kBatch) / (kPi / MirrorImages::kSteps);
    for (int step = 0; step < MirrorImages::kSteps; ++step) {
        double sum = 0;
        for (const std::vector<double>& batch : counts)
            sum += batch[step];
        images.density[step] = unit * sum;
        images.error[step] = unit * std::sqrt(sum); // mirror images have weight 1
    }
    return images;
}

/// RMS difference of two charts over the mean of the second.
inline double difference(const MirrorImages& a, const MirrorImages& b) {
    double squares = 0, mean = 0;
    for (int step = 0; step < MirrorImages::kSteps; ++step) {
        squares += square(a.density[step] - b.density[step]) / MirrorImages::kSteps;
        mean += b.density[step] / MirrorImages::kSteps;
    }
    return std::sqrt(squares) / mean;
}

inline double peak(const MirrorImages& images) {
    return *std::max_element(images.density.begin(), images.density.end());
}

} // namespace rapport::tests
