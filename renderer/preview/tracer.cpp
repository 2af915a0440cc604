#include "renderer/preview/tracer.h"

#include "renderer/core/parallel.h"
#include "renderer/integrator/path_tracer.h"

#include <algorithm>
#include <limits>

namespace rapport {
namespace {

constexpr double kFirstSeconds = 0.07; ///< what a view's first picture should take
constexpr double kPatience = 0.1;      ///< how long it may take when the next view waits [s]
constexpr double kFirstGuess = 2e5;    ///< paths per second, before any have been traced
constexpr double kShowEvery = 0.25;    ///< seconds between pictures of the full resolution
constexpr int kMostSamples = 1 << 14;
constexpr int kCoarsestScale = 16;

double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

glm::ivec2 scaled(const glm::ivec2& resolution, int scale) {
    return (resolution + scale - 1) / scale;
}

int first_scale(const glm::ivec2& resolution, double paths_per_second) {
    int scale = 1;
    for (; scale < kCoarsestScale; ++scale) {
        const glm::dvec2 size(scaled(resolution, scale));
        if (size.x * size.y <= kFirstSeconds * paths_per_second)
            break;
    }
    return scale;
}

} // namespace

Tracer::Tracer()
    : samples_(kMostSamples), paths_per_second_(kFirstGuess), thread_([this] { run(); }) {}

Tracer::~Tracer() {
    {
        const std::scoped_lock lock(mutex_);
        closing_ = true;
    }
    changed_.notify_all();
    thread_.join();
}

uint64_t Tracer::show(std::shared_ptr<const Scene> scene, const Camera& camera) {
    uint64_t number;
    {
        const std::scoped_lock lock(mutex_);
        number = ++latest_;
        view_ = {number, std::move(scene), camera, Clock::now()};
        error_.clear();
    }
    changed_.notify_all();
    return number;
}

void Tracer::set_samples(int samples) {
    {
        const std::scoped_lock lock(mutex_);
        samples_ = std::clamp(samples, 1, kMostSamples);
    }
    changed_.notify_all();
}

std::shared_ptr<const TracedPicture> Tracer::picture() const {
    const std::scoped_lock lock(mutex_);
    return picture_;
}

std::string Tracer::error() const {
    const std::scoped_lock lock(mutex_);
    return error_;
}

double Tracer::seconds_to_stop() const {
    const std::scoped_lock lock(mutex_);
    return seconds_to_stop_;
}

bool Tracer::outdated(const View& view) const { return closing_ || latest_ != view.number; }

void Tracer::run() {
    for (uint64_t last = 0;;) {
        View view;
        {
            std::unique_lock lock(mutex_);
            const bool idle = latest_ == last;
            changed_.wait(lock, [&] { return closing_ || latest_ != last; });
            if (closing_)
                return;
            view = view_;
            last = view.number;
            if (!idle)
                seconds_to_stop_ = seconds_since(view.asked);
        }
        try {
            trace(view);
        } catch (const std::exception& error) {
            const std::scoped_lock lock(mutex_);
            if (latest_ == view.number)
                error_ = error.what();
        }
    }
}

void Tracer::trace(const View& view) {
    const int first = first_scale(view.camera.resolution, paths_per_second_);
    for (int scale = first;; scale /= 2) {
        Camera camera = view.camera;
        camera.resolution = scaled(camera.resolution, scale);
        const CameraRays rays(camera);
        Film& film = film_for(scale, camera.resolution);
        if (!pass(view, rays, film, scale == first))
            return;
        if (scale == first || !outdated(view))
            publish(view, camera, film, scale, 1);
        if (scale > 1)
            continue;
        Clock::time_point shown = Clock::now();
        for (int samples = 1;;) {
            {
                std::unique_lock lock(mutex_);
                changed_.wait(lock, [&] { return outdated(view) || samples < samples_; });
            }
            if (!pass(view, rays, film, false))
                return;
            ++samples;
            if (samples < samples_ && seconds_since(shown) < kShowEvery)
                continue;
            publish(view, camera, film, scale, samples);
            shown = Clock::now();
        }
    }
}

Film& Tracer::film_for(int scale, const glm::ivec2& resolution) {
    if (const auto found = films_.find(scale); found != films_.end()) {
        if (found->second.resolution() == resolution) {
            for (Film::Tile& tile : found->second.tiles())
                tile.samples = 0; // cleared by its first pass
            return found->second;
        }
        films_.erase(found);
    }
    return films_.emplace(scale, resolution).first->second;
}

bool Tracer::pass(const View& view, const CameraRays& rays, Film& film, bool first) {
    const Clock::time_point start = Clock::now();
    std::atomic<uint64_t> paths = 0, traced = 0, left_out = 0;
    parallel_for(film.tiles().size(), [&](size_t i) {
        if (closing_ || (outdated(view) && !(first && seconds_since(start) < kPatience))) {
            ++left_out;
            return;
        }
        Film::Tile& tile = film.tiles()[i];
        if (tile.samples == 0)
            film.clear(tile);
        traced += sample_tile(*view.scene, rays, film, tile, tile.samples + 1);
        const glm::ivec2 size = tile.end - tile.first;
        paths += static_cast<uint64_t>(size.x) * size.y;
    });
    if (paths > 0) {
        const double seconds = std::max(seconds_since(start), 1e-6);
        paths_per_second_ = static_cast<double>(paths) / seconds;
        rays_per_second_ = static_cast<double>(traced) / seconds;
    }
    return left_out == 0;
}

void Tracer::publish(const View& view, const Camera& camera, const Film& film, int scale,
                     int samples) {
    auto picture = std::make_shared<TracedPicture>();
    picture->view = view.number;
    picture->image = film.image();
    picture->camera = camera;
    picture->scale = scale;
    picture->samples = samples;
    picture->noise =
        samples > 1 ? film.noise().relative() : std::numeric_limits<double>::infinity();
    picture->rays_per_second = rays_per_second_;
    const std::scoped_lock lock(mutex_);
    picture_ = std::move(picture);
}

} // namespace rapport
