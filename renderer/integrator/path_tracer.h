#pragma once

#include "renderer/core/checkpoint.h"
#include "renderer/integrator/film.h"
#include "renderer/scene/scene.h"

#include <functional>
#include <map>
#include <string>

namespace rapport {

struct RenderWatcher {
    /// Told the finished share of the samples that are planned so far, (0, 1], and the samples of a
    /// pixel that it is a share of (in the mean); from any thread but never from two at a time.
    std::function<void(double fraction, double samples)> progress;
    /// Asked from any thread; once true, the picture is made of the samples that there are. The
    /// first sample of every pixel is taken in any case.
    std::function<bool()> stopped;
};

/// Where a picture on its way is kept, from a second after its start.
struct RenderCheckpoint : Checkpoint {
    /// What the scene was made of, in whatever words, for its settings alone do not tell it from
    /// others: a picture is not taken up by a run that says anything else.
    std::map<std::string, std::string> made_of;
};

/// Renders with next-event estimation, MIS (balance heuristic), Russian roulette and null
/// interactions for the unscattered beam, to the samples or the error of the scene's settings (see
/// sample_plan.h). The same seed gives the same pixels, whatever the number of threads, and whether
/// or not the picture was made in one go.
///
/// Throws std::runtime_error naming the pixel where a radiance is not finite, and FileError where
/// the checkpoint is damaged or of another picture.
Film render(const Scene& scene, const RenderWatcher& watcher = {},
            const RenderCheckpoint& checkpoint = {});

/// Takes the samples [tile.samples, until) of every pixel of one of the film's tiles, through a
/// camera of the film's resolution, which need not be the scene's: those that `render` takes there.
/// Different tiles may be sampled at the same time. Returns how many rays that took. Throws as
/// `render` does.
uint64_t sample_tile(const Scene& scene, const CameraRays& rays, Film& film, Film::Tile& tile,
                     int until);

} // namespace rapport
