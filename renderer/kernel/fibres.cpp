#include "renderer/kernel/fibres.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <stdexcept>

namespace rapport::kernel {
namespace {

using glm::dvec3;

[[noreturn]] void reject(size_t chain, size_t point, const char* what) {
    throw std::invalid_argument(fmt::format("fibre {}, point {}: {}", chain, point, what));
}

bool finite(const dvec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

bool whole_cells(double period, double cell) {
    const double cells = period / cell;
    return std::abs(cells - std::round(cells)) <= 1e-9 * std::max(1.0, std::abs(cells));
}

void check_chain(const FibreAssembly& assembly, size_t index) {
    const FibreChain& chain = assembly.chains[index];
    if (chain.points.empty())
        reject(index, 0, "the chain has no points");
    if (!(chain.radius > 0 && std::isfinite(chain.radius)))
        reject(index, 0, "the radius is not positive");
    if (!finite(chain.period) || chain.period.z != 0 ||
        !whole_cells(chain.period.x, assembly.cell.x) ||
        !whole_cells(chain.period.y, assembly.cell.y))
        reject(index, 0, "the period is not a whole number of cells along x and y");
    for (size_t k = 0; k < chain.points.size(); ++k)
        if (!finite(chain.points[k]))
            reject(index, k, "the point is not finite");
}

/// True if the mitre planes of `s` cross inside its cylinder. The surface line on the side of the
/// unit vector e ⟂ direction runs from −radius·(n0·e)/(n0·d) to length − radius·(n1·e)/(n1·d).
bool mitres_cross(const FibreSegment& s) {
    const dvec3 spread = s.end_normal / dot(s.end_normal, s.direction) -
                         s.start_normal / dot(s.start_normal, s.direction);
    return !(s.length > s.radius * glm::length(spread));
}

} // namespace

std::vector<FibreSegment> fibre_segments(const FibreAssembly& assembly, const StopSignal& stopped) {
    if (!(assembly.cell.x > 0 && assembly.cell.y > 0))
        throw std::invalid_argument("the cell of a fibre assembly has no area");
    size_t total = 0;
    for (const FibreChain& chain : assembly.chains)
        total += chain.points.size();

    std::vector<FibreSegment> segments;
    segments.reserve(total);
    for (size_t c = 0; c < assembly.chains.size(); ++c) {
        throw_if(stopped);
        check_chain(assembly, c);
        const FibreChain& chain = assembly.chains[c];
        const uint32_t first = uint32_t(segments.size());
        const uint32_t count = uint32_t(chain.points.size());
        for (uint32_t k = 0; k < count; ++k) {
            const dvec3 end = k + 1 < count ? chain.points[k + 1] : chain.points[0] + chain.period;
            const dvec3 along = end - chain.points[k];
            const double length = glm::length(along);
            if (!(length > 0))
                reject(c, k, "it coincides with the next one");
            FibreSegment& s = segments.emplace_back();
            s.start = chain.points[k];
            s.direction = along / length;
            s.length = length;
            s.radius = chain.radius;
            s.chain = uint32_t(c);
            s.previous = first + (k + count - 1) % count;
            s.next = first + (k + 1) % count;
            s.kind = chain.kind;
        }
        for (uint32_t k = first; k < first + count; ++k) {
            FibreSegment& s = segments[k];
            FibreSegment& next = segments[s.next];
            const dvec3 bisector = s.direction + next.direction;
            const double size = glm::length(bisector);
            if (!(size > 1e-6))
                reject(c, s.next - first, "the fibre folds back on itself");
            s.end_normal = next.start_normal = bisector / size;
            s.end_offset = s.length * dot(s.direction, s.end_normal);
        }
        for (uint32_t k = first; k < first + count; ++k)
            if (mitres_cross(segments[k]))
                reject(c, k - first, "the bend is too sharp for the fibre's radius");
    }
    return segments;
}

} // namespace rapport::kernel
