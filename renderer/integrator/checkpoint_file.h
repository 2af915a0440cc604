#pragma once

#include "renderer/integrator/path_tracer.h"

#include <span>

namespace rapport {

/// A picture on its way, in the tensor file container: `run`, a JSON object of the settings and of
/// what the scene was made of; for the tiles in turn `samples` [T] taken of each pixel and those
/// `planned` [T]; `sums` [H, W, 17], the film's own, to the last bit.
void write_checkpoint(const RenderCheckpoint& checkpoint, const RenderSettings& settings,
                      const Film& film, std::span<const int> planned);

/// FileError where the file is damaged, or of a picture that `settings`, `film` or
/// `checkpoint.made_of` are not those of: its message names what differs.
void read_checkpoint(const RenderCheckpoint& checkpoint, const RenderSettings& settings, Film& film,
                     std::vector<int>& planned);

} // namespace rapport
