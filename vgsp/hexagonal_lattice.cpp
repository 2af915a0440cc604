#include "vgsp/hexagonal_lattice.h"

#include "renderer/core/math.h"

#include <algorithm>
#include <cmath>

namespace rapport {
namespace {

using glm::dvec2;

/// Origins in the hexagonal lattice of unit spacing, rows along x. The lattice seen from each is
/// its own mirror image in x = 0, so that a yarn looks alike from both its ends.
const double kRow = std::sqrt(3.0) / 2;
const dvec2 kSite(0, 0);
const dvec2 kTriangle(0, 1 / std::sqrt(3.0));
const dvec2 kEdgeInRow(0.5, 0);
const dvec2 kBetweenRows(0, kRow / 2);

constexpr double kRounding = 1e-9; ///< relative; what may be missing of a length that just fits

/// Where the centre of a disc may lie inside an ellipse: its half-chord at each height.
class DiscInEllipse {
  public:
    DiscInEllipse(SectionOutline ellipse, double radius)
        : top_(ellipse.half_height - radius), slack_(kRounding * ellipse.half_height) {
        // The centres lie inside every tangent, moved inwards by the radius.
        constexpr int kTangents = 1024;
        for (int k = 1; k <= kTangents; ++k) {
            const double t = kPi / 2 * k / kTangents;
            const dvec2 point(ellipse.half_width * std::sin(t), ellipse.half_height * std::cos(t));
            const dvec2 normal = normalize(
                dvec2(ellipse.half_height * std::sin(t), ellipse.half_width * std::cos(t)));
            tangents_.push_back({(dot(normal, point) - radius) / normal.x, normal.y / normal.x});
        }
    }

    /// The largest |x| at height `y`, negative where the disc does not fit.
    double half_chord(double y) const {
        y = std::abs(y);
        if (y > top_ + slack_)
            return -1;
        double x = tangents_[0].offset - tangents_[0].slope * y;
        for (const Tangent& t : tangents_)
            x = std::min(x, t.offset - t.slope * y);
        return x;
    }

    double top() const { return top_ + slack_; }

  private:
    struct Tangent {
        double offset, slope; ///< x ≤ offset − slope·y
    };
    std::vector<Tangent> tangents_;
    double top_, slack_;
};

/// Calls visit(y, first, last) with the sites x = (i + shift)·spacing, i = first … last, of each
/// row that fits; `origin` is the lattice's centre in units of the spacing.
template <class Visit>
void for_rows(const DiscInEllipse& room, double spacing, dvec2 origin, Visit visit) {
    const int rows = int(room.top() / (kRow * spacing)) + 2;
    for (int j = -rows; j <= rows; ++j) {
        const double y = spacing * (j * kRow - origin.y);
        const double half = room.half_chord(y) / spacing * (1 + kRounding);
        const double shift = 0.5 * (j & 1) - origin.x;
        const int first = int(std::ceil(-half - shift)), last = int(std::floor(half - shift));
        if (half >= 0 && last >= first)
            visit(y, shift, first, last);
    }
}

int count_sites(const DiscInEllipse& room, double spacing, dvec2 origin) {
    int count = 0;
    for_rows(room, spacing, origin,
             [&](double, double, int first, int last) { count += last - first + 1; });
    return count;
}

/// The widest spacing at which `fibres` sites fit; 0 if none does.
double widest_spacing(const DiscInEllipse& room, int fibres, dvec2 origin) {
    const double width = room.half_chord(0);
    if (room.top() < 0 || !(width > 0))
        return 0;
    double fits = 2 * width / fibres, too_wide = 4 * std::max(width, room.top());
    for (int halvings = 0; count_sites(room, fits, origin) < fibres; ++halvings) {
        too_wide = fits;
        fits /= 2;
        if (halvings == 8)
            return 0;
    }
    for (int step = 0; step < 50; ++step) {
        const double middle = 0.5 * (fits + too_wide);
        (count_sites(room, middle, origin) >= fibres ? fits : too_wide) = middle;
    }
    return fits;
}

/// `fibres` of the sites at the widest spacing: where several fit equally well at the rim, the
/// outermost mirror pairs are left out, and at most one site of the middle. Nothing if that would
/// need half a pair.
Lattice fill(const DiscInEllipse& room, SectionOutline outline, int fibres, dvec2 origin) {
    Lattice lattice{widest_spacing(room, fibres, origin), {}};
    if (lattice.spacing == 0)
        return {};
    std::vector<dvec2> middle, pairs; // of a pair, the one on the right
    for_rows(room, lattice.spacing, origin, [&](double y, double shift, int first, int last) {
        for (int i = first; i <= last; ++i)
            if (i + shift >= 0)
                (i + shift == 0 ? middle : pairs).push_back({lattice.spacing * (i + shift), y});
    });
    const auto inside_first = [&](dvec2 p, dvec2 q) {
        const dvec2 size(outline.half_width, outline.half_height);
        return length(p / size) < length(q / size) - kRounding;
    };
    std::stable_sort(middle.begin(), middle.end(), inside_first);
    std::stable_sort(pairs.begin(), pairs.end(), inside_first);
    const auto left = [&] { return fibres - int(middle.size()); };
    while (left() < 0 || left() % 2 != 0) {
        if (middle.empty())
            return {};
        middle.pop_back();
    }
    pairs.resize(left() / 2);
    lattice.sites = middle;
    for (dvec2 p : pairs)
        lattice.sites.insert(lattice.sites.end(), {p, {-p.x, p.y}});
    return lattice;
}

} // namespace

Lattice widest_lattice(SectionOutline outline, double radius, int fibres) {
    const DiscInEllipse room(outline, radius);
    if (fibres == 1)
        return room.half_chord(0) >= -kRounding * radius ? Lattice{HUGE_VAL, {{0, 0}}} : Lattice{};
    Lattice best;
    for (dvec2 origin : {kSite, kEdgeInRow, kBetweenRows, kTriangle}) {
        Lattice lattice = fill(room, outline, fibres, origin);
        if (lattice.spacing > best.spacing * (1 + kRounding))
            best = std::move(lattice);
    }
    return best;
}

PackingSymmetry packing_symmetry(int fibres) {
    if (fibres % 6 <= 1)
        return {6, kSite, fibres % 6 == 1};
    if (fibres % 3 == 0)
        return {3, kTriangle, false};
    if (fibres % 3 == 1)
        return {3, kSite, true};
    return fibres % 2 ? PackingSymmetry{2, kSite, true} : PackingSymmetry{2, kEdgeInRow, false};
}

std::vector<dvec2> innermost_orbits(const PackingSymmetry& symmetry, int fibres) {
    std::vector<dvec2> sector;
    const int reach = int(std::sqrt(double(fibres))) + 3;
    const double wedge = 2 * kPi / symmetry.order;
    for (int j = -reach; j <= reach; ++j)
        for (int i = -reach; i <= reach; ++i) {
            const dvec2 p(i + 0.5 * (j & 1) - symmetry.origin.x, j * kRow - symmetry.origin.y);
            const double angle = azimuth(glm::dvec3(p, 0));
            if (length(p) > kRounding && (angle < wedge - kRounding || angle > 2 * kPi - kRounding))
                sector.push_back(p);
        }
    std::stable_sort(sector.begin(), sector.end(),
                     [](dvec2 p, dvec2 q) { return length(p) < length(q) - kRounding; });
    sector.resize(fibres / symmetry.order);
    if (symmetry.centred)
        sector.insert(sector.begin(), dvec2(0));
    return sector;
}

} // namespace rapport
