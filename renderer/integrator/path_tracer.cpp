#include "renderer/integrator/path_tracer.h"

#include "renderer/core/parallel.h"
#include "renderer/integrator/checkpoint_file.h"
#include "renderer/integrator/path.h"
#include "renderer/integrator/sample_plan.h"

#include <algorithm>
#include <chrono>
#include <fmt/format.h>
#include <mutex>
#include <stdexcept>

namespace rapport {
namespace {

constexpr int kPass = 16;  ///< samples of a pixel in one go; an interrupted picture is as even
constexpr int kPilot = 16; ///< samples of every pixel before the first plan

bool finite(const Rgb& c) { return std::isfinite(c.r) && std::isfinite(c.g) && std::isfinite(c.b); }

std::string told(const Rgb& c) { return fmt::format("[{} {} {}]", c.r, c.g, c.b); }

/// A sample of a pixel, about to be taken.
struct CameraSample {
    int x, y, number;
    Sampler sampler; ///< what is left of it when the place in the pixel is chosen
    kernel::Ray ray;
};

CameraSample camera_sample(const Scene& scene, const CameraRays& rays, int width, int x, int y,
                           int number) {
    const RenderSettings& settings = scene.settings;
    const uint64_t pixel = static_cast<uint64_t>(y) * width + x;
    Sampler sampler(settings.sampler, settings.seed, pixel, static_cast<uint32_t>(number));
    // Uniform over the box filter, so that every sample has weight 1.
    const glm::vec2 offset = (2.0f * sampler.next_2d() - 1.0f) * settings.filter_radius;
    return {x, y, number, sampler, rays(glm::vec2(x, y) + 0.5f + offset)};
}

/// A path once more, for whoever has to find what is wrong with it.
std::string path_told(const Scene& scene, CameraSample sample) {
    std::vector<PathVertex> vertices;
    trace_path(scene, sample.ray, scene.intersect(sample.ray), sample.sampler, &vertices);
    std::string text = fmt::format("from {}", told(sample.ray.org));
    for (const PathVertex& vertex : vertices) {
        const auto& description = vertex.point.surface->description;
        const std::string material = !description                ? "a surface"
                                     : description->name.empty() ? description->type
                                                                 : description->name;
        text += fmt::format(", {} at {} with weight {}", material, told(vertex.point.position),
                            told(vertex.throughput));
    }
    return text;
}

/// `met` is what the sample's ray meets. Counts what it traces among `traced`.
FilmSample take_sample(const Scene& scene, const CameraRays& rays, int width, CameraSample& sample,
                       const std::optional<SurfacePoint>& met, uint64_t& traced) {
    const PathResult path = trace_path(scene, sample.ray, met, sample.sampler);
    traced += path.rays;
    if (!finite(path.radiance))
        throw std::runtime_error(
            fmt::format("pixel ({}, {}), sample {}: radiance {} is not finite; its path: {}",
                        sample.x, sample.y, sample.number, told(path.radiance),
                        path_told(scene, camera_sample(scene, rays, width, sample.x, sample.y,
                                                       sample.number))));
    if (!met)
        return {path.radiance};
    return {path.radiance, true, path.albedo, met->frame.z, met->frame.y, rays.depth(met->position),
            path.cut};
}

/// Brings tiles to the samples that are planned for each, all of them evenly.
class Rendering {
  public:
    Rendering(const Scene& scene, const RenderWatcher& watcher, const RenderCheckpoint& checkpoint)
        : film(scene.camera.resolution),
          plan(film.tiles().size(), scene.settings.error > 0 ? kPilot : scene.settings.samples),
          scene_(scene), rays_(scene.camera), watcher_(watcher), checkpoint_(checkpoint) {
        if (!checkpoint.resume || !std::filesystem::exists(checkpoint.path))
            return;
        read_checkpoint(checkpoint, scene.settings, film, plan);
        for (const Film::Tile& tile : film.tiles())
            taken_ += static_cast<double>(tile.samples) * pixels(tile);
    }

    /// False if it was stopped.
    bool carry_out_plan() {
        const int most = *std::ranges::max_element(plan);
        planned_ = 0;
        for (size_t i = 0; i < plan.size(); ++i)
            planned_ += static_cast<double>(plan[i]) * pixels(film.tiles()[i]);
        pass(1);
        for (int samples = kPass; samples - kPass < most && !stopped(); samples += kPass)
            pass(samples);
        if (!stopped())
            return true;
        save();
        return false;
    }

    Film film;
    std::vector<int> plan; ///< samples of each tile

  private:
    using Clock = std::chrono::steady_clock;
    static double seconds_since(Clock::time_point then) {
        return std::chrono::duration<double>(Clock::now() - then).count();
    }
    static double pixels(const Film::Tile& tile) {
        const glm::ivec2 size = tile.end - tile.first;
        return static_cast<double>(size.x) * size.y;
    }
    bool stopped() const { return watcher_.stopped && watcher_.stopped(); }

    bool save_is_due() const {
        return !checkpoint_.path.empty() &&
               seconds_since(saved_) > std::max(1.0, kWorkPerSaving * saving_);
    }

    void pass(int samples) {
        trace(samples);
        while (save_is_due()) { // and hence some tiles may still wait
            save();
            trace(samples);
        }
    }

    /// Samples tiles until all have what they should have by now, or it is time to save.
    void trace(int samples) {
        std::vector<size_t> open;
        for (size_t i = 0; i < plan.size(); ++i)
            if (film.tiles()[i].samples < std::min(plan[i], samples))
                open.push_back(i);
        parallel_for(open.size(), [&](size_t number) {
            Film::Tile& tile = film.tiles()[open[number]];
            if ((tile.samples > 0 && stopped()) || save_is_due())
                return;
            const int start = tile.samples;
            sample_tile(scene_, rays_, film, tile, std::min(plan[open[number]], samples));
            const std::scoped_lock lock(mutex_);
            taken_ += (tile.samples - start) * pixels(tile);
            if (watcher_.progress)
                watcher_.progress(
                    taken_ / planned_,
                    planned_ / (static_cast<double>(film.resolution().x) * film.resolution().y));
        });
    }

    void save() {
        if (checkpoint_.path.empty())
            return;
        const Clock::time_point start = Clock::now();
        write_checkpoint(checkpoint_, scene_.settings, film, plan);
        saving_ = seconds_since(start);
        saved_ = Clock::now();
    }

    const Scene& scene_;
    const CameraRays rays_;
    const RenderWatcher& watcher_;
    const RenderCheckpoint& checkpoint_;
    double planned_ = 0, taken_ = 0; ///< samples of all pixels
    std::mutex mutex_;
    Clock::time_point saved_ = Clock::now();
    double saving_ = 0; ///< seconds that the last checkpoint took
};

} // namespace

uint64_t sample_tile(const Scene& scene, const CameraRays& rays, Film& film, Film::Tile& tile,
                     int until) {
    uint64_t traced = 0;
    const int width = film.resolution().x;
    const int samples = until - tile.samples, row = samples * (tile.end.x - tile.first.x);
    kernel::Packet<kernel::Ray> camera_rays;
    std::vector<CameraSample> packet;
    packet.reserve(camera_rays.size());
    for (int y = tile.first.y; y < tile.end.y; ++y)
        for (int i = 0; i < row; packet.clear()) {
            for (; i < row && packet.size() < camera_rays.size(); ++i) {
                packet.push_back(camera_sample(scene, rays, width, tile.first.x + i / samples, y,
                                               tile.samples + i % samples));
                camera_rays[packet.size() - 1] = packet.back().ray;
            }
            const auto met = scene.intersect(std::span(camera_rays).first(packet.size()));
            for (size_t k = 0; k < packet.size(); ++k)
                film.add(packet[k].x, y, packet[k].number,
                         take_sample(scene, rays, width, packet[k], met[k], traced));
        }
    tile.samples = until;
    return traced;
}

Film render(const Scene& scene, const RenderWatcher& watcher, const RenderCheckpoint& checkpoint) {
    Rendering rendering(scene, watcher, checkpoint);
    const double error = scene.settings.error;
    while (rendering.carry_out_plan() && error > 0) {
        std::vector<int> next = plan_samples(rendering.film, error);
        if (next == rendering.plan)
            break;
        rendering.plan = std::move(next);
    }
    return std::move(rendering.film);
}

} // namespace rapport
