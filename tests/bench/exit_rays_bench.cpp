#include "renderer/core/parallel.h"
#include "renderer/core/rng.h"
#include "vgsp/incident_path.h"
#include "vgsp/measure_cloth.h"

#include <cstdio>
#include <cstdlib>
#include <exception>

// The raw exits of a cloth's light, for comparing ways to table them:
//     exit_rays_bench CLOTH.toml front|back OUT.rays PATHS_PER_NODE PATHS_PER_HELD_OUT
// for six directions of incidence on that side drawn at random (θ up to 80°, uniform in cosθ;
// nothing was tuned on them) and for the nodes round each of them of the table's grid and of a grid
// twice as coarse. charts/parameterisation.py reads what it writes: first the yarns about whose
// cone a table would chart the exits (0 warp, 1 weft), then for each direction θ and φ [rad], the
// numbers of paths and of exits (doubles), and of each exit x, y, z towards the side of incidence
// and the mean weight of the bands (floats); the held-out directions come last.

namespace rapport {
namespace {

constexpr int kHeldOut = 6;

std::vector<IncidentDirection> held_out(Side side) {
    std::vector<IncidentDirection> directions;
    CounterRng rng(11, Purpose::test, 0, 0);
    for (int i = 0; i < kHeldOut; ++i) {
        const double cosine = std::lerp(std::cos(radians(80.0)), 1.0, rng.uniform());
        directions.push_back({side, std::acos(cosine), 2 * kPi * rng.uniform()});
    }
    return directions;
}

/// Adds the corners of the cell of every `stride`-th node that `at` lies in.
void add_corners(std::vector<IncidentDirection>& nodes, const IncidentDirection& at,
                 const BsdfTable& grid, size_t stride) {
    const auto first = [&](const std::vector<double>& axis, double x) {
        const auto above = std::upper_bound(axis.begin(), axis.end(), x) - axis.begin();
        return static_cast<size_t>(above - 1) / stride * stride;
    };
    const size_t t = first(grid.grid_theta, at.theta), p = first(grid.grid_phi, at.phi);
    const size_t first_node =
        at.side == Side::front ? 0 : grid.grid_theta.size() * grid.grid_phi.size();
    for (const size_t i : {t, t + stride})
        for (const size_t j : {p, (p + stride) % grid.grid_phi.size()}) {
            const auto& node =
                grid.incident[grid.grid_index[first_node + i * grid.grid_phi.size() + j]];
            if (std::ranges::none_of(nodes, [&](const IncidentDirection& other) {
                    return other.theta == node.theta && other.phi == node.phi;
                }))
                nodes.push_back(node);
        }
}

void run(const char* cloth_path, Side side, const char* out_path, uint64_t paths,
         uint64_t held_out_paths) {
    const Cloth cloth = read_cloth(cloth_path);
    const kernel::FibreTracer tracer(build_micro_element(cloth).fibres);
    const std::vector<FibreMedium> media =
        fibre_media(cloth_optics(cloth, tracer, {}).fibres, cloth.bands.count(), tracer);
    const IncidentPathTracer path_tracer{tracer, media, cloth.bands.count(), 4096, true};
    const BsdfTable grid = make_full_table(cloth.bands, side == Side::front, side == Side::back);
    std::vector<IncidentDirection> directions;
    for (const IncidentDirection& at : held_out(side))
        for (const size_t stride : {1, 2})
            add_corners(directions, at, grid, stride);
    const size_t nodes = directions.size();
    for (const IncidentDirection& at : held_out(side))
        directions.push_back(at);

    std::vector<std::vector<float>> exits(directions.size());
    const auto paths_of = [&](size_t d) { return d < nodes ? paths : held_out_paths; };
    parallel_for(directions.size(), [&](size_t d) {
        IncidentPath path;
        for (uint64_t k = 0; k < paths_of(d); ++k) {
            CounterRng rng(1, Purpose::test, d, k);
            path_tracer.trace(directions[d], rng, path);
            if (path.fate != PathFate::scattered)
                continue;
            double weight = 0;
            for (size_t band = 0; band < cloth.bands.count(); ++band)
                weight += path.weight(band) / static_cast<double>(cloth.bands.count());
            const glm::dvec3& w = path.light.direction;
            const double z = side == Side::front ? w.z : -w.z;
            for (const double value : {w.x, w.y, z, weight})
                exits[d].push_back(static_cast<float>(value));
        }
    });
    std::FILE* const out = std::fopen(out_path, "wb");
    if (!out)
        throw std::runtime_error(std::string("cannot write ") + out_path);
    const auto axis = static_cast<double>(facing_yarns(tracer)[static_cast<size_t>(side)]);
    std::fwrite(&axis, sizeof axis, 1, out);
    for (size_t d = 0; d < directions.size(); ++d) {
        const double head[] = {directions[d].theta, directions[d].phi,
                               static_cast<double>(paths_of(d)),
                               static_cast<double>(exits[d].size() / 4)};
        std::fwrite(head, sizeof head, 1, out);
        std::fwrite(exits[d].data(), sizeof(float), exits[d].size(), out);
    }
    std::fclose(out);
}

} // namespace
} // namespace rapport

int main(int count, char** arguments) {
    const std::string side = count == 6 ? arguments[2] : "";
    if (side != "front" && side != "back") {
        std::fprintf(stderr, "usage: exit_rays_bench CLOTH.toml front|back OUT.rays PATHS_PER_NODE "
                             "PATHS_PER_HELD_OUT\n");
        return 2;
    }
    try {
        rapport::run(arguments[1], side == "front" ? rapport::Side::front : rapport::Side::back,
                     arguments[3], std::strtoull(arguments[4], nullptr, 10),
                     std::strtoull(arguments[5], nullptr, 10));
    } catch (const std::exception& error) {
        std::fprintf(stderr, "exit_rays_bench: %s\n", error.what());
        return 2;
    }
}
