#pragma once

#include "vgsp/micro_element.h"
#include "vgsp/plane_scan.h"

#include <algorithm>
#include <optional>
#include <vector>

// Where a cloth puts its highlights, against those of real cloths.

namespace rapport::tests {

/// A cloth as I. Sadeghi et al. 2013, "A Practical Microcylinder Appearance Model for Cloth
/// Rendering", found it by measurement: inclinations of its bright threads, and γ_s and γ_v, the
/// standard deviations of the half angle about them in which light is reflected by a fibre's
/// surface and by what is in it.
struct MeasuredCloth {
    const char* name;
    std::vector<double> inclinations; ///< [°], 0 or greater; the negative ones are there as well
    double surface, volume;           ///< γ_s, γ_v [°]

    /// Mirrored in a thread of inclination β, light along the normal leaves at 2β [°], in a lobe of
    /// twice the half angle's deviation.
    static double exit(double inclination) { return 2 * inclination; }
    double narrowest() const { return 2 * surface; }
    double widest() const { return 2 * volume; }
};
inline const MeasuredCloth kSatinCharmeuse{"polyester satin charmeuse", {0, 18, 32}, 2.5, 5};
inline const MeasuredCloth kCrepeDeChine{"silk crêpe de chine", {35}, 5, 10};
inline const MeasuredCloth kLinen{"linen", {25}, 12, 24};

/// What a detector sees that is led through the plane at azimuth φ [rad] over the cloth, for light
/// along its normal. The fibres' surfaces are the cloth's own, but all are black inside: nothing
/// but what surfaces reflect is seen.
inline PlaneScan mirror_scan(const Cloth& cloth, double azimuth, uint64_t paths) {
    const kernel::FibreTracer tracer(build_micro_element(cloth).fibres);
    std::vector<FibreOptics> black;
    for (const YarnKind& kind : yarn_kinds(cloth)) {
        const FibreSpec& fibre = kind.yarn->fibre;
        black.push_back({fibre.refractive_index, {1}, fibre.surface_absorption, fibre.roughness});
    }
    return scan_planes({&tracer, 1}, black, Bands::from_edges({400, 700}),
                       {{{Side::front, 0, azimuth}}}, {.accuracy = 1e-6, .max_paths = paths})[0];
}

struct Highlight {
    double angle; ///< of its middle at half its height above `ground` [°]
    double width; ///< standard deviation of the normal distribution as wide at half its height [°]
    double contrast; ///< its crest over its ground
};

/// The reflected intensity in the mean over five steps (7.5°) about each, and over both
/// directions along the yarns, which are alike but for chance.
inline constexpr int kSmoothed = 5;
inline std::vector<double> smoothed(const PlaneScan& scan) {
    std::vector<double> result(PlaneScan::kAngles);
    for (int i = 0; i < PlaneScan::kAngles; ++i) {
        const int first = std::max(i - kSmoothed / 2, 0);
        const int last = std::min(i + kSmoothed / 2, PlaneScan::kAngles - 1);
        for (int k = first; k <= last; ++k)
            for (const int bin : {k, PlaneScan::kAngles - 1 - k})
                result[i] += scan.mean_intensity[bin] / (2 * (last - first + 1));
    }
    return result;
}

/// The highlights in reflection at 0 and greater angles: where the intensity, smoothed, is 1.5
/// times its ground or more. The ground of the brightest is the scan's median; of any other it is
/// the deepest valley on the way to one at least as bright, the higher one of those to both sides.
inline std::vector<Highlight> highlights(const PlaneScan& scan) {
    constexpr double kLeastContrast = 1.5;
    constexpr int kCentre = PlaneScan::kAngles / 2;
    const std::vector<double> intensity = smoothed(scan);
    const auto inside = [](int k) { return k >= 0 && k < PlaneScan::kAngles; };
    std::vector<double> sorted = intensity;
    std::nth_element(sorted.begin(), sorted.begin() + kCentre, sorted.end());
    const auto ground_of = [&](int crest) {
        std::optional<double> ground;
        for (const int direction : {-1, 1}) {
            double valley = intensity[crest];
            int k = crest + direction;
            for (; inside(k) && intensity[k] < intensity[crest]; k += direction)
                valley = std::min(valley, intensity[k]);
            if (inside(k))
                ground = std::max(valley, ground.value_or(0));
        }
        return ground.value_or(sorted[kCentre]);
    };

    std::vector<Highlight> found;
    for (int i = kCentre; i < PlaneScan::kAngles; ++i) {
        const double ground = ground_of(i);
        if (intensity[i] < kLeastContrast * ground)
            continue;
        const double half = 0.5 * (intensity[i] + ground);
        /// Steps from the crest to where the intensity falls to half its height.
        const auto flank = [&](int direction) {
            int k = i;
            while (inside(k + direction) && intensity[k + direction] > half)
                k += direction;
            if (!inside(k + direction))
                return k + 0.0;
            return k +
                   direction * (intensity[k] - half) / (intensity[k] - intensity[k + direction]);
        };
        const double low = flank(-1), high = flank(1), step = degrees(PlaneScan::kStep);
        const double full_width = (high - low) * step; // of the lobe and the mean over the steps
        const double lobe = std::sqrt(std::max(0.0, square(full_width) - square(kSmoothed * step)));
        found.push_back({(0.5 * (low + high) - kCentre) * step,
                         lobe / (2 * std::sqrt(2 * std::log(2.0))), intensity[i] / ground});
    }
    return found;
}

} // namespace rapport::tests
