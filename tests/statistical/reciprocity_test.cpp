#include "vgsp/incident_path.h"

#include "renderer/core/parallel.h"
#include "tests/support/fibre_assemblies.h"
#include "tests/support/long_run.h"
#include "tests/support/scattering.h"

#include <gtest/gtest.h>

// Helmholtz reciprocity of the whole sphere of directions, both sides of the cloth. Directions are
// sorted into cells; with incidence drawn ∝ cosθ dω within cell i, A_i = ∫ cosθ dω over it and P_ij
// the share of the light that leaves into cell j, A_i·P_ij = A_j·P_ji in expectation. The
// differences, each over its own standard error, make a χ² test.

namespace rapport {
namespace {

using kernel::FibreTracer;

/// Cells of a hemisphere, those of the back after the front's: they chart y and the angle ψ round
/// it from the plane x = 0, dω = dy dψ and cosθ = √(1 − y²)·cosψ.
const DirectionMesh kMesh(6, 4);
const ExitBins kCells(kMesh, {0, 0, 1});
constexpr int kMaxEvents = 4096;

struct Cell {
    Side side;
    DirectionMesh::Bounds bounds;
    /// ∫ cosθ dω
    double projected() const {
        const auto half_disc = [](double y) {
            return 0.5 * (y * std::sqrt((1 - y) * (1 + y)) + std::asin(y));
        };
        return (half_disc(bounds.u_high) - half_disc(bounds.u_low)) *
               (std::sin(bounds.v_high * kPi / 2) - std::sin(bounds.v_low * kPi / 2));
    }
    IncidentDirection draw(CounterRng& rng) const {
        double y = 0;
        do
            y = std::lerp(bounds.u_low, bounds.u_high, rng.uniform());
        while (square(rng.uniform()) > (1 - y) * (1 + y));
        const double sine = std::lerp(std::sin(bounds.v_low * kPi / 2),
                                      std::sin(bounds.v_high * kPi / 2), rng.uniform());
        const double across = std::sqrt((1 - y) * (1 + y));
        const glm::dvec3 w(across * sine, y, across * std::sqrt((1 - sine) * (1 + sine)));
        return {side, std::acos(std::min(w.z, 1.0)), azimuth(w)};
    }
};

Cell cell(size_t i) {
    return {i < kMesh.bins() ? Side::front : Side::back, kMesh.bounds(i % kMesh.bins())};
}

/// The share of its light, and the direction, with which a path leaves; 0 where it does not.
struct Exit {
    double weight;
    glm::dvec3 direction;
};
using Trace = std::function<Exit(const IncidentDirection&, CounterRng&)>;

/// P_ij and the squares of its standard errors.
struct Exchange {
    std::vector<double> share, variance;
};

Exchange exchange(const Trace& trace, int paths_per_cell) {
    const size_t cells = 2 * kMesh.bins();
    Exchange result{std::vector<double>(cells * cells), std::vector<double>(cells * cells)};
    parallel_for(cells, [&](size_t i) {
        const double n = paths_per_cell;
        double* const share = &result.share[i * cells];
        double* const variance = &result.variance[i * cells];
        for (int k = 0; k < paths_per_cell; ++k) {
            CounterRng rng(11, Purpose::test, i, k);
            const IncidentDirection incident = cell(i).draw(rng);
            const Exit exit = trace(incident, rng);
            const size_t j = (exit.direction.z > 0 ? 0 : kMesh.bins()) + kCells.bin(exit.direction);
            share[j] += exit.weight / n;
            variance[j] += square(exit.weight) / n;
        }
        for (size_t j = 0; j < cells; ++j)
            variance[j] = (variance[j] - square(share[j])) / n;
    });
    return result;
}

/// Pairs of cells that fewer paths than this connect say nothing that is normally distributed.
constexpr double kFewestPaths = 30;

tests::ChiSquareResult reciprocal(const Exchange& exchange, int paths_per_cell) {
    const size_t cells = 2 * kMesh.bins();
    tests::ChiSquareResult result;
    for (size_t i = 0; i < cells; ++i)
        for (size_t j = i + 1; j < cells; ++j) {
            const double there = exchange.share[i * cells + j],
                         back = exchange.share[j * cells + i];
            if ((there + back) * paths_per_cell < kFewestPaths)
                continue;
            const double from = cell(i).projected(), to = cell(j).projected();
            result.statistic += square(from * there - to * back) /
                                (square(from) * exchange.variance[i * cells + j] +
                                 square(to) * exchange.variance[j * cells + i]);
            ++result.degrees;
        }
    result.p_value = tests::upper_gamma(0.5 * result.degrees, 0.5 * result.statistic);
    return result;
}

const int kPaths = tests::long_run() ? 100'000 : 10'000; ///< to a cell

/// As the goniophotometer traces them.
tests::ChiSquareResult as_it_is(const FibreTracer& tracer, const std::vector<FibreOptics>& optics) {
    const std::vector<FibreMedium> media = fibre_media(optics, 1, tracer);
    const IncidentPathTracer paths{tracer, media, 1, kMaxEvents, true};
    return reciprocal(exchange(
                          [&](const IncidentDirection& incident, CounterRng& rng) {
                              IncidentPath path;
                              paths.trace(incident, rng, path);
                              const bool leaves = path.fate == PathFate::scattered ||
                                                  path.fate == PathFate::unscattered;
                              return Exit{leaves ? path.weight(0) : 0, path.light.direction};
                          },
                          kPaths),
                      kPaths);
}

/// Wrong: light meets another index on its way into a fibre than on its way out.
tests::ChiSquareResult one_way_fibres(const FibreTracer& tracer, double index_in,
                                      double index_out) {
    return reciprocal(exchange(
                          [&](const IncidentDirection& incident, CounterRng& rng) {
                              const glm::dvec2 cell = tracer.cell();
                              glm::dvec3 position(rng.uniform() * cell.x, rng.uniform() * cell.y,
                                                  incident.side == Side::front ? tracer.z_max()
                                                                               : tracer.z_min());
                              glm::dvec3 direction = -towards_light(incident);
                              uint32_t segment = FibreTracer::kNone;
                              bool inside = false;
                              for (int event = 0; event < kMaxEvents; ++event) {
                                  kernel::FibrePoint point;
                                  if (inside) {
                                      point = tracer.leave(position, direction, segment);
                                  } else {
                                      const auto entry = tracer.enter(position, direction, segment);
                                      if (entry.flight != FibreTracer::Flight::enters)
                                          return Exit{1, direction};
                                      point = entry.point;
                                  }
                                  const BoundaryEvent met =
                                      meet_boundary(direction, point.normal, inside,
                                                    inside ? index_out : index_in, rng.uniform());
                                  inside = inside != met.transmitted;
                                  position = point.position;
                                  direction = met.direction;
                                  segment = point.segment;
                              }
                              return Exit{0, direction};
                          },
                          kPaths),
                      kPaths);
}

TEST(Reciprocity, CellsHoldTheHemispheresProjectedArea) {
    double sum = 0;
    for (size_t i = 0; i < 2 * kMesh.bins(); ++i) {
        sum += cell(i).projected();
        CounterRng rng(1, Purpose::test, 0, i);
        const glm::dvec3 drawn = towards_light(cell(i).draw(rng));
        EXPECT_EQ((drawn.z > 0 ? 0 : kMesh.bins()) + kCells.bin(drawn), i);
    }
    EXPECT_NEAR(sum, 2 * kPi, 1e-12);
}

TEST(Reciprocity, OfAStackOfFibres) {
    const FibreTracer tracer(tests::fibre_stack(3, 10, 4.6, 2));
    const tests::ChiSquareResult clear = as_it_is(tracer, {{1.53, {0}, 0}});
    EXPECT_GT(clear.degrees, 500);
    EXPECT_GT(clear.p_value, 0.002);
    EXPECT_GT(as_it_is(tracer, {{1.53, {0.02}, 0.01}}).p_value, 0.002) << "dyed";
    EXPECT_GT(as_it_is(tracer, {{1.53, {0.02}, 0, 0.3}}).p_value, 0.002) << "rough";
    EXPECT_GT(one_way_fibres(tracer, 1.53, 1.53).p_value, 0.002) << "the twin, both ways alike";
    EXPECT_LT(one_way_fibres(tracer, 1.58, 1.53).p_value, 1e-6);
}

/// The warp is dyed and the weft is not, and the draft has neither mirrors nor a back like its
/// front.
TEST(Reciprocity, OfAWovenClothWithoutOverlaps) {
    const Cloth cloth =
        tests::cloth_of(named_weave("satin 5/2"), tests::loose_yarn(), tests::loose_yarn(50, 12));
    const MicroElement element = build_micro_element(cloth);
    ASSERT_EQ(element.overlap_fraction, 0);
    const FibreTracer tracer(element.fibres);
    const tests::ChiSquareResult result = as_it_is(tracer, {{1.53, {0.01}, 0}, {1.53, {0}, 0.01}});
    EXPECT_GT(result.degrees, 500);
    EXPECT_GT(result.p_value, 0.002);
    EXPECT_LT(one_way_fibres(tracer, 1.58, 1.53).p_value, 1e-6);
}

/// Where fibres overlap, light that leaves one inside another is set back to the other's surface;
/// nothing sets it forward on its way back. This is reported, not required.
TEST(Reciprocity, IsReportedWhereFibresOverlap) {
    const FibreTracer tracer(tests::winding_fibres());
    const tests::ChiSquareResult result = as_it_is(tracer, {{1.53, {0}, 0}});
    RecordProperty("chi_square", std::to_string(result.statistic));
    RecordProperty("degrees_of_freedom", result.degrees);
    RecordProperty("p_value", std::to_string(result.p_value));
    EXPECT_GT(result.degrees, 500);
}

} // namespace
} // namespace rapport
