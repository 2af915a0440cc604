#include "renderer/integrator/path_tracer.h"

#include "renderer/core/parallel.h"
#include "renderer/integrator/path.h"

#include <algorithm>
#include <fmt/format.h>
#include <mutex>
#include <stdexcept>

namespace rapport {
namespace {

constexpr int kTile = 16; ///< pixels along its side

const std::vector<std::string> kMeans{"R",   "G",   "B",   "albedo.R", "albedo.G", "albedo.B",
                                      "N.X", "N.Y", "N.Z", "warp.X",   "warp.Y",   "warp.Z"};
const std::vector<std::string> kVariances{"variance.R", "variance.G", "variance.B"};

/// Sums over one pixel's samples, in double and in the order of the samples.
struct PixelSums {
    glm::dvec3 radiance{0}, squares{0}, albedo{0}, normal{0}, warp{0};
    double depth = 0;
    int hits = 0;

    void add(const PathResult& path, const CameraRays& rays, const glm::vec3& direction) {
        const glm::dvec3 value(path.radiance);
        radiance += value;
        squares += value * value;
        if (!path.first)
            return;
        const SurfacePoint& point = *path.first;
        albedo += point.surface->material->albedo(point.frame.to_local(-direction));
        normal += point.frame.z;
        warp += point.frame.y;
        depth += rays.depth(point.position);
        ++hits;
    }

    void store(Image& image, size_t pixel, int samples) const {
        size_t plane = 0;
        for (const glm::dvec3& sum : {radiance, albedo, normal, warp})
            for (int c = 0; c < 3; ++c)
                image.data[plane++][pixel] = static_cast<float>(sum[c] / samples);
        image.data[plane++][pixel] = static_cast<float>(hits > 0 ? depth / hits : 0);
        if (samples < 2)
            return;
        for (int c = 0; c < 3; ++c) {
            const double spread = squares[c] - radiance[c] * radiance[c] / samples;
            image.data[plane++][pixel] = static_cast<float>(
                std::max(0.0, spread) / (static_cast<double>(samples) * (samples - 1)));
        }
    }
};

std::vector<std::string> channels(int samples) {
    std::vector<std::string> names = kMeans;
    names.push_back("Z");
    if (samples > 1)
        names.insert(names.end(), kVariances.begin(), kVariances.end());
    return names;
}

bool finite(const Rgb& c) { return std::isfinite(c.r) && std::isfinite(c.g) && std::isfinite(c.b); }

PixelSums render_pixel(const Scene& scene, const CameraRays& rays, int x, int y) {
    const RenderSettings& settings = scene.settings;
    const uint64_t index = static_cast<uint64_t>(y) * scene.camera.resolution.x + x;
    PixelSums sums;
    for (int sample = 0; sample < settings.samples; ++sample) {
        Sampler sampler(settings.sampler, settings.seed, index, static_cast<uint32_t>(sample));
        // Uniform over the box filter, so that every sample has weight 1.
        const glm::vec2 offset = (2.0f * sampler.next_2d() - 1.0f) * settings.filter_radius;
        const kernel::Ray ray = rays(glm::vec2(x, y) + 0.5f + offset);
        const PathResult path = trace_path(scene, ray, sampler);
        if (!finite(path.radiance))
            throw std::runtime_error(
                fmt::format("pixel ({}, {}), sample {}: radiance [{} {} {}] is not finite", x, y,
                            sample, path.radiance.r, path.radiance.g, path.radiance.b));
        sums.add(path, rays, ray.dir);
    }
    return sums;
}

} // namespace

Image render(const Scene& scene, const std::function<void(double)>& progress) {
    const glm::ivec2 size = scene.camera.resolution;
    Image image(size.x, size.y, channels(scene.settings.samples));
    const CameraRays rays(scene.camera);
    const glm::ivec2 tiles = (size + kTile - 1) / kTile;
    const size_t count = static_cast<size_t>(tiles.x) * tiles.y;
    std::mutex progress_mutex;
    size_t finished = 0;
    parallel_for(count, [&](size_t tile) {
        const glm::ivec2 first = kTile * glm::ivec2(tile % tiles.x, tile / tiles.x);
        const glm::ivec2 end = glm::min(first + kTile, size);
        for (int y = first.y; y < end.y; ++y)
            for (int x = first.x; x < end.x; ++x)
                render_pixel(scene, rays, x, y)
                    .store(image, static_cast<size_t>(y) * size.x + x, scene.settings.samples);
        const std::scoped_lock lock(progress_mutex);
        ++finished;
        if (progress)
            progress(static_cast<double>(finished) / static_cast<double>(count));
    });
    return image;
}

} // namespace rapport
