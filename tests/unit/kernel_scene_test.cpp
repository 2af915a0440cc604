#include "renderer/kernel/scene.h"

#include "renderer/core/rng.h"

#include <gtest/gtest.h>

namespace rapport {
namespace {

using kernel::Hit;
using kernel::Ray;
using kernel::Scene;

const std::vector<glm::vec3> kSquare{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
const std::vector<glm::uvec3> kTriangles{{0, 1, 2}, {0, 2, 3}};
constexpr float kInfinity = std::numeric_limits<float>::infinity();

TEST(KernelScene, FindsTheNearestTriangleAndWhereItIsHit) {
    Scene scene;
    EXPECT_EQ(scene.add_triangles(kSquare, kTriangles), 0u);
    std::vector<glm::vec3> higher = kSquare;
    for (glm::vec3& p : higher)
        p.z = 2;
    EXPECT_EQ(scene.add_triangles(higher, kTriangles), 1u);
    scene.commit();

    const glm::vec3 target(0.7f, 0.2f, 0);
    const auto hit = scene.intersect({target + glm::vec3(0, 0, 1), {0, 0, -2}});
    ASSERT_TRUE(hit);
    EXPECT_FLOAT_EQ(hit->t, 0.5f);
    EXPECT_EQ(hit->geometry, 0u);
    EXPECT_EQ(hit->primitive, 0u);
    EXPECT_EQ(hit->geometric_normal, glm::vec3(0, 0, 1));
    const glm::vec3 point =
        (1 - hit->u - hit->v) * kSquare[0] + hit->u * kSquare[1] + hit->v * kSquare[2];
    EXPECT_NEAR(glm::length(point - target), 0, 1e-6);

    // From below the normal stays that of the triangle; the interval decides which one is met.
    const Ray up{{0.2f, 0.7f, -1}, {0, 0, 1}};
    EXPECT_EQ(scene.intersect(up)->geometry, 0u);
    EXPECT_EQ(scene.intersect(up)->geometric_normal, glm::vec3(0, 0, 1));
    EXPECT_EQ(scene.intersect({up.org, up.dir, 1.5f})->geometry, 1u);
    EXPECT_FALSE(scene.intersect({up.org, up.dir, 0, 0.5f}));
    EXPECT_EQ(scene.bounds().first, glm::vec3(0));
    EXPECT_EQ(scene.bounds().second, glm::vec3(1, 1, 2));
}

TEST(KernelScene, RaysThatAreNoneMiss) {
    Scene scene;
    scene.add_triangles(kSquare, kTriangles);
    scene.commit();
    const glm::vec3 org(0.5f, 0.25f, 1), down(0, 0, -1);
    ASSERT_TRUE(scene.intersect({org, down}));
    EXPECT_TRUE(scene.intersect({org, down, -1})); // as from 0
    for (const Ray& ray : {Ray{{NAN, 0, 0}, down}, Ray{org, {0, NAN, -1}}, Ray{org, down, NAN},
                           Ray{org, down, 0, NAN}, Ray{{0, 0, kInfinity}, down},
                           Ray{{0, 0, 1e30f}, down}, Ray{org, {0, 0, -kInfinity}},
                           Ray{org, down, 2, 1}, Ray{org, down, 0, -1}, Ray{org, {0, 0, 0}}}) {
        EXPECT_FALSE(scene.intersect(ray));
        // In a packet they do not disturb their neighbours.
        const auto met = scene.intersect(std::vector{Ray{org, down}, ray, Ray{org, down}});
        EXPECT_TRUE(met[0] && met[2]);
        EXPECT_FALSE(met[1]);
        EXPECT_FALSE(met[3]);
    }
}

TEST(KernelScene, NothingSlipsThroughSharedEdges) {
    // A fan of triangles about a point that is not aimed at.
    std::vector<glm::vec3> positions{{0.1f, 0.2f, 0}};
    std::vector<glm::uvec3> triangles;
    constexpr uint32_t kSpokes = 17;
    for (uint32_t i = 0; i < kSpokes; ++i) {
        const float angle = float(2 * kPi * i / kSpokes);
        positions.push_back({std::cos(angle), std::sin(angle), 0});
        triangles.push_back({0, 1 + i, 1 + (i + 1) % kSpokes});
    }
    Scene scene;
    scene.add_triangles(positions, triangles);
    scene.commit();
    for (int i = 0; i < 20000; ++i) {
        CounterRng rng(0, Purpose::test, 0, i);
        const glm::vec3& spoke = positions[1 + i % kSpokes];
        const glm::vec3 target = glm::mix(positions[0], spoke, 0.05f + 0.9f * rng.uniform_float());
        const glm::vec3 from(rng.uniform_float() - 0.5f, rng.uniform_float() - 0.5f, 1);
        const Ray ray{from, target - from};
        EXPECT_TRUE(scene.intersect(ray)) << i;
        EXPECT_TRUE(scene.intersect(std::span(&ray, 1))[0]) << i;
    }
}

// By whichever way, the same triangle at the same place; but for ties, which random rays have none
// of.
TEST(KernelScene, APacketMeetsWhatItsRaysMeetAlone) {
    CounterRng rng(0, Purpose::test, 0, 0);
    const auto anywhere = [&] {
        const float x = rng.uniform_float(), y = rng.uniform_float();
        return glm::vec3(x, y, rng.uniform_float());
    };
    std::vector<glm::vec3> positions;
    std::vector<glm::uvec3> triangles;
    for (uint32_t i = 0; i < 300; i += 3) {
        const glm::vec3 corner = anywhere();
        for (int k = 0; k < 3; ++k)
            positions.push_back(corner + 0.2f * anywhere());
        triangles.push_back({i, i + 1, i + 2});
    }
    Scene scene;
    scene.add_triangles(positions, triangles);
    scene.commit();
    int met = 0;
    for (int packet = 0; packet < 2000; ++packet) {
        std::vector<Ray> rays(1 + packet % kernel::Packet<Ray>{}.size());
        for (Ray& ray : rays) { // some of one bundle, some in all directions
            ray.org = 3.0f * anywhere() - 1.0f;
            ray.dir = packet % 2 == 0 ? glm::vec3(0.5f) - ray.org : anywhere() - 0.5f;
        }
        const auto hits = scene.intersect(rays);
        for (size_t i = 0; i < rays.size(); ++i) {
            const auto alone = scene.intersect(rays[i]);
            ASSERT_EQ(hits[i].has_value(), alone.has_value());
            if (!alone)
                continue;
            ++met;
            EXPECT_EQ(hits[i]->primitive, alone->primitive);
            EXPECT_NEAR(hits[i]->t, alone->t, 1e-5f * alone->t);
            EXPECT_NEAR(hits[i]->u, alone->u, 1e-4f);
            EXPECT_NEAR(hits[i]->v, alone->v, 1e-4f);
            EXPECT_NEAR(glm::dot(hits[i]->geometric_normal, alone->geometric_normal), 1, 1e-5f);
        }
    }
    EXPECT_GT(met, 1000);
}

TEST(KernelScene, EmptyScenesAndMeshesAreNoTrouble) {
    Scene scene;
    scene.add_triangles({}, {});
    scene.commit();
    EXPECT_FALSE(scene.intersect({{0, 0, 0}, {0, 0, 1}}));
    const std::vector<glm::uvec3> beyond{{0, 1, 4}};
    EXPECT_THROW(scene.add_triangles(kSquare, beyond), std::invalid_argument);
}

} // namespace
} // namespace rapport
