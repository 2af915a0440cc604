#include "renderer/kernel/fibre_block.h"

#include "renderer/kernel/cylinder.h"
#include "renderer/kernel/embree.h"

#include <algorithm>
#include <stdexcept>
#if defined(__SANITIZE_THREAD__)
#include <sanitizer/tsan_interface.h>
#endif

namespace rapport::kernel {
namespace {

// Embree builds its tree on threads of TBB, which read what this thread has written, and commits
// when they are done. ThreadSanitizer cannot see how those libraries synchronise, and is told here:
// whatever was done before memory was handed over is known to whoever takes it over.
#if defined(__SANITIZE_THREAD__)
void hand_over(const void* memory) { __tsan_release(const_cast<void*>(memory)); }
void take_over(const void* memory) { __tsan_acquire(const_cast<void*>(memory)); }
#else
void hand_over(const void*) {}
void take_over(const void*) {}
#endif

constexpr double kLargestShift = std::numeric_limits<int16_t>::max();

/// Clamped: beyond the range of what is stored, where no copy lies, all shifts are alike.
Shift to_shift(double x, double y) {
    return {static_cast<int16_t>(std::clamp(x, -kLargestShift, kLargestShift)),
            static_cast<int16_t>(std::clamp(y, -kLargestShift, kLargestShift))};
}

/// First and last number of periods by which [low, high] must be moved to reach into [from, to].
std::pair<double, double> shifts_into(double from, double to, double low, double high,
                                      double period) {
    return {std::ceil((from - high) / period), std::floor((to - low) / period)};
}

constexpr uint32_t kNoCopy = ~0u;

/// At every so many segments, whether to stop.
void ask_at(size_t segment, const StopSignal& stopped) {
    constexpr size_t kAskEvery = 4096;
    if (segment % kAskEvery == 0)
        throw_if(stopped);
}

/// Half the thickness, the fastest in measurements on cells narrower and wider than the cloth is
/// thick: a wider block makes rays wrap less, and the hierarchy larger. Less than that where the
/// block would repeat a thick and narrow cell too often.
double choose_margin(double segments, const glm::dvec2& cell, double thickness) {
    constexpr double kMostCopies = 1 << 18;
    const double most = std::max(4.0, kMostCopies / segments);
    double margin = 0.5 * thickness;
    while ((cell.x + 2 * margin) * (cell.y + 2 * margin) > most * cell.x * cell.y)
        margin /= 2;
    return margin;
}

} // namespace

/// What the callback reads of one copy of a segment: one cache line.
struct alignas(64) FibreBlock::Copy {
    glm::vec3 start;
    float radius2;
    glm::vec3 direction;
    float end_offset;
    glm::vec3 start_normal;
    uint32_t segment;
    glm::vec3 end_normal;
    Shift shift;
};

struct FibreBlock::Embree {
    embree::Device device = embree::make_device();
    embree::Scene scene = embree::make_scene(device.get());
};

struct Callbacks {
    /// What Embree's building asks after.
    struct Building {
        const FibreBlock* block;
        const StopSignal* stopped;

        bool given_up() const { return *stopped && (*stopped)(); }
    };

    /// One ray's question and, copy by copy, its answer.
    struct Query : embree::Context {
        const FibreBlock* block;
        const FibreBlock::Ray* ray;
        uint32_t hit = kNoCopy;
        uint32_t around = kNoCopy; ///< a copy that the origin lies inside
    };

    static void bounds(const RTCBoundsFunctionArguments* arguments) {
        const auto& building = *static_cast<const Building*>(arguments->geometryUserPtr);
        take_over(&building);
        const FibreBlock& block = *building.block;
        if (building.given_up()) { // Embree does not ask until it has them all
            *arguments->bounds_o = {};
            hand_over(&building);
            return;
        }
        const FibreBlock::Copy& copy = block.copies_[arguments->primID];
        const auto [low, high] = kernel::bounds(block.segments_[copy.segment]);
        const glm::dvec3 offset = block.offset(copy.shift), pad(4 * block.tolerance_);
        const glm::vec3 from(low + offset - pad), to(high + offset + pad);
        *arguments->bounds_o = {from.x, from.y, from.z, 0, to.x, to.y, to.z, 0};
        hand_over(&building);
    }

    /// Embree asks whether it is to go on with the hierarchy.
    static bool goes_on(void* building, double) {
        take_over(building);
        const bool goes_on = !static_cast<const Building*>(building)->given_up();
        hand_over(building);
        return goes_on;
    }

    /// The origin is within rounding of this copy's surface, or inside its cylinder: decided in
    /// double precision. Returns the distance to the entry if that lies ahead.
    static std::optional<float> entry_near_origin(Query& query, const FibreBlock::Copy& copy,
                                                  uint32_t number) {
        const FibreBlock& block = *query.block;
        const FibreBlock::Ray& ray = *query.ray;
        const FibreSegment& segment = block.segments_[copy.segment];
        const glm::dvec3 origin = ray.origin - block.offset(copy.shift);
        const CylinderCrossing crossing = cross(segment, origin, ray.direction);
        if (ray.test_overlap && inside(segment, origin) &&
            !block.same_fibre(copy.segment, copy.shift, ray.leaving, ray.leaving_shift))
            query.around = std::min(query.around, number);
        if (crossing.parallel || crossing.half == 0 || crossing.entry() < 0)
            return std::nullopt;
        return static_cast<float>(crossing.entry());
    }

    /// Embree asks whether its ray enters copy `primID`. The nearest entry wins, and of equally
    /// near ones the lowest number, so that the answer does not depend on the order of questions.
    static void intersect(const RTCIntersectFunctionNArguments* arguments) {
        if (!arguments->valid[0])
            return;
        Query& query = *static_cast<Query*>(arguments->context);
        const uint32_t number = arguments->primID;
        const FibreBlock::Copy& copy = query.block->copies_[number];
        if (copy.segment == query.ray->leaving && copy.shift == query.ray->leaving_shift)
            return;
        RTCRayHit& ray_hit = *reinterpret_cast<RTCRayHit*>(arguments->rayhit);
        RTCRay& ray = ray_hit.ray;
        const glm::vec3 origin(ray.org_x, ray.org_y, ray.org_z), d(ray.dir_x, ray.dir_y, ray.dir_z);
        const glm::vec3 from_start = origin - copy.start;
        const glm::vec3 radial = from_start - copy.direction * glm::dot(from_start, copy.direction);
        const glm::vec3 across = d - copy.direction * glm::dot(d, copy.direction);
        const float across2 = glm::dot(across, across);
        const auto tolerance = static_cast<float>(query.block->tolerance_);
        // Just beyond a mitre plane counts as within: a gap between neighbours would leak light.
        const auto between_planes = [&](const glm::vec3& point) {
            return glm::dot(point, copy.start_normal) >= -tolerance &&
                   glm::dot(point, copy.end_normal) <= copy.end_offset + tolerance;
        };
        float entry = -std::numeric_limits<float>::infinity(); // along the axis there is none
        if (across2 > 1e-12f) {
            const float centre = -glm::dot(radial, across) / across2;
            const glm::vec3 closest = radial + across * centre;
            const float chord2 = copy.radius2 - glm::dot(closest, closest);
            if (chord2 < 0)
                return;
            const float half = std::sqrt(chord2 / across2);
            entry = centre - half;
            if (entry > ray.tfar || centre + half < -tolerance)
                return;
        }
        if (entry < tolerance) {
            if (entry < -tolerance && !(query.ray->test_overlap && between_planes(from_start)))
                return;
            const std::optional<float> exact = entry_near_origin(query, copy, number);
            if (!exact || *exact > ray.tfar)
                return;
            entry = *exact;
        }
        if (!between_planes(from_start + d * entry))
            return;
        if (entry == ray.tfar && query.hit != kNoCopy && query.hit < number)
            return;
        query.hit = number;
        ray.tfar = entry;
        ray_hit.hit.geomID = arguments->geomID;
        ray_hit.hit.primID = number;
    }
};

FibreBlock::FibreBlock(const FibreAssembly& assembly, const StopSignal& stopped)
    : cell_(assembly.cell), segments_(fibre_segments(assembly, stopped)),
      embree_(std::make_unique<Embree>()) {
    if (segments_.empty())
        throw std::invalid_argument("an assembly without fibres");
    for (const FibreChain& chain : assembly.chains) {
        periods_.push_back(chain.period);
        chain_period_.push_back(
            to_shift(std::round(chain.period.x / cell_.x), std::round(chain.period.y / cell_.y)));
    }
    measure_extent(stopped);
    fill(stopped);
    Callbacks::Building building{this, &stopped};
    const RTCDevice device = embree_->device.get();
    const embree::Geometry geometry = embree::make_geometry(device, RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(geometry.get(), static_cast<unsigned>(copies_.size()));
    rtcSetGeometryUserData(geometry.get(), &building);
    rtcSetGeometryBoundsFunction(geometry.get(), Callbacks::bounds, nullptr);
    rtcSetGeometryIntersectFunction(geometry.get(), Callbacks::intersect);
    rtcCommitGeometry(geometry.get());
    rtcAttachGeometry(embree_->scene.get(), geometry.get());
    rtcSetSceneBuildQuality(embree_->scene.get(), RTC_BUILD_QUALITY_HIGH);
    rtcSetSceneProgressMonitorFunction(embree_->scene.get(), Callbacks::goes_on, &building);
    hand_over(&building);
    rtcCommitScene(embree_->scene.get());
    take_over(&building);
    throw_if(stopped); // before Embree's complaint that it was
    embree::check(device);
}
FibreBlock::~FibreBlock() = default;

void FibreBlock::measure_extent(const StopSignal& stopped) {
    z_min_ = std::numeric_limits<double>::infinity();
    z_max_ = -z_min_;
    for (size_t s = 0; s < segments_.size(); ++s) {
        ask_at(s, stopped);
        const auto [low, high] = bounds(segments_[s]);
        z_min_ = std::min(z_min_, low.z);
        z_max_ = std::max(z_max_, high.z);
    }
    margin_ = choose_margin(static_cast<double>(segments_.size()), cell_, z_max_ - z_min_);
    tolerance_ = 4e-7 * std::max({cell().x + margin_, cell().y + margin_, std::abs(z_min_),
                                  std::abs(z_max_)});
}

template <class Visit> void FibreBlock::each_copy(const StopSignal& stopped, Visit visit) const {
    const glm::dvec2 from(-margin_), to = cell() + margin_;
    for (uint32_t s = 0; s < segments_.size(); ++s) {
        ask_at(s, stopped);
        const auto [low, high] = bounds(segments_[s]);
        const auto [x_from, x_to] = shifts_into(from.x, to.x, low.x, high.x, cell().x);
        const auto [y_from, y_to] = shifts_into(from.y, to.y, low.y, high.y, cell().y);
        if (std::max({-x_from, x_to, -y_from, y_to}) >= kLargestShift)
            throw std::invalid_argument("a fibre strays too many cells from the base cell");
        for (double y = y_from; y <= y_to; ++y)
            for (double x = x_from; x <= x_to; ++x)
                visit(s, to_shift(x, y));
    }
}

void FibreBlock::fill(const StopSignal& stopped) {
    size_t count = 0;
    each_copy(stopped, [&](uint32_t, Shift) { ++count; });
    copies_.reserve(count); // exactly: they are most of the memory
    each_copy(stopped, [&](uint32_t s, Shift shift) {
        const FibreSegment& segment = segments_[s];
        copies_.push_back({glm::vec3(segment.start + offset(shift)),
                           static_cast<float>(square(segment.radius)), glm::vec3(segment.direction),
                           static_cast<float>(segment.end_offset), glm::vec3(segment.start_normal),
                           s, glm::vec3(segment.end_normal), shift});
    });
}

double FibreBlock::memory(double segments, const glm::dvec2& cell, double thickness) {
    // Embree's hierarchy, and what building it takes beside, measured per copy.
    constexpr double kHierarchy = 85, kBuilding = 55;
    // Longer than the block is wide, segments reach into it from further away.
    constexpr double kReachingIn = 1.1;
    const double margin = choose_margin(segments, cell, thickness);
    const double copies =
        segments * kReachingIn * (1 + 2 * margin / cell.x) * (1 + 2 * margin / cell.y);
    return segments * sizeof(FibreSegment) + copies * (sizeof(Copy) + kHierarchy + kBuilding);
}

/// Copies of one fibre differ by a whole number of its own periods.
bool FibreBlock::same_fibre(uint32_t segment_a, Shift a, uint32_t segment_b, Shift b) const {
    const uint32_t chain = segments_[segment_a].chain;
    if (chain != segments_[segment_b].chain)
        return false;
    const Shift period = chain_period_[chain];
    const int x = a.x - b.x, y = a.y - b.y;
    return x * period.y == y * period.x && (period.x != 0 ? x % period.x == 0 : y % period.y == 0);
}

Shift FibreBlock::wrap(glm::dvec3& origin) const {
    if (origin.x >= 0 && origin.x < cell().x && origin.y >= 0 && origin.y < cell().y)
        return {};
    const double x = std::floor(origin.x / cell().x), y = std::floor(origin.y / cell().y);
    origin.x -= x * cell().x;
    origin.y -= y * cell().y;
    return to_shift(-x, -y);
}

double FibreBlock::distance_to_side(const glm::dvec3& origin, const glm::dvec3& direction) const {
    double nearest = std::numeric_limits<double>::infinity();
    for (int axis = 0; axis < 2; ++axis) {
        const double face = direction[axis] > 0 ? cell()[axis] + margin_ : -margin_;
        if (direction[axis] != 0)
            nearest = std::min(nearest, (face - origin[axis]) / direction[axis]);
    }
    return nearest;
}

std::optional<FibreBlock::Found> FibreBlock::find(const Ray& ray) const {
    Callbacks::Query query;
    embree::initialise(query);
    query.block = this;
    query.ray = &ray;
    const glm::vec3 o(ray.origin), d(ray.direction);
    RTCRayHit ray_hit = embree::make_ray_hit(
        embree::make_ray(o.x, o.y, o.z, d.x, d.y, d.z, 0, static_cast<float>(ray.reach)));
    embree::intersect(embree_->scene.get(), query, ray_hit);
    const uint32_t number = query.around != kNoCopy ? query.around : query.hit;
    if (number == kNoCopy)
        return std::nullopt;
    return Found{copies_[number].segment, copies_[number].shift, query.around != kNoCopy};
}

} // namespace rapport::kernel
