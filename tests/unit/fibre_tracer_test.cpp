#include "renderer/kernel/fibre_tracer.h"

#include "renderer/core/rng.h"
#include "tests/support/brute_force_tracer.h"
#include "tests/support/fibre_assemblies.h"

#include <atomic>
#include <gtest/gtest.h>

namespace rapport {
namespace {

using kernel::FibreAssembly;
using kernel::FibrePoint;
using kernel::FibreSegment;
using kernel::FibreTracer;
using tests::BruteForceTracer;
using Flight = FibreTracer::Flight;

glm::dvec3 random_direction(CounterRng& rng) {
    const double z = 2 * rng.uniform() - 1, phi = 2 * kPi * rng.uniform();
    const double s = std::sqrt(1 - z * z);
    return {s * std::cos(phi), s * std::sin(phi), z};
}

double distance_to_face(const FibreTracer& tracer, const glm::dvec3& o, const glm::dvec3& d) {
    return ((d.z > 0 ? tracer.z_max() : tracer.z_min()) - o.z) / d.z;
}

struct SurfaceRay {
    glm::dvec3 origin, direction;
    uint32_t leaving;
};

/// From a uniform point of a random segment's surface, outwards; never so flat that brute force
/// would have to look through hundreds of periods.
SurfaceRay random_surface_ray(const FibreTracer& tracer, CounterRng& rng) {
    for (;;) {
        const auto number = static_cast<uint32_t>(rng.uniform() * tracer.segments().size());
        const FibreSegment& s = tracer.segments()[number];
        const auto frame = BasicFrame<double>::about(s.direction);
        const double phi = 2 * kPi * rng.uniform();
        const glm::dvec3 normal = std::cos(phi) * frame.x + std::sin(phi) * frame.y;
        const glm::dvec3 origin =
            s.start + s.direction * (s.length * rng.uniform()) + normal * s.radius;
        if (glm::dot(origin - s.start, s.start_normal) < 0 ||
            glm::dot(origin - s.start, s.end_normal) > s.end_offset)
            continue;
        const glm::dvec3 direction = random_direction(rng);
        if (glm::dot(direction, normal) > 0 && std::abs(direction.z) > 0.1)
            return {origin, direction, number};
    }
}

/// How many of `count` random rays the tracer and brute force disagree on, without overlaps.
int disagreements(const FibreTracer& tracer, const BruteForceTracer& reference, int count,
                  int& entered, int& overlaps) {
    int wrong = 0;
    for (int i = 0; i < count; ++i) {
        CounterRng rng(1, Purpose::test, 0, i);
        SurfaceRay ray = random_surface_ray(tracer, rng);
        const auto entry = tracer.enter(ray.origin, ray.direction, ray.leaving);
        if (entry.flight == Flight::enters && entry.overlap) {
            ++overlaps;
            continue;
        }
        const auto expected =
            reference.enter(ray.origin, ray.direction,
                            distance_to_face(tracer, ray.origin, ray.direction), ray.leaving);
        if (expected.has_value() != (entry.flight == Flight::enters)) {
            ++wrong;
        } else if (expected) {
            ++entered;
            glm::dvec3 apart = entry.point.position - expected->position;
            apart.x -= std::round(apart.x / tracer.cell().x) * tracer.cell().x;
            apart.y -= std::round(apart.y / tracer.cell().y) * tracer.cell().y;
            wrong += std::abs(entry.point.distance - expected->distance) > 1e-6 ||
                     glm::length(apart) > 1e-6;
        }
    }
    return wrong;
}

TEST(FibreTracer, AgreesWithBruteForceOnRandomRays) {
    const FibreAssembly assembly = tests::winding_fibres();
    const FibreTracer tracer(assembly);
    constexpr int kRays = 120000;
    int entered = 0, overlaps = 0;
    // Only rays that graze a surface within single precision may be decided differently.
    EXPECT_LE(disagreements(tracer, BruteForceTracer(assembly), kRays, entered, overlaps),
              kRays / 10000);
    EXPECT_GT(entered, kRays / 4);
    EXPECT_GT(overlaps, kRays / 100);

    FibreAssembly thinner = assembly;
    thinner.chains[2].radius *= 0.999;
    EXPECT_GT(disagreements(tracer, BruteForceTracer(thinner), kRays / 20, entered, overlaps), 100);
}

TEST(FibreTracer, FindsRaysFromFreeSpaceInCellsNarrowAndWide) {
    for (const FibreAssembly& assembly :
         {tests::reference_stack(1), tests::single_fibre(6, 1000), tests::winding_fibres()}) {
        const FibreTracer tracer(assembly);
        const BruteForceTracer reference(assembly);
        for (int i = 0; i < 2000; ++i) {
            CounterRng rng(2, Purpose::test, 0, i);
            glm::dvec3 d = random_direction(rng);
            if (std::abs(d.z) < 0.05)
                continue;
            const glm::dvec3 o(tracer.cell().x * (3 * rng.uniform() - 1),
                               tracer.cell().y * (3 * rng.uniform() - 1),
                               d.z > 0 ? tracer.z_min() - 5 : tracer.z_max() + 5);
            const auto entry = tracer.enter(o, d, FibreTracer::kNone);
            const auto expected =
                reference.enter(o, d, distance_to_face(tracer, o, d), FibreTracer::kNone);
            ASSERT_EQ(entry.flight, expected ? Flight::enters : Flight::leaves) << i;
            if (expected) {
                ASSERT_NEAR(entry.point.distance, expected->distance, 1e-6) << i;
                EXPECT_LT(glm::dot(entry.point.normal, d), 0);
            }
        }
    }
}

TEST(FibreTracer, OverlapIsFoundWhereThePointLiesInAnotherFibre) {
    const FibreAssembly assembly = tests::winding_fibres();
    const FibreTracer tracer(assembly);
    const BruteForceTracer reference(assembly);
    for (int i = 0; i < 20000; ++i) {
        CounterRng rng(3, Purpose::test, 0, i);
        const SurfaceRay ray = random_surface_ray(tracer, rng);
        const uint32_t chain = tracer.segments()[ray.leaving].chain;
        const auto entry = tracer.enter(ray.origin, ray.direction, ray.leaving);
        const bool overlap = entry.flight == Flight::enters && entry.overlap;
        ASSERT_EQ(overlap, reference.inside(ray.origin, chain)) << i;
        if (overlap) {
            EXPECT_LE(entry.point.distance, 0);
            EXPECT_LE(glm::dot(entry.point.normal, ray.direction), 1e-9);
            EXPECT_NE(tracer.segments()[entry.point.segment].chain, chain);
        }
    }
}

TEST(FibreTracer, TheSameChainInAnotherPeriodIsAnotherFibre) {
    // One chain, whose neighbours are its own copies, a little closer than they are thick.
    const FibreTracer tracer(FibreAssembly{{9.9, 50}, {{{{0, 0, 0}}, {0, 50, 0}, 5, 0}}});
    const auto entry = tracer.enter({5, 10, 0}, {0.6, 0, 0.8}, 0);
    ASSERT_EQ(entry.flight, Flight::enters);
    EXPECT_TRUE(entry.overlap);
    EXPECT_EQ(entry.point.segment, 0u);
}

TEST(FibreTracer, LeavesThroughTheSurfaceOfTheFibreItIsIn) {
    const FibreAssembly assembly = tests::winding_fibres();
    const FibreTracer tracer(assembly);
    for (int i = 0; i < 20000; ++i) {
        CounterRng rng(4, Purpose::test, 0, i);
        SurfaceRay ray = random_surface_ray(tracer, rng);
        ray.direction = -ray.direction;
        const FibrePoint exit = tracer.leave(ray.origin, ray.direction, ray.leaving);
        const FibreSegment& s = tracer.segments()[exit.segment];
        const glm::dvec3 o = exit.position - s.start;
        EXPECT_EQ(s.chain, tracer.segments()[ray.leaving].chain);
        EXPECT_NEAR(glm::length(glm::cross(o, s.direction)), s.radius, 1e-9);
        EXPECT_GE(glm::dot(o, s.start_normal), -1e-9);
        EXPECT_LE(glm::dot(o, s.end_normal), s.end_offset + 1e-9);
        EXPECT_NEAR(glm::length(exit.normal), 1, 1e-12);
        EXPECT_GE(glm::dot(exit.normal, ray.direction), -1e-9);
        // All of the way lies in that one fibre, what comes next does not.
        FibreAssembly alone{assembly.cell, {assembly.chains[s.chain]}};
        const BruteForceTracer fibre(alone);
        if (i % 20 == 0 && exit.distance > 1e-3) {
            for (const double share : {0.001, 0.3, 0.7, 0.999})
                EXPECT_TRUE(fibre.inside(ray.origin + ray.direction * (share * exit.distance)));
            EXPECT_FALSE(fibre.inside(ray.origin + ray.direction * (exit.distance + 1e-6)));
        }
    }
}

TEST(FibreTracer, SpecialRaysEnd) {
    const FibreTracer fibre(tests::single_fibre(6, 1000));
    // Through the axis at normal incidence.
    const auto entry = fibre.enter({500, 20, 50}, {0, 0, -1}, FibreTracer::kNone);
    ASSERT_EQ(entry.flight, Flight::enters);
    EXPECT_DOUBLE_EQ(entry.point.distance, 44);
    EXPECT_EQ(entry.point.normal, glm::dvec3(0, 0, 1));
    EXPECT_DOUBLE_EQ(fibre.leave(entry.point.position, {0, 0, -1}, 0).distance, 12);
    // From the cell's very corners and sides.
    for (const glm::dvec3& o : {glm::dvec3(0, 0, 6), glm::dvec3(1000, 60, 6), glm::dvec3(0, 60, 6)})
        EXPECT_EQ(fibre.enter(o, {0, 0, -1}, FibreTracer::kNone).flight, Flight::leaves);
    // Inside, along the axis: no surface, but an end.
    const FibrePoint end = fibre.leave({500, 0, 0}, {0, 1, 0}, 0);
    EXPECT_TRUE(std::isfinite(end.distance));
    EXPECT_GT(end.distance, 1e5);
    EXPECT_NEAR(glm::length(end.normal), 1, 1e-12);
    // Outside, along the axis; across it, just over it; and nothing that is not a number.
    EXPECT_EQ(fibre.enter({100, 0, 0}, {0, 1, 0}, FibreTracer::kNone).flight, Flight::lost);
    EXPECT_EQ(fibre.enter({100, 0, 6.01}, {1, 0, 0}, FibreTracer::kNone).flight, Flight::lost);
    EXPECT_EQ(fibre.enter({NAN, 0, 0}, {0, 0, 1}, FibreTracer::kNone).flight, Flight::lost);
    EXPECT_EQ(fibre.enter({0, 0, 0}, {0, NAN, 1}, FibreTracer::kNone).flight, Flight::lost);
    EXPECT_EQ(fibre.enter({1e300, 0, 0}, {0, 0, 1}, FibreTracer::kNone).flight, Flight::lost);
    // Nearly horizontal, it meets the fibre many periods away.
    const double slope = 1e-4;
    const glm::dvec3 d = glm::normalize(glm::dvec3(1, 0, -slope));
    const auto far = fibre.enter({510, 0, 6 + 3600 * slope}, d, FibreTracer::kNone);
    ASSERT_EQ(far.flight, Flight::enters);
    EXPECT_GT(far.point.distance, 2900);
}

TEST(FibreTracer, MovingTheWindowChangesNothing) {
    const glm::dvec3 moved(37.3, -81.9, 4);
    const FibreTracer tracer(tests::winding_fibres()), other(tests::winding_fibres(moved));
    int agree = 0;
    constexpr int kRays = 10000;
    for (int i = 0; i < kRays; ++i) {
        CounterRng rng(5, Purpose::test, 0, i);
        const SurfaceRay ray = random_surface_ray(tracer, rng);
        const auto a = tracer.enter(ray.origin, ray.direction, ray.leaving);
        const auto b = other.enter(ray.origin + moved, ray.direction, ray.leaving);
        agree +=
            a.flight == b.flight && a.overlap == b.overlap &&
            (a.flight != Flight::enters || (a.point.segment == b.point.segment &&
                                            std::abs(a.point.distance - b.point.distance) < 1e-6));
    }
    EXPECT_GE(agree, kRays - 5);
}

TEST(FibreTracer, StopsWhenToldTo) {
    std::atomic<int> asked = 0;
    EXPECT_THROW(FibreTracer(tests::reference_stack(), [&] { return ++asked > 1; }), Stopped);
    EXPECT_NO_THROW(FibreTracer(tests::reference_stack(), [] { return false; }));
}

TEST(FibreTracer, RefusesAnEmptyAssembly) {
    EXPECT_THROW(FibreTracer(FibreAssembly{{10, 10}, {}}), std::invalid_argument);
    EXPECT_THROW(FibreTracer(FibreAssembly{{10, 10}, {{{{0, 0, 0}}, {15, 0, 0}, 1, 0}}}),
                 std::invalid_argument);
}

} // namespace
} // namespace rapport
