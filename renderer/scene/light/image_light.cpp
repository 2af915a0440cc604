#include "renderer/scene/light/image_light.h"

#include "renderer/core/error.h"
#include "renderer/core/octahedral.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>

namespace rapport {
namespace {

/// The rotation or reflection in `matrix`, without its uniform scale.
glm::mat3 rotation_of(const glm::mat4& matrix, const Params& params) {
    const glm::mat3 linear(matrix);
    const float scale = std::cbrt(std::abs(glm::determinant(linear)));
    const glm::mat3 rotation = linear / scale;
    const glm::mat3 defect = glm::transpose(rotation) * rotation - glm::mat3(1);
    for (int i = 0; i < 3; ++i)
        if (!(glm::length(defect[i]) < 1e-4f))
            params.fail("", "an image light that is only rotated, reflected or scaled uniformly",
                        "a transformation that distorts angles");
    return rotation;
}

} // namespace

ImageLight::ImageLight(const LightContext& context)
    : to_world_(rotation_of(context.to_world, context.params)),
      from_world_(glm::transpose(to_world_)) {
    const std::string filename = context.params.get_string("filename", "");
    read_pixels(context, context.base_dir / filename);
    prepare_sampling();
}

void ImageLight::read_pixels(const LightContext& context, const std::filesystem::path& file) {
    const Image image = read_exr(file);
    width_ = image.width;
    height_ = image.height;
    octahedral_ = width_ == height_;
    if (!octahedral_ && width_ != 2 * height_)
        throw FileError(file.string(), "", "a square or a 2:1 image as light",
                        fmt::format("{} × {} pixels", width_, height_));
    const float scale = light_scale(context.params);
    pixels_.resize(static_cast<size_t>(width_) * height_);
    static constexpr const char* kChannels[] = {"R", "G", "B"};
    for (int c = 0; c < 3; ++c) {
        const std::vector<float>* plane = image.find(kChannels[c]);
        if (!plane)
            throw FileError(file.string(), "", "channels R, G and B",
                            fmt::format("no channel {}", kChannels[c]));
        for (size_t i = 0; i < pixels_.size(); ++i) {
            const float value = (*plane)[i] * scale;
            if (!std::isfinite(value))
                throw FileError(file.string(),
                                fmt::format("pixel ({}, {})", i % width_, i / width_),
                                "radiance that is finite", fmt::format("{}", value));
            pixels_[i][c] = value;
        }
    }
    size_t negative = 0;
    for (Rgb& pixel : pixels_) {
        negative += glm::any(glm::lessThan(pixel, Rgb(0)));
        pixel = glm::max(pixel, Rgb(0));
    }
    if (negative > 0 && context.warnings)
        context.warnings->push_back(fmt::format("{}: negative radiance set to 0 in {} of {} pixels",
                                                file.string(), negative, pixels_.size()));
}

/// The mean luminance of the bilinear lookup over a pixel's cell: [1 6 1]/8 × [1 6 1]/8 over the
/// neighbours. It is positive wherever the lookup is.
double ImageLight::mean_luminance(int x, int y) const {
    static constexpr double kMean[] = {1 / 8., 6 / 8., 1 / 8.};
    double mean = 0;
    for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx)
            mean += kMean[dx + 1] * kMean[dy + 1] * luminance(pixel(x + dx, y + dy));
    return mean;
}

/// A cell's weight is its solid angle × what its luminance is above the sky's mean. Directions
/// drawn from the BSDF, which the samples are weighted against, are already in proportion to what
/// an even sky contributes; samples are for what stands out of it (MIS compensation: Karlík et al.
/// 2019, "MIS compensation: optimizing sampling techniques in multiple importance sampling").
void ImageLight::prepare_sampling() {
    std::vector<double> luminances(pixels_.size()), solid_angles(pixels_.size());
    double flux = 0, sphere = 0;
    for (int y = 0; y < height_; ++y)
        for (int x = 0; x < width_; ++x) {
            const size_t i = static_cast<size_t>(y) * width_ + x;
            luminances[i] = mean_luminance(x, y);
            solid_angles[i] = solid_angle(from_image({(x + 0.5) / width_, (y + 0.5) / height_}));
            flux += luminances[i] * solid_angles[i];
            sphere += solid_angles[i];
        }
    std::vector<float> weights(pixels_.size());
    for (size_t i = 0; i < weights.size(); ++i)
        weights[i] =
            static_cast<float>(std::max(luminances[i] - flux / sphere, 0.0) * solid_angles[i]);
    distribution_.emplace(weights, width_, height_);
}

void ImageLight::prepare(const glm::vec3&, float scene_radius) { scene_radius_ = scene_radius; }

std::optional<LightSample> ImageLight::sample(const glm::vec3&, const glm::vec2& u) const {
    const auto sample = distribution_->sample(u);
    const glm::vec3 direction = from_image(sample.position);
    const float jacobian = solid_angle(direction);
    if (!(jacobian > 0))
        return std::nullopt;
    return LightSample{to_world_ * direction, std::numeric_limits<float>::infinity(),
                       lookup(sample.position), static_cast<float>(sample.pdf / jacobian), false};
}

EscapedLight ImageLight::escaped(const glm::vec3& direction) const {
    const glm::vec3 own = from_world_ * direction;
    const glm::dvec2 position = to_image(own);
    const float jacobian = solid_angle(own);
    return {lookup(position),
            jacobian > 0 ? static_cast<float>(distribution_->pdf(position) / jacobian) : 0};
}

float ImageLight::power() const {
    const double flux = distribution_->total() / static_cast<double>(pixels_.size());
    return static_cast<float>(kPi * flux) * square(scene_radius_);
}

glm::dvec2 ImageLight::to_image(const glm::vec3& direction) const {
    constexpr double kBelowOne = 1 - 0x1p-53;
    const glm::dvec3 w = glm::normalize(glm::dvec3(direction));
    const glm::dvec2 position = octahedral_
                                    ? sphere_to_octahedral(w)
                                    : glm::dvec2(0.5 - std::atan2(w.y, w.x) / (2 * kPi),
                                                 std::acos(std::clamp(w.z, -1.0, 1.0)) / kPi);
    return glm::clamp(position, 0.0, kBelowOne);
}

glm::vec3 ImageLight::from_image(const glm::dvec2& position) const {
    if (octahedral_)
        return glm::vec3(octahedral_to_sphere(position));
    const double theta = kPi * position.y; // in float it would be beyond π, at the lower pole
    const auto phi = static_cast<float>(2 * kPi * (0.5 - position.x));
    const auto sine = static_cast<float>(std::sin(theta));
    return {sine * std::cos(phi), sine * std::sin(phi), static_cast<float>(std::cos(theta))};
}

float ImageLight::solid_angle(const glm::vec3& direction) const {
    return static_cast<float>(octahedral_ ? 4 * kPi
                                          : 2 * kPi * kPi * glm::length(glm::vec2(direction)));
}

Rgb ImageLight::pixel(int x, int y) const {
    if (octahedral_) { // each edge of the square is folded onto itself at its middle
        if (x < 0 || x >= width_) {
            x = std::clamp(x, 0, width_ - 1);
            y = height_ - 1 - y;
        }
        if (y < 0 || y >= height_) {
            y = std::clamp(y, 0, height_ - 1);
            x = width_ - 1 - x;
        }
    } else {
        x += x < 0 ? width_ : x >= width_ ? -width_ : 0;
        y = std::clamp(y, 0, height_ - 1);
    }
    return pixels_[static_cast<size_t>(y) * width_ + x];
}

Rgb ImageLight::lookup(const glm::dvec2& position) const {
    const glm::dvec2 place = position * glm::dvec2(width_, height_) - 0.5;
    const glm::dvec2 floor = glm::floor(place);
    const glm::vec2 f(place - floor);
    const int x = static_cast<int>(floor.x), y = static_cast<int>(floor.y);
    if (x >= 0 && x + 1 < width_ && y >= 0 && y + 1 < height_) { // hardly ever else
        const Rgb* const upper = &pixels_[static_cast<size_t>(y) * width_ + x];
        const Rgb* const lower = upper + width_;
        return glm::mix(glm::mix(upper[0], upper[1], f.x), glm::mix(lower[0], lower[1], f.x), f.y);
    }
    return glm::mix(glm::mix(pixel(x, y), pixel(x + 1, y), f.x),
                    glm::mix(pixel(x, y + 1), pixel(x + 1, y + 1), f.x), f.y);
}

} // namespace rapport
