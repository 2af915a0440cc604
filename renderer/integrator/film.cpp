#include "renderer/integrator/film.h"

#include "renderer/core/parallel.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <stdexcept>

namespace rapport {
namespace {

constexpr int kTile = 16; ///< pixels along its side

const std::vector<std::string> kMeans{"R",   "G",   "B",   "albedo.R", "albedo.G", "albedo.B",
                                      "N.X", "N.Y", "N.Z", "warp.X",   "warp.Y",   "warp.Z"};
const std::vector<std::string> kVariances{"variance.R", "variance.G", "variance.B"};

} // namespace

Film::Film(const glm::ivec2& resolution)
    : resolution_(resolution), pixels_(static_cast<size_t>(resolution.x) * resolution.y) {
    for (int y = 0; y < resolution.y; y += kTile)
        for (int x = 0; x < resolution.x; x += kTile)
            tiles_.push_back({{x, y}, glm::min(glm::ivec2(x, y) + kTile, resolution)});
}

double Film::mean_samples() const {
    double sum = 0;
    for (const Tile& tile : tiles_) {
        const glm::ivec2 size = tile.end - tile.first;
        sum += static_cast<double>(tile.samples) * size.x * size.y;
    }
    return sum / static_cast<double>(pixels_.size());
}

void Film::add(int x, int y, int number, const FilmSample& sample) {
    Pixel& pixel = pixels_[index(x, y)];
    const glm::dvec3 radiance(sample.radiance);
    pixel.radiance += radiance;
    pixel.squares += radiance * radiance;
    if (number % 2 != 0)
        pixel.odd += radiance;
    if (!sample.hit)
        return;
    pixel.albedo += sample.albedo;
    pixel.normal += sample.normal;
    pixel.warp += sample.warp;
    pixel.depth += sample.depth;
    pixel.cut += sample.cut;
    ++pixel.hits;
}

void Film::clear(Tile& tile) {
    for (int y = tile.first.y; y < tile.end.y; ++y)
        std::fill_n(pixels_.begin() + static_cast<ptrdiff_t>(index(tile.first.x, y)),
                    tile.end.x - tile.first.x, Pixel{});
    tile.samples = 0;
}

void Film::restore(std::span<const double> sums) {
    static_assert(sizeof(Pixel) == kSums * sizeof(double));
    if (sums.size() != kSums * pixels_.size())
        throw std::invalid_argument("sums of a film of another size");
    std::memcpy(static_cast<void*>(pixels_.data()), sums.data(), sums.size_bytes());
}

glm::dvec3 Film::Pixel::variance_of_mean(int samples) const {
    if (samples < 2)
        return glm::dvec3(std::numeric_limits<double>::infinity());
    const double n = samples;
    return glm::max(squares - radiance * radiance / n, 0.0) / (n * (n - 1));
}

glm::dvec3 Film::Pixel::variance_between_halves(int samples) const {
    if (samples < 2)
        return glm::dvec3(std::numeric_limits<double>::infinity());
    const int odd_ones = samples / 2, even_ones = samples - odd_ones;
    const glm::dvec3 apart = odd / double(odd_ones) - (radiance - odd) / double(even_ones);
    return apart * apart * (double(odd_ones) * even_ones / square(double(samples)));
}

double Film::cut_share() const {
    double cut = 0, scattered = 0;
    for (const Pixel& pixel : pixels_) {
        cut += pixel.cut;
        scattered += (pixel.albedo.r + pixel.albedo.g + pixel.albedo.b) / 3;
    }
    return scattered > 0 ? cut / scattered : 0;
}

double Film::Noise::relative() const { return variance > 0 ? std::sqrt(variance) / mean : 0; }

Film::Noise Film::noise(const Tile& tile) const {
    Noise noise;
    if (tile.samples == 0)
        return {0, std::numeric_limits<double>::infinity()};
    for (int y = tile.first.y; y < tile.end.y; ++y)
        for (int x = tile.first.x; x < tile.end.x; ++x) {
            const Pixel& pixel = pixels_[index(x, y)];
            const glm::dvec3 variance = pixel.variance_between_halves(tile.samples);
            noise.mean += (pixel.radiance.r + pixel.radiance.g + pixel.radiance.b) / tile.samples;
            noise.variance += variance.r + variance.g + variance.b;
        }
    const glm::ivec2 size = tile.end - tile.first;
    const double values = 3.0 * size.x * size.y;
    return {noise.mean / values, noise.variance / values};
}

Film::Noise Film::noise() const {
    Noise all;
    for (const Tile& tile : tiles_) {
        const Noise part = noise(tile);
        const glm::ivec2 size = tile.end - tile.first;
        const double share =
            static_cast<double>(size.x) * size.y / static_cast<double>(pixels_.size());
        all.mean += part.mean * share;
        all.variance += part.variance * share;
    }
    return all;
}

Image Film::image() const {
    const bool with_variance =
        std::ranges::all_of(tiles_, [](const Tile& tile) { return tile.samples >= 2; });
    std::vector<std::string> names = kMeans;
    names.push_back("Z");
    if (with_variance)
        names.insert(names.end(), kVariances.begin(), kVariances.end());
    Image image(resolution_.x, resolution_.y, names);
    parallel_for(tiles_.size(), [&](size_t number) {
        const Tile& tile = tiles_[number];
        for (int y = tile.first.y; y < tile.end.y; ++y)
            for (int x = tile.first.x; x < tile.end.x; ++x) {
                const Pixel& pixel = pixels_[index(x, y)];
                const int samples = std::max(tile.samples, 1);
                size_t plane = 0;
                const auto store = [&](double value) {
                    image.data[plane++][index(x, y)] = static_cast<float>(value);
                };
                for (const glm::dvec3& sum :
                     {pixel.radiance, pixel.albedo, pixel.normal, pixel.warp})
                    for (int c = 0; c < 3; ++c)
                        store(sum[c] / samples);
                store(pixel.hits > 0 ? pixel.depth / pixel.hits : 0);
                const glm::dvec3 variance = pixel.variance_of_mean(samples);
                for (int c = 0; with_variance && c < 3; ++c)
                    store(variance[c]);
            }
    });
    return image;
}

} // namespace rapport
