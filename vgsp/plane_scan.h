#pragma once

#include "vgsp/goniophotometer.h"

#include <optional>

namespace rapport {

/// What a detector sees that is moved through the plane of incidence, once round the cloth.
///
/// A direction of exit is told by two angles: `angle`, of its projection on the plane from the
/// normal of the side it leaves to, positive on the light's side; and how far it stands out of the
/// plane, at most kHalfWidth. So a mirror would send light that comes from θ to −θ, and light that
/// goes straight through leaves at −θ of the other side. The detector's window, kStep ×
/// 2·kHalfWidth, has the same solid angle everywhere: kStep·2·sin kHalfWidth. Its steps are centred
/// on multiples of 1.5°, so that whole degrees, where parallel light and straight fibres put their
/// peaks, are never on the edge of two; what leaves within 0.75° of the cloth's plane is not seen.
struct PlaneScan {
    static constexpr int kAngles = 119; ///< to a side
    static constexpr double kStep = kPi / 120;
    static constexpr double kHalfWidth = kPi / 72;

    static double angle(int bin) { return (bin - kAngles / 2) * kStep; }
    static double solid_angle(); ///< of a bin [sr]

    IncidentDirection incident; ///< its azimuth is the plane's
    Bands bands;
    /// Intensity [1/sr] per unit of incident flux, and its standard error: [2, kAngles, bands], 0 =
    /// reflected to the incident side, 1 = transmitted; in the mean over the bands [2, kAngles].
    std::vector<double> intensity, error, mean_intensity, mean_error;
    /// ε: the RMS of mean_error over the mean of mean_intensity. 0 if nothing was seen.
    double accuracy = 0;
    /// MeasurementError::realisation, on the same angles; none for a single realisation.
    std::optional<double> realisation_error;
    uint64_t paths = 0;
};

/// Scans the planes of the given directions of incidence; realisations share each one's paths
/// equally. Path k of direction d depends on (seed, d, k) alone, and, as in measure(), a pilot that
/// is thrown away decides how many paths bring ε to `settings.accuracy`. `max_seconds` is shared
/// out evenly over the directions.
///
/// Throws std::invalid_argument for optics or settings outside their domain.
std::vector<PlaneScan>
scan_planes(std::span<const kernel::FibreTracer> realisations, std::span<const FibreOptics> optics,
            const Bands& bands, std::span<const IncidentDirection> incident,
            const GoniophotometerSettings& settings,
            const std::function<void(const GoniophotometerProgress&)>& progress = {});

} // namespace rapport
