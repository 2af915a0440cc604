#include "vgsp/fibre_scatter.h"

#include "renderer/core/math.h"

#include <algorithm>
#include <cmath>

namespace rapport {
namespace {

using glm::dvec2;

constexpr int kFewestWaves = 32;     ///< what makes a sum of waves look Gaussian
constexpr double kWidestDraw = 3;    ///< standard deviations
constexpr double kMargin = 2;        ///< standard deviations of migration to keep clear of others
constexpr int kSeparationSteps = 60; ///< more move nothing that has room
// Stray fibres, guesses after photographs of yarns: loops a few fibres high and yarns long.
constexpr double kMeanLoopHeight = 2, kHighestLoop = 6; ///< fibre diameters
constexpr double kLoopLength = 8;                       ///< half heights of the yarn

/// Two independent standard normal variates (Box and Muller 1958).
dvec2 normal_pair(CounterRng& rng) {
    const double radius = std::sqrt(-2 * std::log(rng.uniform()));
    const double angle = 2 * kPi * rng.uniform();
    return radius * dvec2(std::cos(angle), std::sin(angle));
}

/// cos(2π·turns) to within 2e-13 (for up to 10⁴ turns), without a branch so that the compiler makes
/// SIMD code of loops over it: sin of the angle's distance from the zero, by its Taylor series.
double cos_of_turns(double turns) {
    constexpr double kShift = 6755399441055744.0; // 1.5·2⁵²: adding it rounds to a whole number
    const double fraction = turns - ((turns + kShift) - kShift);
    const double x = 2 * kPi * (0.25 - std::abs(fraction));
    const double x2 = x * x;
    double series = 1;
    for (int n = 18; n >= 2; n -= 2)
        series = 1 - x2 * (1.0 / (n * (n + 1))) * series;
    return x * series;
}

double truncated_normal(CounterRng& rng) {
    for (;;)
        if (const double x = normal_pair(rng).x; std::abs(x) <= kWidestDraw)
            return x;
}

/// Whether the fibre lies in the centre of a packing that turns. It closes after every cell,
/// whatever the turn, and so must stay there.
bool is_core(const FibreSite& site, const SectionLayout& section) {
    return section.symmetry > 1 && site.position == dvec2(0);
}

/// The fibres of a yarn that lie in the section or single at the start of the cells, each with the
/// site that decides its place.
struct Copy {
    size_t site;
    int ply;
    double angle;
};

std::vector<Copy> all_copies(const std::vector<FibreSite>& sites, const SectionLayout& section) {
    std::vector<Copy> copies;
    for (size_t i = 0; i < sites.size(); ++i)
        for (const FibreSite::Turn& turn : sites[i].turns)
            copies.push_back(
                {i, int(std::lround(turn.in_ply * section.plies / (2 * kPi))), turn.in_single});
    return copies;
}

/// Moves fibres apart that are nearer than `clearance` times their radii, and those outside `room`
/// (of their surfaces) back in.
void separate(std::vector<FibreSite>& sites, const SectionLayout& section, double clearance,
              SectionOutline room) {
    const std::vector<Copy> copies = all_copies(sites, section);
    std::vector<dvec2> places(copies.size()), pushes(sites.size());
    for (int step = 0; step < kSeparationSteps; ++step) {
        for (size_t c = 0; c < copies.size(); ++c)
            places[c] = turned(sites[copies[c].site].position, copies[c].angle);
        pushes.assign(sites.size(), dvec2(0));
        bool moved = false;
        for (size_t c = 0; c < copies.size(); ++c)
            for (size_t d = 0; d < c; ++d) {
                if (copies[c].ply != copies[d].ply)
                    continue;
                FibreSite &a = sites[copies[c].site], &b = sites[copies[d].site];
                const dvec2 apart = places[c] - places[d];
                const double distance = length(apart);
                const double lack = clearance * (a.radius + b.radius) - distance;
                if (!(lack > 1e-3 * a.radius) || !(distance > 0))
                    continue;
                const dvec2 push = 0.5 * lack / distance * apart;
                pushes[copies[c].site] += turned(push, -copies[c].angle) / double(a.turns.size());
                pushes[copies[d].site] -= turned(push, -copies[d].angle) / double(b.turns.size());
                moved = true;
            }
        for (size_t i = 0; i < sites.size(); ++i) {
            if (is_core(sites[i], section))
                continue;
            dvec2& p = sites[i].position;
            p += pushes[i];
            const double wall = section.clearance * sites[i].radius;
            const dvec2 free = max(dvec2(room.half_width, room.half_height) - wall, dvec2(1e-9));
            if (const double reach = length(p / free); reach > 1)
                p /= reach, moved |= reach > 1 + 1e-3;
        }
        if (!moved)
            return;
    }
}

/// Makes fibres thinner that are still nearer than `clearance` times their radii, or reach out of
/// `room`: those that separate() found no place for.
void thin_out(std::vector<FibreSite>& sites, const SectionLayout& section, double clearance,
              SectionOutline room) {
    const std::vector<Copy> copies = all_copies(sites, section);
    std::vector<double> share(sites.size(), 1);
    for (size_t i = 0; i < sites.size(); ++i) {
        const dvec2& p = sites[i].position;
        const double reach = length(p / dvec2(room.half_width, room.half_height));
        if (reach > 0 && reach < 1) // what is left on the way out from the centre
            share[i] =
                std::min(1.0, length(p) * (1 / reach - 1) / (section.clearance * sites[i].radius));
    }
    for (size_t c = 0; c < copies.size(); ++c)
        for (size_t d = 0; d < c; ++d) {
            if (copies[c].ply != copies[d].ply)
                continue;
            const FibreSite &a = sites[copies[c].site], &b = sites[copies[d].site];
            const double room =
                distance(turned(a.position, copies[c].angle), turned(b.position, copies[d].angle)) /
                (clearance * (a.radius + b.radius));
            share[copies[c].site] = std::min(share[copies[c].site], room);
            share[copies[d].site] = std::min(share[copies[d].site], room);
        }
    for (size_t i = 0; i < sites.size(); ++i) {
        sites[i].radius *= share[i];
        sites[i].thinned = 1 - square(share[i]);
    }
}

/// Whether the fibre lies at the yarn's surface: within a fibre diameter of its outline.
bool at_the_surface(const FibreSite& site, const SectionLayout& section) {
    const dvec2 p = section.plies == 1 ? site.position : dvec2(0, section.ply_ring) + site.position;
    const dvec2 size =
        dvec2(section.outline.half_width, section.outline.half_height) / section.stretch;
    return length(p / (size - 3 * site.radius)) > 1;
}

} // namespace

double StrayLoop::height_at(double s) const {
    return 0.5 * height * (1 - std::cos(2 * kPi * waves * s + phase));
}

MigrationField::MigrationField(double deviation, double along, double across, double period,
                               CounterRng& rng) {
    // The spectrum of the autocorrelation along the yarn, taken at the waves that fit the period.
    const double step = 2 * kPi / period;
    const int highest = int(std::ceil(4 / (along * step)));
    const int times = (kFewestWaves + highest) / (highest + 1);
    const auto power = [&](int k) {
        return (k == 0 ? 0.5 : 1.0) * std::exp(-0.5 * square(k * step * along));
    };
    double total = 0;
    for (int k = 0; k <= highest; ++k)
        total += power(k);
    for (int k = 0; k <= highest; ++k)
        for (int copy = 0; copy < times; ++copy) {
            const dvec2 wave_vector = normal_pair(rng) / (2 * kPi * across);
            const double direction = 2 * kPi * rng.uniform(), phase = rng.uniform();
            // A wave of amplitude A in a random direction has the variance A²/4 in each.
            const double amplitude = 2 * deviation * std::sqrt(power(k) / (total * times));
            waves_.along.push_back(k / period);
            waves_.across_x.push_back(wave_vector.x);
            waves_.across_y.push_back(wave_vector.y);
            waves_.phase.push_back(phase);
            waves_.amplitude.push_back(amplitude * dvec2(std::cos(direction), std::sin(direction)));
        }
}

dvec2 MigrationField::at(const dvec2& place, double s) const {
    constexpr size_t kChunk = 16;
    dvec2 sum(0);
    for (size_t first = 0; first < waves_.phase.size(); first += kChunk) {
        const size_t count = std::min(kChunk, waves_.phase.size() - first);
        double cosine[kChunk];
        for (size_t i = 0; i < count; ++i)
            cosine[i] =
                cos_of_turns(waves_.along[first + i] * s + waves_.across_x[first + i] * place.x +
                             waves_.across_y[first + i] * place.y + waves_.phase[first + i]);
        for (size_t i = 0; i < count; ++i)
            sum += cosine[i] * waves_.amplitude[first + i];
    }
    return sum;
}

double migration_width(const SectionOutline& outline) {
    return 2 * std::sqrt(outline.half_width * outline.half_height);
}

void scatter_fibres(std::vector<FibreSite>& sites, const SectionLayout& section,
                    const YarnSpec& yarn, double cell_length, CounterRng& rng) {
    const Irregularity& irregularity = yarn.irregularity;
    const double margin = kMargin * irregularity.migration_um;
    const double attainable =
        std::max(section.clearance, section.spacing / (2 * section.fibre_radius));
    const double wanted = section.clearance * (1 + margin / migration_width(section.outline));
    const double clearance = std::min(wanted, attainable);
    // Give way inwards, but leave neighbours the room that their migration needs.
    double reach = 0;
    for (const FibreSite& site : sites)
        reach = std::max(reach, length(site.position));
    const double narrowest = 2 * section.fibre_radius * clearance / section.spacing;
    const double given_way =
        reach > 0 ? reach * (1 - std::min(1.0, std::max(narrowest, 1 - margin / reach))) : 0;
    if (given_way > 0)
        for (FibreSite& site : sites)
            site.position *= 1 - given_way / reach;

    const SectionOutline room{section.inner.half_width - given_way,
                              section.inner.half_height - given_way};

    const double variation = yarn.fibre.diameter_variation;
    if (variation > 0 || irregularity.spacing_jitter_um > 0) {
        for (FibreSite& site : sites) {
            site.radius *= 1 + variation * truncated_normal(rng);
            if (!is_core(site, section))
                site.position += irregularity.spacing_jitter_um * normal_pair(rng);
        }
        separate(sites, section, clearance, room);
        separate(sites, section, section.clearance, room); // the last word, if there is no room
    }
    if (variation > 0 || irregularity.spacing_jitter_um > 0 || margin > 0)
        thin_out(sites, section, wanted, room);

    if (irregularity.stray_fibres > 0)
        for (FibreSite& site : sites) {
            if (!at_the_surface(site, section) || rng.uniform() >= irregularity.stray_fibres)
                continue;
            const double loops =
                std::round(cell_length / (kLoopLength * section.outline.half_height));
            const double height =
                std::min(-kMeanLoopHeight * std::log(rng.uniform()), kHighestLoop);
            site.loop = {2 * site.radius * height, std::max(loops, 1.0) / cell_length,
                         2 * kPi * rng.uniform()};
        }
}

} // namespace rapport
