#pragma once

#include "renderer/core/image.h"
#include "renderer/core/math.h"

#include <span>
#include <vector>

namespace rapport {

/// What one camera path saw.
struct FilmSample {
    glm::vec3 radiance{0};
    bool hit = false; ///< it met a surface, of which the rest tells
    glm::vec3 albedo{0}, normal{0}, warp{0};
    float depth = 0; ///< along the viewing direction
    float cut = 0;   ///< PathResult::cut
};

/// Sums over the samples of each pixel, in double precision and in the order of the samples. All
/// pixels of a tile have equally many.
class Film {
  public:
    explicit Film(const glm::ivec2& resolution);

    const glm::ivec2& resolution() const { return resolution_; }
    struct Tile {
        glm::ivec2 first, end; ///< pixels [first, end) in x and y
        int samples = 0;       ///< that every pixel of it has
    };
    std::vector<Tile>& tiles() { return tiles_; }
    const std::vector<Tile>& tiles() const { return tiles_; }
    double mean_samples() const; ///< per pixel

    /// Adds sample `number` of a pixel, the next; `Tile::samples` is the caller's to count up.
    void add(int x, int y, int number, const FilmSample& sample);
    /// Takes a tile's samples back, so that a film can serve another picture.
    void clear(Tile& tile);

    /// All sums, kSums of each pixel in rows from the top, as they are kept in a checkpoint beside
    /// `Tile::samples`.
    static constexpr size_t kSums = 21;
    std::span<const std::byte> sums() const { return std::as_bytes(std::span(pixels_)); }
    /// Takes up sums that were kept. Throws std::invalid_argument for another number of them.
    void restore(std::span<const double> sums);

    /// Radiance of a tile, and the variance of its pixels' means, both in the mean over pixels and
    /// channels. The variance is that between the means of the samples of even and of odd number,
    /// which are independent whatever the sampler (core/sampler.h), so that it tells what Sobol
    /// points gain; good to 5 % where the 768 values of a tile are alike. No variance from fewer
    /// than two samples: infinite.
    struct Noise {
        double mean = 0, variance = 0;
        double relative() const; ///< √variance / mean; 0 where both are 0
    };
    Noise noise(const Tile& tile) const;
    Noise noise() const; ///< of the whole picture
    /// Share of what the paths scatter at their first surface that they would still have scattered
    /// on where `max_depth` ended them: ρⁿ within a closed body of albedo ρ, after n events.
    double cut_share() const;

    /// Channels: R, G, B radiance; at the first surface that a ray meets, albedo.{R,G,B} and the
    /// unit shading normal N.{X,Y,Z} and warp direction warp.{X,Y,Z} of the face side, in world
    /// space, as means over the pixel (0 for samples that meet nothing); Z, the mean distance along
    /// the viewing direction of the samples that meet something (0 if none do); and, if every pixel
    /// has two samples, variance.{R,G,B}: that of the pixel's mean, estimated as if samples were
    /// independent, hence from above for Sobol points.
    Image image() const;

  private:
    struct Pixel {
        glm::dvec3 radiance{0}, squares{0}, albedo{0}, normal{0}, warp{0};
        glm::dvec3 odd{0}; ///< radiance of the samples of odd number
        double depth = 0, hits = 0, cut = 0;

        glm::dvec3 variance_of_mean(int samples) const;
        glm::dvec3 variance_between_halves(int samples) const;
    };
    size_t index(int x, int y) const { return static_cast<size_t>(y) * resolution_.x + x; }

    glm::ivec2 resolution_;
    std::vector<Tile> tiles_;
    std::vector<Pixel> pixels_;
};

} // namespace rapport
