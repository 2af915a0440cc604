#pragma once

#include "renderer/core/image.h"
#include "renderer/core/stop_signal.h"
#include "renderer/integrator/film.h"
#include "renderer/scene/scene.h"

#include <condition_variable>
#include <map>
#include <mutex>
#include <thread>

namespace rapport {

/// What has been seen so far of a view; constant.
struct TracedPicture {
    uint64_t view = 0; ///< the number that Tracer::show gave it
    Image image;       ///< Film::image
    Camera camera;     ///< that took it
    int scale = 1;     ///< pixels of the view along the side of a pixel here
    int samples = 0;   ///< of each pixel
    double noise = 0;  ///< Film::Noise::relative of the whole; infinite from one sample
    double rays_per_second = 0;
};

/// Renders in the background at rising quality: first at a resolution that takes a fifteenth of a
/// second, then at doubled ones, and at last sample after sample at the full one, where the picture
/// of n samples is the one that `render` makes of n. A new view takes the place of the old one at
/// once, except that a view's first picture is finished even when the next view waits, for a
/// moving camera would otherwise show nothing.
class Tracer {
  public:
    Tracer();
    Tracer(const Tracer&) = delete;
    Tracer& operator=(const Tracer&) = delete;
    ~Tracer();

    /// Starts on a view and returns its number, counted up from 1.
    uint64_t show(std::shared_ptr<const Scene> scene, const Camera& camera);
    /// How many samples a picture gets; may change while it is traced.
    void set_samples(int samples);

    /// The number of the latest view, 0 before the first.
    uint64_t latest() const { return latest_; }
    /// The latest one; nothing before the first.
    std::shared_ptr<const TracedPicture> picture() const;
    /// Why the latest view cannot be traced, or empty.
    std::string error() const;
    /// From the last new view to the moment when work on the one before it had ended [s].
    double seconds_to_stop() const;

  private:
    using Clock = std::chrono::steady_clock;
    struct View {
        uint64_t number = 0;
        std::shared_ptr<const Scene> scene;
        Camera camera;
        Clock::time_point asked;
    };

    void run();
    void trace(const View& view);
    /// An empty film for one level of a view.
    Film& film_for(int scale, const glm::ivec2& resolution);
    bool outdated(const View& view) const;
    /// One more sample of every pixel; false if the view was outdated before the end.
    bool pass(const View& view, const CameraRays& rays, Film& film, bool first);
    void publish(const View& view, const Camera& camera, const Film& film, int scale, int samples);

    mutable std::mutex mutex_;
    std::condition_variable changed_;
    View view_;                        ///< the latest
    std::atomic<uint64_t> latest_ = 0; ///< its number
    std::atomic<int> samples_;
    std::atomic<bool> closing_ = false;
    std::shared_ptr<const TracedPicture> picture_;
    std::string error_;
    double seconds_to_stop_ = 0;
    // Of the tracer's thread alone.
    double paths_per_second_, rays_per_second_ = 0; ///< of the last pass
    std::map<int, Film> films_; ///< by scale, kept because a large film takes long to allocate
    std::thread thread_;        ///< last, for it uses all others
};

} // namespace rapport
