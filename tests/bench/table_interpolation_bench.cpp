#include "materials/table/bin_reconstruction.h"
#include "materials/table/table_bsdf.h"

#include <algorithm>
#include <cstdio>
#include <exception>
#include <functional>
#include <string>

// How well a table answers for incidence between its nodes: the interpolant of TableBsdf, and a
// blend of the same nodes in place (bilinear, as TableBsdf weighs them), against a measurement of
// that incidence itself.
//     table_interpolation_bench HELD_OUT.bsdf NODES.bsdf …
// in pairs of partial tables, by `rapport vgsp CLOTH --side front --accuracy … --incidence θ,φ …`:
// incidence off the grid, and the four nodes of the grid round each. Prints per incidence the L2
// error over the mean (the measure of `--accuracy`, noise of both tables included), and the height
// of the highest bin of reflection and how far it stands from the reference's; then, for the chart,
// profiles: mean reflection over the angle round the warp, against the angle to the weft plane.

namespace rapport {
namespace {

float mean(const Rgb& c) { return (c.r + c.g + c.b) / 3; }

/// Stored intensity of a direction, as planes of both blocks.
struct Stored {
    std::vector<BinPlane> planes[2];
};

Stored stored(const BsdfTable& table, size_t direction) {
    Stored result;
    for (int block = 0; block < 2; ++block) {
        std::vector<Rgb> means;
        for (size_t bin = 0; bin < table.exits.bins(); ++bin)
            means.emplace_back(table.at(direction, block, bin, 0),
                               table.at(direction, block, bin, 1),
                               table.at(direction, block, bin, 2));
        result.planes[block] = reconstruct(table.exits, means);
    }
    return result;
}

/// Intensity, mean of the bands, of light leaving along a direction: z > 0 is reflection.
using Intensity = std::function<double(const glm::vec3&)>;

Intensity intensity_of(const Stored& of, const BinLookup& lookup) {
    return [&](const glm::vec3& out) {
        const BinPosition place = lookup.locate(out);
        return mean(of.planes[out.z > 0 ? 0 : 1][place.bin].at(place));
    };
}

/// The full grid, 0 where `nodes` has no direction.
BsdfTable spread_over_grid(const BsdfTable& nodes) {
    BsdfTable full = make_full_table(nodes.bands, true, true);
    const size_t size = 2 * full.exits.bins() * full.bands.count();
    for (size_t from = 0; from < nodes.directions(); ++from)
        for (size_t to = 0; to < full.directions(); ++to) {
            const IncidentDirection &a = nodes.incident[from], &b = full.incident[to];
            if (a.side == b.side && std::abs(a.theta - b.theta) < 1e-6 &&
                (std::abs(a.phi - b.phi) < 1e-6 || a.theta == 0))
                std::copy_n(&nodes.intensity[from * size], size, &full.intensity[to * size]);
        }
    return full;
}

struct Corner {
    size_t node;
    double weight;
};

std::vector<Corner> corners(const BsdfTable& grid, const IncidentDirection& at) {
    const auto interval = [](const std::vector<double>& axis, double x) {
        return static_cast<size_t>(std::upper_bound(axis.begin(), axis.end(), x) - axis.begin() -
                                   1);
    };
    const size_t t = interval(grid.grid_theta, at.theta), p = interval(grid.grid_phi, at.phi);
    const size_t phis = grid.grid_phi.size();
    const double s =
        (at.theta - grid.grid_theta[t]) / (grid.grid_theta[t + 1] - grid.grid_theta[t]);
    const double u = (at.phi - grid.grid_phi[p]) / grid.grid_phi[1];
    const auto node = [&](size_t i, size_t j) { return grid.grid_index[i * phis + j % phis]; };
    return {{node(t, p), (1 - s) * (1 - u)},
            {node(t, p + 1), (1 - s) * u},
            {node(t + 1, p), s * (1 - u)},
            {node(t + 1, p + 1), s * u}};
}

struct Error {
    double l2, peak, peak_offset; ///< over the mean; over the reference's; degrees
};

/// Bin means of `f`, both blocks in turn, by midpoints.
std::vector<double> bin_means(const DirectionMesh& mesh, const BinLookup& lookup,
                              const Intensity& f) {
    constexpr int kSteps = 4;
    std::vector<double> means;
    for (const float side : {1.0f, -1.0f})
        for (uint32_t bin = 0; bin < mesh.bins(); ++bin) {
            double sum = 0;
            for (int i = 0; i < square(kSteps); ++i) {
                glm::vec3 out = lookup.direction({bin, (2 * (i / kSteps) + 1.0f) / kSteps - 1,
                                                  (2 * (i % kSteps) + 1.0f) / kSteps - 1});
                out.z *= side;
                sum += f(out);
            }
            means.push_back(sum / square(kSteps));
        }
    return means;
}

Error compare(const DirectionMesh& mesh, const BinLookup& lookup, const std::vector<double>& f,
              const std::vector<double>& reference) {
    const auto bins = static_cast<std::ptrdiff_t>(mesh.bins());
    double flux = 0, squares = 0;
    for (size_t i = 0; i < f.size(); ++i) {
        const double solid_angle = mesh.solid_angle(i % mesh.bins());
        flux += solid_angle * reference[i];
        squares += solid_angle * square(f[i] - reference[i]);
    }
    const auto highest = [&](const std::vector<double>& of) {
        return std::max_element(of.begin(), of.begin() + bins) - of.begin();
    };
    const auto centre = [&](std::ptrdiff_t bin) {
        return lookup.direction({static_cast<uint32_t>(bin), 0, 0});
    };
    const auto here = highest(f), there = highest(reference);
    const double cosine = std::min(glm::dot(centre(here), centre(there)), 1.0f);
    return {std::sqrt(4 * kPi * squares) / flux, f[here] / reference[there],
            degrees(std::acos(cosine))};
}

double profile(const Intensity& f, double angle) {
    constexpr int kSteps = 180;
    double sum = 0;
    for (int i = 0; i < kSteps; ++i) {
        const double round = kPi * ((i + 0.5) / kSteps - 0.5);
        sum += f({std::cos(angle) * std::sin(round), std::sin(angle),
                  std::cos(angle) * std::cos(round)});
    }
    return sum / kSteps;
}

void run(const std::string& held_out_path, const std::string& nodes_path) {
    const BsdfTable held_out = read_table(held_out_path);
    const BsdfTable grid = spread_over_grid(read_table(nodes_path));
    const DirectionMesh& mesh = grid.exits;
    const BinLookup lookup(mesh);
    const TableBsdf bsdf(grid, nodes_path);
    std::printf("%s (accuracy %.3f)\n", held_out_path.c_str(), held_out.largest_accuracy());
    std::printf("  theta   phi |   L2: blend  moved | peak: blend  moved | off by: blend  moved\n");
    double total[2] = {0, 0};
    for (size_t d = 0; d < held_out.directions(); ++d) {
        const IncidentDirection& at = held_out.incident[d];
        const glm::vec3 eye(spherical_direction(at.theta, at.phi));
        const Stored reference_planes = stored(held_out, d);
        const Intensity reference = intensity_of(reference_planes, lookup);
        std::vector<Stored> nodes;
        const std::vector<Corner> around = corners(grid, at);
        for (const Corner& corner : around)
            nodes.push_back(stored(grid, corner.node));
        const Intensity blend = [&](const glm::vec3& out) {
            double sum = 0;
            for (size_t k = 0; k < nodes.size(); ++k)
                sum += around[k].weight * intensity_of(nodes[k], lookup)(out);
            return sum;
        };
        const Intensity moved = [&](const glm::vec3& out) { return mean(bsdf.eval(eye, out)); };

        const std::vector<double> truth = bin_means(mesh, lookup, reference);
        const Error a = compare(mesh, lookup, bin_means(mesh, lookup, blend), truth);
        const Error b = compare(mesh, lookup, bin_means(mesh, lookup, moved), truth);
        total[0] += square(a.l2);
        total[1] += square(b.l2);
        const double theta = degrees(at.theta), phi = degrees(at.phi);
        std::printf("  %5.1f %5.1f |   %9.3f %6.3f | %11.2f %6.2f | %12.1f° %5.1f°\n", theta, phi,
                    a.l2, b.l2, a.peak, b.peak, a.peak_offset, b.peak_offset);
        for (int angle = -88; angle <= 88; angle += 1)
            std::printf("profile %s %g %g %d %g %g %g\n", held_out_path.c_str(), theta, phi, angle,
                        profile(reference, radians<double>(angle)),
                        profile(blend, radians<double>(angle)),
                        profile(moved, radians<double>(angle)));
    }
    const auto count = static_cast<double>(held_out.directions());
    std::printf("  rms         |   %9.3f %6.3f\n", std::sqrt(total[0] / count),
                std::sqrt(total[1] / count));
}

} // namespace
} // namespace rapport

int main(int count, char** arguments) {
    if (count < 3 || count % 2 == 0) {
        std::fprintf(stderr, "usage: table_interpolation_bench HELD_OUT.bsdf NODES.bsdf ...\n");
        return 2;
    }
    try {
        for (int i = 1; i < count; i += 2)
            rapport::run(arguments[i], arguments[i + 1]);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "table_interpolation_bench: %s\n", error.what());
        return 2;
    }
}
