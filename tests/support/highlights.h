#pragma once

#include "vgsp/micro_element.h"
#include "vgsp/plane_scan.h"

#include <algorithm>
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
/// along its normal. All fibres are black inside: nothing but mirror images is seen.
inline PlaneScan mirror_scan(const Cloth& cloth, double azimuth, uint64_t paths) {
    const kernel::FibreTracer tracer(build_micro_element(cloth).fibres);
    const std::vector<FibreOptics> black(yarn_kinds(cloth).size(), {1.55, {1}, 0});
    return scan_planes({&tracer, 1}, black, Bands::from_edges({400, 700}),
                       {{{Side::front, 0, azimuth}}}, {.accuracy = 1e-6, .max_paths = paths})[0];
}

struct Highlight {
    double angle; ///< of its middle at half its height [°]
    double width; ///< standard deviation of the normal distribution as wide at half its height [°]
    double contrast; ///< its height over the median of the scan
};

/// The reflected intensity in the mean over three steps (4.5°) about each, and over both
/// directions along the yarns, which are alike but for chance.
inline std::vector<double> smoothed(const PlaneScan& scan) {
    std::vector<double> result(PlaneScan::kAngles);
    for (int i = 0; i < PlaneScan::kAngles; ++i) {
        const int first = std::max(i - 1, 0), last = std::min(i + 1, PlaneScan::kAngles - 1);
        for (int k = first; k <= last; ++k)
            for (const int bin : {k, PlaneScan::kAngles - 1 - k})
                result[i] += scan.mean_intensity[bin] / (2 * (last - first + 1));
    }
    return result;
}

/// The highlights in reflection at 0 and greater angles: where the intensity, smoothed, is twice
/// its median or more, and nowhere greater within 15°.
inline std::vector<Highlight> highlights(const PlaneScan& scan) {
    constexpr double kLeastContrast = 2;
    const int reach = static_cast<int>(std::round(radians(15.0) / PlaneScan::kStep));
    const std::vector<double> intensity = smoothed(scan);
    std::vector<double> sorted = intensity;
    std::nth_element(sorted.begin(), sorted.begin() + PlaneScan::kAngles / 2, sorted.end());
    const double median = sorted[PlaneScan::kAngles / 2];

    std::vector<Highlight> found;
    for (int i = PlaneScan::kAngles / 2; i < PlaneScan::kAngles; ++i) {
        const auto from = intensity.begin() + std::max(i - reach, 0);
        const auto to = intensity.begin() + std::min(i + reach + 1, PlaneScan::kAngles);
        if (intensity[i] < kLeastContrast * median ||
            std::max_element(from, to) - intensity.begin() != i)
            continue;
        const double half = 0.5 * (intensity[i] + median);
        /// Steps from the crest to where the intensity falls to half its height.
        const auto flank = [&](int direction) {
            int k = i;
            while (k + direction >= 0 && k + direction < PlaneScan::kAngles &&
                   intensity[k + direction] > half)
                k += direction;
            if (k + direction < 0 || k + direction >= PlaneScan::kAngles)
                return k + 0.0;
            return k +
                   direction * (intensity[k] - half) / (intensity[k] - intensity[k + direction]);
        };
        const double low = flank(-1), high = flank(1), step = degrees(PlaneScan::kStep);
        const double full_width = (high - low) * step; // of the lobe and the mean over three steps
        const double lobe = std::sqrt(std::max(0.0, square(full_width) - square(3 * step)));
        found.push_back({(0.5 * (low + high) - PlaneScan::kAngles / 2) * step,
                         lobe / (2 * std::sqrt(2 * std::log(2.0))), intensity[i] / median});
    }
    return found;
}

} // namespace rapport::tests
