#include "renderer/scene/mesh/subdivision.h"

#include "renderer/core/error.h"
#include "renderer/core/parallel.h"
#include "renderer/scene/gltf/gltf.h"
#include "renderer/scene/mesh/limit_surface.h"
#include "renderer/scene/mesh/mesh_cleaning.h"
#include "renderer/scene/mesh/uv_scale.h"
#include "tests/support/control_meshes.h"
#include "tests/support/long_run.h"
#include "tests/support/shared_data.h"

#include <algorithm>
#include <cstring>
#include <functional>
#include <gtest/gtest.h>
#include <map>
#include <random>
#include <set>

namespace rapport {
namespace {

using namespace tests;

FileError refusal(const IndexedMesh& mesh, int level) {
    try {
        subdivide(mesh, options(level, true), "dress.glb: Body");
    } catch (const FileError& error) {
        return error;
    }
    return FileError("", "", "", "accepted");
}

std::string bytes(const TriangleMesh& mesh) {
    std::string all;
    const auto append = [&](const auto& values) {
        all.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(values[0]));
    };
    append(mesh.positions), append(mesh.normals), append(mesh.uvs), append(mesh.weft);
    append(mesh.warp), append(mesh.triangles);
    return all;
}

TEST(Subdivision, DerivativesEqualFiniteDifferences) {
    IndexedMesh mesh = sheet(6, [](float x, float y) { return 0.3f * x * y + 0.2f * x * x; });
    add_uvs(mesh, [](const glm::vec3& p) { return glm::vec2(p.x + p.y * p.y, p.y - 0.3f * p.x); });
    const std::vector<char> attached(mesh.position_index.size(), 0);
    const ControlMesh control = make_control_mesh(mesh, attached, {kPi, false});
    const LimitSurface surface(control);
    const float h = 1.0f / 4096;        // exact in the float parameters
    constexpr double kTolerance = 1e-7; // third derivatives below 1 times h² = 6e-8
    for (uint32_t t = 0; t < mesh.position_index.size(); ++t) {
        const glm::vec2 at(0.3125f, 0.25f);
        const glm::vec2 parameters[] = {at, at + glm::vec2(h, 0), at - glm::vec2(h, 0),
                                        at + glm::vec2(0, h), at - glm::vec2(0, h)};
        LimitPoint p[5];
        ASSERT_TRUE(surface.evaluate(t, parameters, p));
        EXPECT_LT(glm::distance(p[0].position_s, (p[1].position - p[2].position) / (2.0 * h)),
                  kTolerance);
        EXPECT_LT(glm::distance(p[0].position_t, (p[3].position - p[4].position) / (2.0 * h)),
                  kTolerance);
        EXPECT_LT(glm::distance(p[0].uv_s, (p[1].uv - p[2].uv) / (2.0 * h)), kTolerance);
        EXPECT_LT(glm::distance(p[0].uv_t, (p[3].uv - p[4].uv) / (2.0 * h)), kTolerance);
    }
}

TEST(Subdivision, PlaneHasConstantFrames) {
    IndexedMesh mesh = sheet(5, [](float, float) { return 0.0f; });
    // Sheared and scaled: x = 2u + v/2, y = v/4.
    add_uvs(mesh, [](const glm::vec3& p) { return glm::vec2((p.x - 2 * p.y) / 2, 4 * p.y); });
    SubdivisionReport report;
    const TriangleMesh result = subdivide(mesh, options(3, true), "plane", &report);
    EXPECT_EQ(result.triangles.size(), 9 * mesh.position_index.size());
    EXPECT_EQ(report.faces, mesh.position_index.size());
    EXPECT_EQ(report.mirrored + report.frames_repaired + report.unrefinable, 0u);
    for (size_t v = 0; v < result.positions.size(); ++v) {
        EXPECT_LT(glm::distance(result.normals[v], glm::vec3(0, 0, 1)), 1e-6f);
        EXPECT_LT(glm::distance(result.weft[v], glm::vec3(2, 0, 0)), 1e-5f);
        EXPECT_LT(glm::distance(result.warp[v], glm::vec3(0.5f, 0.25f, 0)), 1e-5f);
    }
}

TEST(Subdivision, FramesAreTheDerivativesAtEveryValence) {
    // With (u, v) = (x, y), ∂P/∂u must have (1, 0) and ∂P/∂v (0, 1) in x and y at every vertex.
    IndexedMesh mesh =
        sheet(9, [](float x, float y) { return 0.1f * std::sin(7 * x) * std::cos(5 * y); });
    add_uvs(mesh, [](const glm::vec3& p) { return glm::vec2(p); });
    const TriangleMesh result = subdivide(mesh, options(4, true), "sheet");
    for (size_t v = 0; v < result.positions.size(); ++v) {
        EXPECT_LT(glm::distance(glm::vec2(result.positions[v]), result.uvs[v]), 1e-6f);
        EXPECT_LT(glm::distance(glm::vec2(result.weft[v]), glm::vec2(1, 0)), 1e-4f);
        EXPECT_LT(glm::distance(glm::vec2(result.warp[v]), glm::vec2(0, 1)), 1e-4f);
        EXPECT_LT(std::abs(glm::dot(result.weft[v], result.normals[v])), 1e-4f);
        EXPECT_LT(std::abs(glm::dot(result.warp[v], result.normals[v])), 1e-4f);
    }
}

TEST(Subdivision, ClosedSurfacesStayClosedAtEveryLevel) {
    for (const bool seams : {false, true})
        for (int level = 1; level <= 5; ++level) {
            IndexedMesh mesh = icosahedron();
            if (seams)
                add_separate_uvs(mesh);
            const TriangleMesh result = subdivide(mesh, options(level, seams), "icosahedron");
            EXPECT_EQ(result.triangles.size(), size_t(20 * level * level));
            expect_closed_manifold(result);
            expect_sound(result);
        }
}

TEST(Subdivision, IcosahedronBecomesNearlyASphere) {
    const TriangleMesh result = subdivide(icosahedron(), options(4, false), "icosahedron");
    EXPECT_TRUE(result.weft.empty());
    EXPECT_TRUE(result.warp.empty());
    float nearest = 1e9f, farthest = 0;
    for (size_t v = 0; v < result.positions.size(); ++v) {
        const float radius = glm::length(result.positions[v]);
        nearest = std::min(nearest, radius), farthest = std::max(farthest, radius);
        EXPECT_GT(glm::dot(result.positions[v] / radius, result.normals[v]), 0.995f);
    }
    EXPECT_LT(farthest / nearest, 1.03f);
    // Loop's limit mask at valence 5, (1 − 5χ) V + χ Σ neighbours with χ = 1/(5 + 3/(8β)) and
    // β = (5/8 − (3/8 + cos(2π/5)/4)²)/5; the neighbours' mean is V/√5.
    const double beta = (0.625 - square(0.375 + std::cos(2 * kPi / 5) / 4)) / 5;
    const double chi = 1 / (5 + 3 / (8 * beta));
    const double cage = std::sqrt(1 + square(1.6180339887));
    const float expected = float(cage * (1 - 5 * chi + 5 * chi / std::sqrt(5.0)));
    EXPECT_NEAR(glm::length(result.positions[0]), expected, 1e-5);
}

TEST(Subdivision, SeamsDoubleVerticesWithEqualBits) {
    IndexedMesh mesh = icosahedron();
    add_separate_uvs(mesh);
    const TriangleMesh result = subdivide(mesh, options(4, true), "icosahedron");
    EXPECT_EQ(result.positions.size(), size_t(20 * 15));
    std::map<std::tuple<float, float, float>, glm::vec3> normal;
    for (size_t v = 0; v < result.positions.size(); ++v) {
        const glm::vec3 p = result.positions[v];
        const auto [found, is_new] = normal.try_emplace({p.x, p.y, p.z}, result.normals[v]);
        EXPECT_EQ(found->second, result.normals[v]);
    }
    EXPECT_EQ(normal.size(), size_t(12 + 30 * 3 + 20 * 3));
}

TEST(Subdivision, SharedUvsShareVertices) {
    IndexedMesh mesh = sheet(4, [](float, float) { return 0.0f; });
    add_uvs(mesh, [](const glm::vec3& p) { return glm::vec2(p); });
    EXPECT_EQ(subdivide(mesh, options(3, true), "sheet").positions.size(), size_t(13 * 13));
    // A corner with UVs of its own is a seam, unless the values are equal.
    IndexedMesh unwelded = mesh;
    unwelded.uvs.clear();
    for (glm::uvec3& t : unwelded.uv_index)
        for (int c = 0; c < 3; ++c) {
            unwelded.uvs.push_back(mesh.uvs[t[c]]);
            t[c] = static_cast<uint32_t>(unwelded.uvs.size()) - 1;
        }
    EXPECT_EQ(bytes(subdivide(unwelded, options(3, true), "sheet")),
              bytes(subdivide(mesh, options(3, true), "sheet")));
}

TEST(Subdivision, MirroredUvsReverseTheWeft) {
    IndexedMesh mesh = sheet(4, [](float, float) { return 0.0f; });
    add_uvs(mesh, [](const glm::vec3& p) { return glm::vec2(-p.x, p.y); });
    SubdivisionReport report;
    const TriangleMesh result = subdivide(mesh, options(2, true), "sheet", &report);
    EXPECT_EQ(report.mirrored, report.faces);
    for (size_t v = 0; v < result.positions.size(); ++v) {
        EXPECT_LT(glm::distance(result.weft[v], glm::vec3(1, 0, 0)), 1e-5f);
        EXPECT_LT(glm::distance(result.warp[v], glm::vec3(0, 1, 0)), 1e-5f);
    }
}

TEST(Subdivision, UvsThatFoldBackKeepSoundFrames) {
    // Left and right half show the same pattern, mirrored at x = 1/2: weft must not turn there.
    IndexedMesh mesh = sheet(4, [](float, float) { return 0.0f; });
    add_uvs(mesh, [](const glm::vec3& p) { return glm::vec2(std::abs(p.x - 0.5f), p.y); });
    SubdivisionReport report;
    const TriangleMesh result = subdivide(mesh, options(3, true), "sheet", &report);
    EXPECT_EQ(report.mirrored, report.faces / 2);
    EXPECT_EQ(report.frames_repaired, 0u);
    for (size_t v = 0; v < result.positions.size(); ++v) {
        EXPECT_LT(glm::distance(result.weft[v], glm::vec3(1, 0, 0)), 1e-4f);
        EXPECT_LT(glm::distance(result.warp[v], glm::vec3(0, 1, 0)), 1e-4f);
    }
}

TEST(Subdivision, SingularUvsTakeTheNearestFrame) {
    IndexedMesh mesh = sheet(6, [](float, float) { return 0.0f; });
    add_uvs(mesh, [](const glm::vec3& p) { return glm::vec2(p); });
    mesh.uvs.emplace_back(0.5f, 0.5f);
    for (const size_t t : {20u, 21u, 22u, 23u}) // a patch collapsed to one point of the pattern
        mesh.uv_index[t] = glm::uvec3(static_cast<uint32_t>(mesh.uvs.size()) - 1);
    SubdivisionReport report;
    const TriangleMesh result = subdivide(mesh, options(3, true), "sheet", &report);
    EXPECT_GT(report.frames_repaired, 0u);
    expect_sound(result);
}

TEST(Subdivision, WithoutUsableUvsThereIsNoCloth) {
    IndexedMesh mesh = icosahedron();
    EXPECT_STREQ(refusal(mesh, 2).what(),
                 "dress.glb: Body: expected UVs (TEXCOORD_0) for the cloth, found none");
    add_uvs(mesh, [](const glm::vec3&) { return glm::vec2(0.5f); });
    EXPECT_EQ(refusal(mesh, 2).expected, "UVs (TEXCOORD_0) that cover an area");
    expect_sound(subdivide(mesh, options(2, false), "icosahedron"));
    EXPECT_EQ(subdivide(mesh, options(2, false), "icosahedron").triangles.size(), 80u);
}

TEST(Subdivision, EveryValenceWorks) {
    for (const uint32_t valence : {3u, 4u, 5u, 6u, 7u, 8u, 20u, 50u, 256u}) {
        SubdivisionReport report;
        const TriangleMesh result =
            subdivide(spindle(valence), options(3, false), "spindle", &report);
        EXPECT_EQ(report.unrefinable, 0u) << valence;
        expect_closed_manifold(result);
        expect_sound(result);
        EXPECT_GT(result.normals[0].z, 0.999f); // the tip, by symmetry
    }
}

TEST(Subdivision, CrowdedVerticesKeepTheirFlatTriangles) {
    SubdivisionReport report;
    const TriangleMesh result = subdivide(spindle(1000), options(2, false), "spindle", &report);
    EXPECT_EQ(report.unrefinable, 2000u);
    expect_closed_manifold(result);
    expect_sound(result);
    // Beside them the surface is refined, and still there is no crack.
    IndexedMesh mesh = spindle(300);
    mesh.positions.push_back({0, 0, 3});
    mesh.position_index.push_back({0, 2, 302}); // a fin
    const TriangleMesh mixed = subdivide(mesh, options(3, false), "spindle", &report);
    EXPECT_EQ(report.unrefinable, 601u);
    EXPECT_EQ(mixed.triangles.size(), size_t(601 * 9));
}

TEST(Subdivision, SmallestMeshes) {
    IndexedMesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
    mesh.position_index = {{0, 1, 2}};
    EXPECT_EQ(subdivide(mesh, options(4, false), "triangle").triangles.size(), 16u);
    mesh.position_index.emplace_back(2, 1, 0); // its back: one interior vertex of valence 2 each
    SubdivisionReport report;
    EXPECT_EQ(subdivide(mesh, options(4, false), "pillow", &report).triangles.size(), 16u);
    EXPECT_EQ(report.dropped, 1u);
    mesh.position_index = {{0, 1, 2}, {1, 3, 2}};
    expect_sound(subdivide(mesh, options(4, false), "two triangles"));
    mesh.position_index = {{0, 0, 1}};
    EXPECT_TRUE(subdivide(mesh, options(4, false), "nothing").triangles.empty());
}

TEST(Subdivision, SheetsOnANonManifoldEdgeStillMeet) {
    // A sheet with a fin that stands on two of its inner edges, 4–5 and 5–6 in a row.
    IndexedMesh mesh = sheet(4, [](float x, float y) { return x * y; });
    const uint32_t a = 2 * 5 + 1, b = a + 1, c = b + 1;
    const auto base = static_cast<uint32_t>(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(),
                          {{0.25f, 0.5f, 2}, {0.5f, 0.5f, 2}, {0.75f, 0.5f, 2}});
    for (const glm::uvec3& t : {glm::uvec3(a, b, base), glm::uvec3(b, base + 1, base),
                                glm::uvec3(b, c, base + 1), glm::uvec3(c, base + 2, base + 1)})
        mesh.position_index.push_back(t);
    SubdivisionReport report;
    const TriangleMesh result = subdivide(mesh, options(4, false), "fin", &report);
    EXPECT_EQ(report.non_manifold_edges, 2u);
    EXPECT_EQ(report.unrefinable, 0u);
    expect_sound(result);
    // Merged by position, both edges carry three triangles at each of their four parts again.
    size_t triple = 0;
    const std::vector<glm::uvec3> triangles = topology(result);
    for_each_edge(edge_uses(triangles),
                  [&](std::span<const EdgeUse> edge) { triple += edge.size() == 3; });
    EXPECT_EQ(triple, 8u);
}

TEST(Subdivision, AnyTriangleSoupIsSurvived) {
    const uint32_t count = tests::long_run() ? 3000 : 300;
    for (uint32_t seed = 0; seed < count; ++seed) {
        std::mt19937 random(seed);
        IndexedMesh mesh;
        const uint32_t vertices = 4 + random() % 8;
        for (uint32_t v = 0; v < vertices; ++v)
            mesh.positions.emplace_back(random() % 4, random() % 4, random() % 4);
        for (uint32_t v = 0; v < 9; ++v)
            mesh.uvs.emplace_back(random() % 3, random() % 3);
        const uint32_t triangles = 1 + random() % 30;
        for (uint32_t t = 0; t < triangles; ++t) {
            mesh.position_index.emplace_back(random() % vertices, random() % vertices,
                                             random() % vertices);
            mesh.uv_index.emplace_back(random() % 9, random() % 9, random() % 9);
        }
        SubdivisionReport report;
        const TriangleMesh result = subdivide(mesh, options(3, false), "soup", &report);
        EXPECT_EQ(result.triangles.size(), 9 * report.faces);
        EXPECT_EQ(report.faces + report.dropped, triangles);
        expect_sound(result);
        expect_sound(flat_mesh(mesh));
    }
}

TEST(Subdivision, ThreadsDoNotMatter) {
    IndexedMesh mesh = sheet(20, [](float x, float y) { return std::sin(9 * x) * y; });
    add_uvs(mesh, [](const glm::vec3& p) { return glm::vec2(p.x * p.y, p.y); });
    std::set<std::string> results;
    for (const int threads : {1, 2, 7}) {
        set_thread_count(threads);
        results.insert(bytes(subdivide(mesh, options(3, true), "sheet")));
    }
    set_thread_count(0);
    EXPECT_EQ(results.size(), 1u);
}

TEST(FlatMesh, KeepsTrianglesAndSplitsAtSeams) {
    IndexedMesh mesh = icosahedron();
    const TriangleMesh smooth = flat_mesh(mesh);
    EXPECT_EQ(smooth.positions.size(), mesh.positions.size());
    for (size_t t = 0; t < mesh.position_index.size(); ++t)
        for (int c = 0; c < 3; ++c)
            EXPECT_EQ(smooth.positions[smooth.triangles[t][c]],
                      mesh.positions[mesh.position_index[t][c]]);
    for (size_t v = 0; v < smooth.positions.size(); ++v)
        EXPECT_GT(glm::dot(smooth.normals[v], glm::normalize(smooth.positions[v])), 0.9999f);
    add_separate_uvs(mesh);
    const TriangleMesh split = flat_mesh(mesh);
    EXPECT_EQ(split.positions.size(), 60u);
    EXPECT_EQ(split.normals[0], smooth.normals[0]); // averaged round the position
    for (size_t t = 0; t < split.triangles.size(); ++t) {
        const glm::uvec3 corner = split.triangles[t];
        const glm::vec3 side = split.positions[corner.y] - split.positions[corner.x];
        EXPECT_LT(glm::distance(split.weft[corner.x], side), 1e-5f); // u grows by 1 along it
    }
}

TEST(FlatMesh, NormalsOfTheFileStandOnTheFaceSide) {
    IndexedMesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    mesh.position_index = {{0, 1, 2}};
    mesh.normals = {{0, 0.6f, -0.8f}, {0, 0, 0}, {0, 0, 5}};
    mesh.normal_index = {{0, 1, 2}};
    const TriangleMesh result = flat_mesh(mesh);
    EXPECT_LT(glm::distance(result.normals[0], glm::vec3(0, -0.6f, 0.8f)), 1e-6f);
    EXPECT_EQ(result.normals[1], glm::vec3(0, 0, 1));
    EXPECT_EQ(result.normals[2], glm::vec3(0, 0, 1));
}

TEST(UvScale, IsThatOfMostOfTheSurface) {
    IndexedMesh mesh = sheet(10, [](float, float) { return 0.0f; });
    EXPECT_EQ(metres_per_uv(mesh), 0);
    add_uvs(mesh, [](const glm::vec3& p) { return 1000.0f * glm::vec2(p); }); // millimetres
    EXPECT_NEAR(metres_per_uv(mesh), 1e-3, 1e-8);
    add_uvs(mesh, [](const glm::vec3& p) { // a corner is squeezed
        return p.x + p.y < 0.5f ? glm::vec2(0.01f * p.x, p.y) : glm::vec2(2 * p.x, p.y / 2);
    });
    EXPECT_NEAR(metres_per_uv(mesh), 1, 1e-6);
}

float median_length(std::vector<glm::vec3> vectors) {
    const auto middle = vectors.begin() + static_cast<ptrdiff_t>(vectors.size() / 2);
    std::nth_element(vectors.begin(), middle, vectors.end(),
                     [](const auto& a, const auto& b) { return glm::dot(a, a) < glm::dot(b, b); });
    return glm::length(*middle);
}

TEST(Subdivision, SharedGarmentsWhoseUvsAreMetres) {
    RAPPORT_SHARED_DATA_OR_SKIP(data);
    for (const std::string name : {"dress-victor-iso-draped.glb", "blouse-iso.glb"}) {
        const GltfModel model = read_gltf(data / "gltf" / name);
        SubdivisionReport report;
        const TriangleMesh mesh =
            subdivide(model.parts.at(0).mesh, options(2, true), name, &report);
        EXPECT_NEAR(metres_per_uv(model.parts.at(0).mesh), 1, 0.03) << name;
        EXPECT_NEAR(median_length(mesh.weft), 1, 0.03) << name;
        EXPECT_NEAR(median_length(mesh.warp), 1, 0.03) << name;
        EXPECT_EQ(report.mirrored + report.unrefinable + report.dropped, 0u);
        expect_sound(mesh);
    }
}

TEST(Subdivision, SharedGarmentsWithMirroredUvs) {
    RAPPORT_SHARED_DATA_OR_SKIP(data);
    const auto share = [&](const std::string& name) {
        size_t faces = 0, mirrored = 0;
        for (const GltfPart& part : read_gltf(data / "gltf" / name).parts) {
            SubdivisionReport report;
            expect_sound(subdivide(part.mesh, options(1, true), name, &report));
            faces += report.faces, mirrored += report.mirrored;
        }
        return double(mirrored) / double(faces);
    };
    EXPECT_NEAR(share("Corset/Corset.gltf"), 0.29, 0.005);
    EXPECT_NEAR(share("leather_jacket.glb"), 0.999, 0.0005);
    EXPECT_NEAR(share("tshirt_lengan_pendek.glb"), 0.62, 0.005);
}

TEST(Subdivision, SharedBlouseWithAUvPerCornerIsTheSame) {
    RAPPORT_SHARED_DATA_OR_SKIP(data);
    const auto shape = [&](const std::string& name) {
        return subdivide(read_gltf(data / "gltf" / name).parts.at(0).mesh, options(2, true), name);
    };
    const TriangleMesh welded = shape("blouse-iso.glb");
    const TriangleMesh unwelded = shape("blouse-iso_unwelded-uv.glb");
    EXPECT_EQ(welded.positions.size(), unwelded.positions.size());
    EXPECT_EQ(welded.triangles.size(), unwelded.triangles.size());
}

} // namespace
} // namespace rapport
