#pragma once

#include "renderer/core/math.h"

namespace rapport {

/// What a smooth dielectric boundary does to unpolarised light.
struct FresnelResult {
    double reflectance;     ///< share of the flux that is reflected, [0, 1]; 1 = total reflection
    double cos_transmitted; ///< cosine of the refraction angle, 0 under total reflection
};

/// Fresnel's equations, averaged over both polarisations at this event, as the paper does.
/// `cos_incident` in [0, 1] is measured on the side the light comes from; `eta` is the refractive
/// index of that side over that of the other.
inline FresnelResult fresnel_dielectric(double cos_incident, double eta) {
    const double sin2_transmitted = eta * eta * (1 - cos_incident * cos_incident);
    if (sin2_transmitted >= 1)
        return {1, 0};
    const double cos_transmitted = std::sqrt(1 - sin2_transmitted);
    const double s =
        (eta * cos_incident - cos_transmitted) / (eta * cos_incident + cos_transmitted);
    const double p =
        (cos_incident - eta * cos_transmitted) / (cos_incident + eta * cos_transmitted);
    return {0.5 * (s * s + p * p), cos_transmitted};
}

} // namespace rapport
