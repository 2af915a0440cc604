#include "renderer/core/image.h"

#include "renderer/core/math.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <stdexcept>

namespace rapport {
namespace {

constexpr const char* kColour[] = {"R", "G", "B"};
constexpr size_t kTileSize = 8;
constexpr double kSignificance = 0.01;

// A variance estimated from few samples is the weak point of a z-test: it is low just where the
// mean is off because the rare bright samples were missed. Taken at its word, a render of 16
// samples differs from its own reference of 256 in every image with an antialiased edge. So each
// pixel's variance is the larger of what its own image says and what the other says, scaled by
// how much noisier the one is than the other; and sums are referred to Student's t.

/// Degrees of freedom of one pixel's variance, taken as estimated from 16 samples: with fewer the
/// test raises false alarms, with more it is only more cautious than it had to be.
constexpr double kPixelDegrees = 15;

/// Stored pixels are float: differences of a few units in the last place are no difference.
double rounding_variance(float value) { return std::isfinite(value) ? square(0x1p-22 * value) : 0; }

double difference(float a, float b) {
    if (a == b) // covers equal infinities
        return 0;
    const double delta = static_cast<double>(a) - b;
    return std::isfinite(delta) ? delta : std::numeric_limits<double>::infinity();
}

/// A sum of pixel differences with its estimated variance. `significance` refers it to Student's
/// t, with the degrees of freedom of a sum of unequal variances (Welch 1947), because variances
/// from few samples are themselves uncertain and a normal law would call their chance lows
/// differences.
struct DifferenceSum {
    double delta = 0, variance = 0, variance_squares = 0;

    void add(double pixel_delta, double variance_a, double variance_b) {
        delta += pixel_delta;
        variance += variance_a + variance_b;
        variance_squares += square(variance_a) + square(variance_b);
    }
    double z() const {
        if (delta == 0)
            return 0;
        return variance > 0 ? delta / std::sqrt(variance)
                            : std::copysign(std::numeric_limits<double>::infinity(), delta);
    }
    /// The |z| at which a normal variable is as unlikely: Wallace 1959, "Bounds on normal
    /// approximations to Student's and the chi-square distributions", good to 0.02 beyond 2
    /// degrees of freedom.
    double significance() const {
        const double t = std::abs(z());
        if (!std::isfinite(t) || variance_squares <= 0)
            return t;
        const double degrees = kPixelDegrees * square(variance) / variance_squares;
        return (8 * degrees + 1) / (8 * degrees + 3) *
               std::sqrt(degrees * std::log1p(square(t) / degrees));
    }
};

/// The largest of many significances, and the chance of one as large under no difference.
struct Scale {
    double largest = 0;
    size_t tests = 0;

    void add(const DifferenceSum& sum) {
        largest = std::max(largest, sum.significance());
        ++tests;
    }
    double p_value() const {
        const double one = std::erfc(largest / std::numbers::sqrt2);
        return sidak(one, static_cast<double>(tests));
    }
    /// 1 − (1 − p)^tests, for p however small (Šidák 1967).
    static double sidak(double p, double tests) {
        return p < 1 ? -std::expm1(tests * std::log1p(-p)) : 1;
    }
};

struct Channel {
    const std::vector<float>&a, &b;
    const std::vector<float>*variance_a, *variance_b; ///< both or neither
};

double checked_variance(float variance) {
    if (!std::isfinite(variance) || variance < 0)
        throw std::invalid_argument("a pixel's variance is negative or not finite");
    return variance;
}

/// Sums |Δ|, Δ² and relative Δ² of the channel; finds the worst pixel.
void add_magnitudes(const Channel& channel, int width, ImageDifference& result) {
    for (size_t i = 0; i < channel.a.size(); ++i) {
        const double delta = std::abs(difference(channel.a[i], channel.b[i]));
        if (delta > result.max_absolute) {
            result.max_absolute = delta;
            result.worst_x = static_cast<int>(i % width);
            result.worst_y = static_cast<int>(i / width);
        }
        result.mean_absolute += delta;
        result.rms += square(delta);
        if (delta > 0)
            result.relative_mse += std::isfinite(delta)
                                       ? square(delta) / (square(double{channel.b[i]}) + 0.01)
                                       : delta;
    }
}

size_t tile_of(size_t pixel, size_t width) {
    const size_t tiles_across = (width + kTileSize - 1) / kTileSize;
    return pixel / width / kTileSize * tiles_across + pixel % width / kTileSize;
}

size_t tile_count(size_t width, size_t height) {
    return width && height ? tile_of(width * height - 1, width) + 1 : 0;
}

/// How much larger the variances of `a` are than those of `b`: the median over all tiles, so that
/// no single bright sample decides it; nothing where one of the images never has variance.
std::optional<double> variance_ratio(const std::vector<Channel>& channels, size_t width,
                                     size_t height) {
    std::vector<double> ratios;
    for (const Channel& channel : channels) {
        std::vector<glm::dvec2> sums(tile_count(width, height), glm::dvec2(0));
        for (size_t i = 0; i < channel.a.size(); ++i)
            sums[tile_of(i, width)] += glm::dvec2(checked_variance((*channel.variance_a)[i]),
                                                  checked_variance((*channel.variance_b)[i]));
        for (const glm::dvec2& sum : sums)
            if (sum.x > 0 && sum.y > 0)
                ratios.push_back(sum.x / sum.y);
    }
    if (ratios.empty())
        return {};
    const auto median = ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 2);
    std::ranges::nth_element(ratios, median);
    return *median;
}

struct NoiseTest {
    std::optional<double> ratio; ///< of variances, a to b
    Scale pixels, tiles, whole;
    size_t beyond_3_sigma = 0;
    double mean_z = 0;

    void add(const Channel& channel, size_t width, size_t height) {
        std::vector<DifferenceSum> tile_sums(tile_count(width, height));
        DifferenceSum total;
        for (size_t i = 0; i < channel.a.size(); ++i) {
            const double delta = difference(channel.a[i], channel.b[i]);
            double variance_a = (*channel.variance_a)[i], variance_b = (*channel.variance_b)[i];
            if (ratio) {
                const double from_b = *ratio * variance_b, from_a = variance_a / *ratio;
                variance_a = std::max(variance_a, from_b);
                variance_b = std::max(variance_b, from_a);
            }
            variance_a += rounding_variance(channel.a[i]);
            variance_b += rounding_variance(channel.b[i]);
            DifferenceSum pixel;
            for (DifferenceSum* sum : {&pixel, &tile_sums[tile_of(i, width)], &total})
                sum->add(delta, variance_a, variance_b);
            pixels.add(pixel);
            beyond_3_sigma += std::abs(pixel.z()) > 3;
        }
        for (const DifferenceSum& tile : tile_sums)
            tiles.add(tile);
        whole.add(total);
        if (std::abs(total.z()) > std::abs(mean_z))
            mean_z = total.z();
    }

    double p_value() const {
        return Scale::sidak(std::min({pixels.p_value(), tiles.p_value(), whole.p_value()}), 3);
    }
};

const std::vector<float>& required(const Image& image, const std::string& name) {
    const std::vector<float>* plane = image.find(name);
    if (!plane)
        throw std::invalid_argument("an image without channel " + name);
    return *plane;
}

} // namespace

ImageDifference compare(const Image& a, const Image& b) {
    if (a.width != b.width || a.height != b.height)
        throw std::invalid_argument("images of " + std::to_string(a.width) + " x " +
                                    std::to_string(a.height) + " and " + std::to_string(b.width) +
                                    " x " + std::to_string(b.height) + " pixels");
    ImageDifference result;
    result.tested = true;
    std::vector<Channel> channels;
    for (const std::string name : kColour) {
        channels.push_back({required(a, name), required(b, name), a.find("variance." + name),
                            b.find("variance." + name)});
        result.tested &= channels.back().variance_a && channels.back().variance_b;
    }

    for (const Channel& channel : channels)
        add_magnitudes(channel, a.width, result);
    const double samples = static_cast<double>(channels.size() * channels[0].a.size());
    if (samples > 0) {
        result.mean_absolute /= samples;
        result.rms = std::sqrt(result.rms / samples);
        result.relative_mse /= samples;
    }
    if (!result.tested) {
        result.agree = result.max_absolute == 0;
        return result;
    }
    NoiseTest test;
    test.ratio = variance_ratio(channels, a.width, a.height);
    for (const Channel& channel : channels)
        test.add(channel, a.width, a.height);
    result.share_beyond_3_sigma =
        samples > 0 ? static_cast<double>(test.beyond_3_sigma) / samples : 0;
    result.mean_z = test.mean_z;
    result.p_value = test.p_value();
    result.agree = result.p_value >= kSignificance;
    return result;
}

} // namespace rapport
