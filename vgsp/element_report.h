#pragma once

#include "renderer/core/stop_signal.h"
#include "renderer/kernel/fibres.h"

#include <span>

namespace rapport {

/// The share of the fibres' surface that lies inside another fibre, [0, 1]: estimated from
/// 20,000 points spread evenly over the area of all cylinders (a low-discrepancy sequence, so
/// the same assembly always gives the same number). Standard error at most √(result/20,000).
/// Throws Stopped when told to stop. Where fibres overlap the tracer must fall back on the paper's
/// shift rule.
double overlap_fraction(const kernel::FibreAssembly& assembly,
                        std::span<const kernel::FibreSegment> segments,
                        const StopSignal& stopped = {});

} // namespace rapport
