#include "renderer/app/element_picture.h"

#include "renderer/app/lettering.h"
#include "renderer/core/parallel.h"
#include "renderer/kernel/fibre_tracer.h"
#include "vgsp/micro_element.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>

namespace rapport {
namespace {

constexpr int kWidth = 900;        ///< pixels
constexpr int kMostThreads = 12;   ///< of a repeat that are shown along each side
constexpr double kTurnDegrees = 4; ///< of a fibre between two segments: round enough to look at
constexpr Canvas::Colour kBackground{1, 1, 1};

/// Warp, weft and named yarns; told apart by people who see colours differently (Okabe & Ito 2008).
constexpr std::array<glm::vec3, 6> kColours{{{0.84f, 0.37f, 0.0f},
                                             {0.0f, 0.45f, 0.70f},
                                             {0.0f, 0.62f, 0.45f},
                                             {0.80f, 0.47f, 0.65f},
                                             {0.90f, 0.62f, 0.0f},
                                             {0.34f, 0.71f, 0.91f}}};

glm::vec3 colour_of(uint32_t kind) { return kColours[kind % kColours.size()]; }

/// The longest of 1, 2 and 5 times powers of ten that is no longer.
double round_length(double length) {
    const double power = std::pow(10.0, std::floor(std::log10(length)));
    return (length < 2 * power ? 1 : length < 5 * power ? 2 : 5) * power;
}

class Views {
  public:
    explicit Views(const Cloth& cloth)
        : spacing_(1e4 / cloth.ends_per_cm, 1e4 / cloth.picks_per_cm),
          element_(build_micro_element(cloth, {.max_turn_degrees = kTurnDegrees})),
          tracer_(element_.fibres),
          extent_(glm::min(element_.fibres.cell, double(kMostThreads) * spacing_)),
          scale_(kWidth / std::max(extent_.x, extent_.y)) {}

    ElementViews draw() const {
        return {scale_, top(pixels(extent_.x), pixels(extent_.y)), cut(0), cut(1)};
    }

  private:
    int pixels(double length) const {
        return std::max(1, static_cast<int>(std::lround(scale_ * length)));
    }

    Canvas top(int width, int height) const {
        Canvas canvas(width, height, kBackground);
        const glm::vec3 lamp = glm::normalize(glm::vec3(-0.5f, 0.6f, 1));
        parallel_for(static_cast<size_t>(height), [&](size_t row) {
            for (int x = 0; x < width; ++x) {
                const glm::dvec3 above((x + 0.5) / scale_,
                                       (height - 0.5 - static_cast<double>(row)) / scale_,
                                       tracer_.z_max() + 1);
                const kernel::FibreTracer::Entry entry =
                    tracer_.enter(above, {0, 0, -1}, kernel::FibreTracer::kNone);
                if (entry.flight != kernel::FibreTracer::Flight::enters)
                    continue;
                const kernel::FibreSegment& segment = tracer_.segments()[entry.point.segment];
                const float light = std::max(0.0f, glm::dot(glm::vec3(entry.point.normal), lamp));
                canvas.set(x, static_cast<int>(row),
                           (0.25f + 0.75f * light) * colour_of(segment.kind));
            }
        });
        return canvas;
    }

    /// A cut in the making: of each pixel the fibre whose axis is nearest, in its radii.
    struct Cut {
        int axis; ///< that runs to the right: 0 the weft, 1 the warp
        int width, height;
        std::vector<float> distance;
        std::vector<uint32_t> kind;
    };

    /// The plane half a spacing from the origin across the other axis: `axis` 0 runs along the weft
    /// through the first pick, 1 along the warp through the first end, and is turned upwards.
    Canvas cut(int axis) const {
        const int width = pixels(extent_[axis]), height = pixels(tracer_.z_max() - tracer_.z_min());
        const size_t size = static_cast<size_t>(width) * height;
        Cut cut{axis, width, height, std::vector<float>(size, 2), std::vector<uint32_t>(size)};
        const glm::dvec2 cell = element_.fibres.cell;
        for (const kernel::FibreSegment& segment : tracer_.segments()) {
            // A fibre may run through many cells before it closes, and is stored as it runs.
            const glm::dvec2 stored(segment.start);
            const glm::dvec2 start = stored - cell * glm::floor(stored / cell);
            for (int i = -1; i <= 1; ++i)
                for (int j = -1; j <= 1; ++j)
                    add_segment(segment, {start + cell * glm::dvec2(i, j), segment.start.z}, cut);
        }
        Canvas canvas(axis == 0 ? width : height, axis == 0 ? height : width, kBackground);
        for (size_t i = 0; i < size; ++i) {
            if (cut.distance[i] > 1)
                continue;
            const int x = static_cast<int>(i % width), y = static_cast<int>(i / width);
            const Canvas::Colour colour =
                (cut.distance[i] > 0.8f ? 0.6f : 1.0f) * colour_of(cut.kind[i]);
            if (axis == 0)
                canvas.set(x, y, colour);
            else
                canvas.set(y, width - 1 - x, colour);
        }
        return canvas;
    }

    void add_segment(const kernel::FibreSegment& segment, const glm::dvec3& start, Cut& cut) const {
        const int across = 1 - cut.axis;
        const double plane = 0.5 * spacing_[across];
        const glm::dvec3 end = start + segment.length * segment.direction;
        const glm::dvec3 low = glm::min(start, end) - segment.radius;
        const glm::dvec3 high = glm::max(start, end) + segment.radius;
        if (low[across] > plane || high[across] < plane || high[cut.axis] < 0 ||
            low[cut.axis] * scale_ > cut.width)
            return;
        const glm::ivec2 first(std::max(0.0, scale_ * low[cut.axis]),
                               std::max(0.0, scale_ * (tracer_.z_max() - high.z)));
        const glm::ivec2 last(std::min<double>(cut.width, scale_ * high[cut.axis] + 1),
                              std::min<double>(cut.height, scale_ * (tracer_.z_max() - low.z) + 1));
        for (int y = first.y; y < last.y; ++y)
            for (int x = first.x; x < last.x; ++x) {
                glm::dvec3 p(0, 0, tracer_.z_max() - (y + 0.5) / scale_);
                p[cut.axis] = (x + 0.5) / scale_;
                p[across] = plane;
                const double along =
                    std::clamp(glm::dot(p - start, segment.direction), 0.0, segment.length);
                const float distance = static_cast<float>(
                    glm::distance(p, start + along * segment.direction) / segment.radius);
                const size_t pixel = static_cast<size_t>(y) * cut.width + x;
                if (distance < cut.distance[pixel]) {
                    cut.distance[pixel] = distance;
                    cut.kind[pixel] = segment.kind;
                }
            }
    }

    glm::dvec2 spacing_; ///< of ends along x, of picks along y [µm]
    MicroElement element_;
    kernel::FibreTracer tracer_;
    glm::dvec2 extent_; ///< what is shown [µm]
    double scale_;      ///< pixels per µm
};

} // namespace

ElementViews element_views(const Cloth& cloth) { return Views(cloth).draw(); }

Drawing element_picture(const Cloth& cloth) {
    constexpr double kMargin = 20, kTitle = 24, kBox = 12; // pixels
    constexpr const char *kTop = "from the face, warp upwards",
                         *kWeftCut = "cut along the lowest pick, face up",
                         *kWarpCut = "cut along the leftmost end, face to the left";
    const ElementViews views = element_views(cloth);
    const double left = kMargin;
    const double right =
        left + kMargin +
        std::max({double(views.top.width()), text_width(kTop), text_width(kWeftCut)});
    const double width =
        right + std::max(double(views.warp_cut.width()), text_width(kWarpCut)) + kMargin;

    struct Name {
        glm::dvec2 at;
        Drawing::Colour colour;
        std::string words;
    };
    std::vector<Name> key;
    glm::dvec2 next(left, kMargin);
    for (const YarnKind& kind : yarn_kinds(cloth)) {
        const double length = kBox + 6 + text_width(kind.place) + kMargin;
        if (next.x > left && next.x + length > width)
            next = {left, next.y + kTitle};
        key.push_back({next, colour_of(static_cast<uint32_t>(key.size())), kind.place});
        next.x += length;
    }
    const double above = next.y + kBox + 10 + kTitle;
    const double below = above + views.top.height() + kTitle + 6;

    Drawing drawing(width, below + views.weft_cut.height() + kMargin);
    for (const Name& name : key) {
        drawing.rectangle(name.at, name.at + kBox, name.colour);
        drawing.text(name.at + glm::dvec2(kBox + 6, kBox - 2), Drawing::Anchor::start, name.words);
    }
    const auto view = [&](const glm::dvec2& corner, const char* title, const Canvas& pixels) {
        drawing.text(corner - glm::dvec2(0, 6), Drawing::Anchor::start, title);
        drawing.image(corner, pixels);
    };
    view({left, above}, kTop, views.top);
    view({left, below}, kWeftCut, views.weft_cut);
    view({right, above}, kWarpCut, views.warp_cut);

    const double length = round_length(150 / views.scale);
    const std::array bar{glm::dvec2(right, below + 6),
                         glm::dvec2(right + length * views.scale, below + 6)};
    drawing.line(bar, {0, 0, 0}, 3);
    drawing.text(bar[0] - glm::dvec2(0, 8), Drawing::Anchor::start,
                 length < 1000 ? fmt::format("{:g} µm", length)
                               : fmt::format("{:g} mm", length / 1000));
    return drawing;
}

} // namespace rapport
