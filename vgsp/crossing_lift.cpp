#include "vgsp/crossing_lift.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <utility>

namespace rapport {
namespace {

constexpr double kFlatness = 1e-3;  ///< stiffness that keeps cloth from long waves
constexpr double kTolerance = 1e-6; ///< of the forces left over, to the greatest separation

double dot(const std::vector<double>& a, const std::vector<double>& b) {
    return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

/// The threads' resistance to bending.
class Bending {
  public:
    Bending(int ends, int picks, double balance)
        : ends_(ends), picks_(picks), of_ends_(1 - balance), of_picks_(balance) {}

    /// The forces at the crossings of ends at the heights `warp` and picks at `weft`: minus the
    /// fourth differences along both, by stiffness.
    void forces(const std::vector<double>& warp, const std::vector<double>& weft,
                std::vector<double>& result) {
        bends(warp, 1, picks_, ends_, warp_bends_);
        bends(weft, picks_, ends_, picks_, weft_bends_);
        bends(warp_bends_, 1, picks_, ends_, result);
        bends(weft_bends_, picks_, ends_, picks_, of_weft_);
        for (size_t k = 0; k < result.size(); ++k)
            result[k] = -of_ends_ * result[k] - of_picks_ * of_weft_[k];
    }

  private:
    /// Second differences along `threads` threads, whose crossings lie `stride` apart.
    void bends(const std::vector<double>& heights, size_t stride, size_t crossings, size_t threads,
               std::vector<double>& result) const {
        result.resize(heights.size());
        const size_t thread_stride = stride == 1 ? crossings : 1;
        for (size_t thread = 0; thread < threads; ++thread) {
            const double* const in = heights.data() + thread * thread_stride;
            double* const out = result.data() + thread * thread_stride;
            for (size_t k = 0; k < crossings; ++k) {
                const size_t before = k == 0 ? crossings - 1 : k - 1;
                const size_t after = k + 1 == crossings ? 0 : k + 1;
                out[k * stride] = in[before * stride] + in[after * stride] - 2 * in[k * stride];
            }
        }
    }

    size_t ends_, picks_;
    double of_ends_, of_picks_;
    std::vector<double> warp_bends_, weft_bends_, of_weft_;
};

} // namespace

std::vector<double> crossing_lift(std::span<const double> separation, int ends, int picks,
                                  double balance, std::vector<double> start) {
    const size_t count = separation.size();
    std::vector<double> lift = std::move(start);
    lift.resize(count);
    std::vector<double> warp(count), weft(count);
    double greatest = 0;
    for (size_t k = 0; k < count; ++k) {
        warp[k] = balance * separation[k] + lift[k];
        weft[k] = (balance - 1) * separation[k] + lift[k];
        greatest = std::max(greatest, std::abs(separation[k]));
    }

    // Conjugate gradients.
    Bending bending(ends, picks, balance);
    std::vector<double> residual(count), forced(count);
    bending.forces(warp, weft, residual);
    for (size_t k = 0; k < count; ++k)
        residual[k] -= kFlatness * lift[k];
    std::vector<double> direction = residual;
    double square = dot(residual, residual);
    const double enough = count * std::pow(kTolerance * greatest, 2);
    for (size_t step = 0; square > enough && step < 10 * count; ++step) {
        bending.forces(direction, direction, forced);
        for (size_t k = 0; k < count; ++k)
            forced[k] -= kFlatness * direction[k];
        const double length = -square / dot(direction, forced);
        for (size_t k = 0; k < count; ++k) {
            lift[k] += length * direction[k];
            residual[k] += length * forced[k];
        }
        const double before = square;
        square = dot(residual, residual);
        for (size_t k = 0; k < count; ++k)
            direction[k] = residual[k] + square / before * direction[k];
    }
    return lift;
}

} // namespace rapport
