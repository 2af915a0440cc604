#include "vgsp/element_report.h"

#include "renderer/core/math.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace rapport {
namespace {

using glm::dvec2, glm::dvec3, glm::ivec3;
using kernel::FibreSegment;

constexpr int kSamples = 20000;

struct SurfacePoint {
    dvec3 position;
    uint32_t segment;
};

double lateral_area(const FibreSegment& s) { return 2 * kPi * s.radius * s.length; }

std::vector<SurfacePoint> spread_over(std::span<const FibreSegment> segments, int samples) {
    double area = 0;
    for (const FibreSegment& s : segments)
        area += lateral_area(s);
    // Equal steps of area, and about each cylinder steps of the golden section.
    constexpr double kGolden = 0.6180339887498949;
    std::vector<SurfacePoint> points;
    points.reserve(samples);
    double passed = 0;
    for (uint32_t i = 0; i < segments.size(); ++i) {
        const FibreSegment& s = segments[i];
        const auto frame = BasicFrame<double>::about(s.direction);
        for (;;) {
            const double along =
                ((points.size() + 0.5) / samples * area - passed) / lateral_area(s);
            if (!(along < 1) || int(points.size()) == samples)
                break;
            const double turn = 2 * kPi * std::fmod(points.size() * kGolden, 1.0);
            points.push_back({s.start + along * s.length * s.direction +
                                  s.radius * (std::cos(turn) * frame.x + std::sin(turn) * frame.y),
                              i});
        }
        passed += lateral_area(s);
    }
    return points;
}

/// The surface points sorted into boxes that repeat with the cell.
class PeriodicBoxes {
  public:
    PeriodicBoxes(dvec2 cell, const std::vector<SurfacePoint>& points, double box)
        : size_(cell, 0) {
        low_ = HUGE_VAL;
        double high = -HUGE_VAL;
        for (const SurfacePoint& p : points) {
            low_ = std::min(low_, p.position.z);
            high = std::max(high, p.position.z);
        }
        size_.z = std::max(high - low_, box);
        const auto boxes = [&](double size) { return std::clamp(int(size / box), 1, 512); };
        count_ = {boxes(size_.x), boxes(size_.y), boxes(size_.z)};

        starts_.assign(size_t(count_.x) * count_.y * count_.z + 1, 0);
        for (const SurfacePoint& p : points)
            ++starts_[index(box_of(p.position)) + 1];
        for (size_t k = 1; k < starts_.size(); ++k)
            starts_[k] += starts_[k - 1];
        contents_.resize(points.size());
        std::vector<uint32_t> next(starts_.begin(), starts_.end() - 1);
        for (uint32_t k = 0; k < points.size(); ++k)
            contents_[next[index(box_of(points[k].position))]++] = {
                k, cell_of(box_of(points[k].position))};
    }

    /// Calls visit(point, shift) for the points of all boxes that [low, high] touches; shifted by
    /// so many cells, the point lies in that box.
    template <class Visit> void around(const dvec3& low, const dvec3& high, Visit visit) const {
        ivec3 first = box_of(low), last = box_of(high);
        first.z = std::max(first.z, 0);
        last.z = std::min(last.z, count_.z - 1);
        for (int z = first.z; z <= last.z; ++z)
            for (int y = first.y; y <= last.y; ++y)
                for (int x = first.x; x <= last.x; ++x) {
                    const size_t box = index({x, y, z});
                    const dvec2 cells = cell_of({x, y, z});
                    for (uint32_t k = starts_[box]; k < starts_[box + 1]; ++k)
                        visit(contents_[k].point, cells - contents_[k].cells);
                }
    }

  private:
    ivec3 box_of(const dvec3& p) const {
        const dvec3 t = (p - dvec3(0, 0, low_)) / size_ * dvec3(count_);
        return {int(std::floor(t.x)), int(std::floor(t.y)), int(std::floor(t.z))};
    }
    dvec2 cell_of(ivec3 box) const { return floor(dvec2(box) / dvec2(count_)); }
    size_t index(ivec3 box) const {
        const auto wrap = [](int i, int n) { return ((i % n) + n) % n; };
        const int z = std::clamp(box.z, 0, count_.z - 1);
        return (size_t(z) * count_.y + wrap(box.y, count_.y)) * count_.x + wrap(box.x, count_.x);
    }

    dvec3 size_;
    double low_;
    ivec3 count_;
    struct Content {
        uint32_t point;
        dvec2 cells; ///< in which cell of the endless assembly it lies
    };
    std::vector<uint32_t> starts_;
    std::vector<Content> contents_;
};

bool inside(const FibreSegment& s, const dvec3& p) {
    const dvec3 offset = p - s.start;
    const double along = dot(offset, s.direction);
    return dot(offset, offset) - along * along < square(s.radius * (1 - 1e-9)) &&
           dot(offset, s.start_normal) >= 0 && dot(offset, s.end_normal) <= s.end_offset;
}

/// True if shifting by whole cells moves the fibre onto itself.
bool is_period(const dvec2& shift, const dvec3& period) {
    if (shift == dvec2(0))
        return true;
    const dvec2 p(period);
    const double cells = dot(shift, p) / std::max(dot(p, p), 1e-300);
    return length(shift - std::round(cells) * p) < 1e-6 * length(shift);
}

} // namespace

double overlap_fraction(const kernel::FibreAssembly& assembly,
                        std::span<const FibreSegment> segments, const StopSignal& stopped) {
    if (segments.empty())
        return 0;
    const std::vector<SurfacePoint> points = spread_over(segments, kSamples);
    double radius = 0;
    for (const FibreSegment& s : segments)
        radius = std::max(radius, s.radius);
    const PeriodicBoxes boxes(assembly.cell, points, 4 * radius);

    std::vector<uint8_t> covered(points.size(), 0);
    for (size_t i = 0; i < segments.size(); ++i) {
        constexpr size_t kAskEvery = 4096;
        if (i % kAskEvery == 0)
            throw_if(stopped);
        const FibreSegment& s = segments[i];
        const dvec3 end = s.start + s.direction * s.length;
        const auto cover = [&](uint32_t k, const dvec2& cells) {
            if (covered[k])
                return;
            const SurfacePoint& point = points[k];
            const dvec2 shift = cells * assembly.cell;
            const bool same_fibre = segments[point.segment].chain == s.chain &&
                                    is_period(shift, assembly.chains[s.chain].period);
            if (!same_fibre && inside(s, point.position + dvec3(shift, 0)))
                covered[k] = 1;
        };
        boxes.around(min(s.start, end) - s.radius, max(s.start, end) + s.radius, cover);
    }
    size_t count = 0;
    for (uint8_t c : covered)
        count += c;
    return double(count) / points.size();
}

} // namespace rapport
