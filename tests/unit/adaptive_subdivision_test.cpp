#include "renderer/scene/mesh/subdivision.h"

#include "renderer/scene/mesh/auto_uvs.h"
#include "renderer/scene/mesh/face_pattern.h"
#include "renderer/scene/mesh/limit_surface.h"
#include "renderer/scene/pbrt/pbrt_parser.h"
#include "renderer/scene/scene_builder.h"
#include "tests/support/control_meshes.h"
#include "tests/support/gltf_models.h"
#include "tests/support/long_run.h"

#include <algorithm>

// Faces that are cut as finely as they are seen, creases, and quads.

namespace rapport {
namespace {

using namespace tests;

/// Any number of pieces from 1 to `most` for an edge, by its place.
EdgeRate scattered_rate(uint32_t most, uint32_t seed) {
    return [most, seed](const glm::dvec3& a, const glm::dvec3& b) {
        const glm::dvec3 p = a + b;
        std::mt19937 random(
            seed + static_cast<uint32_t>(std::lround(1e4 * std::abs(p.x + 3 * p.y + 7 * p.z))));
        return 1 + static_cast<int>(random() % most);
    };
}

/// n × n cells, two consecutive triangles each.
IndexedMesh quad_sheet(uint32_t n, const std::function<float(float, float)>& height) {
    IndexedMesh mesh = sheet(n, height);
    mesh.position_index.clear();
    for (uint32_t j = 0; j < n; ++j)
        for (uint32_t i = 0; i < n; ++i) {
            const uint32_t a = j * (n + 1) + i, b = a + 1, c = b + n + 1, d = a + n + 1;
            mesh.position_index.emplace_back(a, b, c);
            mesh.position_index.emplace_back(a, c, d);
        }
    return mesh;
}

/// The cube |x|, |y|, |z| ≤ 1, two consecutive triangles to a face.
IndexedMesh quad_cube() {
    IndexedMesh mesh;
    for (int i = 0; i < 8; ++i)
        mesh.positions.emplace_back(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
    for (const glm::uvec4& q :
         {glm::uvec4(0, 2, 3, 1), glm::uvec4(4, 5, 7, 6), glm::uvec4(0, 1, 5, 4),
          glm::uvec4(2, 6, 7, 3), glm::uvec4(0, 4, 6, 2), glm::uvec4(1, 3, 7, 5)}) {
        mesh.position_index.emplace_back(q.x, q.y, q.z);
        mesh.position_index.emplace_back(q.x, q.z, q.w);
    }
    return mesh;
}

/// A normal of its own for each triangle.
void add_face_normals(IndexedMesh& mesh) {
    mesh.normals.clear();
    mesh.normal_index.clear();
    for (const glm::uvec3& t : mesh.position_index) {
        const auto& p = mesh.positions;
        mesh.normal_index.emplace_back(static_cast<uint32_t>(mesh.normals.size()));
        mesh.normals.push_back(glm::normalize(glm::cross(p[t.y] - p[t.x], p[t.z] - p[t.x])));
    }
}

TEST(AdaptiveSubdivision, UnequalNeighboursLeaveNoCracks) {
    const uint32_t count = long_run() ? 200 : 30;
    for (uint32_t seed = 0; seed < count; ++seed)
        for (const bool quads : {false, true})
            for (const bool seams : {false, true}) {
                IndexedMesh mesh = quads && !seams ? quad_cube() : icosahedron();
                if (seams)
                    add_separate_uvs(mesh);
                SubdivisionOptions options;
                options.rate = scattered_rate(9, seed);
                options.quads = quads;
                options.need_uvs = seams;
                const TriangleMesh result = subdivide(mesh, options, "solid");
                expect_closed_manifold(result);
                expect_sound(result);
            }
}

TEST(AdaptiveSubdivision, TooManyTrianglesAreCutCoarser) {
    SubdivisionOptions options;
    options.rate = uniform_rate(16); // 5120 triangles
    SubdivisionReport report;
    for (const auto& [most, triangles] : {std::pair{5120, 5120}, {5119, 1280}, {1000, 320}}) {
        options.max_triangles = static_cast<size_t>(most);
        const TriangleMesh result = subdivide(icosahedron(), options, "solid", &report);
        EXPECT_EQ(result.triangles.size(), static_cast<size_t>(triangles));
        EXPECT_EQ(square(report.coarser), 5120 / triangles);
    }
    options.rate = scattered_rate(9, 1);
    options.finest_rate = uniform_rate(64);
    options.max_triangles = 300;
    const TriangleMesh result = subdivide(icosahedron(), options, "solid", &report);
    EXPECT_GT(report.coarser, 1);
    EXPECT_LE(result.triangles.size(), 300u);
    expect_closed_manifold(result);
    options.max_triangles = 19;
    EXPECT_TRUE(mentions(refusal([&] { subdivide(icosahedron(), options, "solid"); }),
                         "at most 19 triangles"));
}

TEST(AdaptiveSubdivision, CutsAndFlatFacesKeepTheirRates) {
    // A fin on a sheet: its edge is cut, and both pieces must be cut into the same points.
    IndexedMesh mesh = sheet(4, [](float x, float y) { return x * y; });
    const auto tip = static_cast<uint32_t>(mesh.positions.size());
    mesh.positions.emplace_back(0.25f, 0.5f, 2);
    mesh.position_index.emplace_back(11, 12, tip);
    SubdivisionOptions options;
    options.rate = [](const glm::dvec3& a, const glm::dvec3& b) {
        return std::abs(a.y - b.y) + std::abs(a.z - b.z) > 0.2 ? 2 : 5;
    };
    SubdivisionReport report;
    const TriangleMesh result = subdivide(mesh, options, "fin", &report);
    EXPECT_EQ(report.non_manifold_edges, 1u);
    size_t triple = 0;
    const std::vector<glm::uvec3> triangles = topology(result);
    for_each_edge(edge_uses(triangles),
                  [&](std::span<const EdgeUse> edge) { triple += edge.size() == 3; });
    EXPECT_EQ(triple, 5u);
}

/// A disc of radius 1 and a twentieth of that thick; each face is a fan with a ring round it.
IndexedMesh thin_disc(uint32_t count) {
    IndexedMesh mesh;
    const auto add_ring = [&](double radius, float z) {
        for (uint32_t i = 0; i < count; ++i) {
            const double phi = 2 * kPi * i / count;
            mesh.positions.emplace_back(radius * std::cos(phi), radius * std::sin(phi), z);
        }
    };
    mesh.positions = {{0, 0, 0.05f}, {0, 0, 0}};
    for (const auto& [radius, z] : {std::pair{0.8, 0.05f}, {1.0, 0.05f}, {1.0, 0.0f}, {0.8, 0.0f}})
        add_ring(radius, z);
    for (uint32_t i = 0; i < count; ++i) {
        const uint32_t a = 2 + i, b = 2 + (i + 1) % count;
        mesh.position_index.emplace_back(0, a, b);
        for (uint32_t ring = 0; ring < 3 * count; ring += count) {
            mesh.position_index.emplace_back(a + ring, a + ring + count, b + ring + count);
            mesh.position_index.emplace_back(a + ring, b + ring + count, b + ring);
        }
        mesh.position_index.emplace_back(1, b + 3 * count, a + 3 * count);
    }
    return mesh;
}

/// The largest angle between a triangle's normal and one at its corners [degrees].
double largest_tilt(const TriangleMesh& mesh) {
    double least_cosine = 1;
    for (const glm::uvec3& t : mesh.triangles) {
        const auto& p = mesh.positions;
        const glm::dvec3 normal = glm::cross(glm::dvec3(p[t.y]) - glm::dvec3(p[t.x]),
                                             glm::dvec3(p[t.z]) - glm::dvec3(p[t.x]));
        for (int c = 0; c < 3; ++c)
            least_cosine = std::min(least_cosine, glm::dot(normal, glm::dvec3(mesh.normals[t[c]])) /
                                                      glm::length(normal));
    }
    return degrees(std::acos(least_cosine));
}

/// A rim that is thinner than a piece is long turns within one; where it is cut finer, normals and
/// triangles face the same way.
TEST(AdaptiveSubdivision, SharpTurnsAreCutFiner) {
    const auto pieces = [](double length) {
        return [length](const glm::dvec3& a, const glm::dvec3& b) {
            return std::clamp(static_cast<int>(std::ceil(glm::distance(a, b) / length)), 1, 256);
        };
    };
    const IndexedMesh disc = thin_disc(24);
    SubdivisionOptions options;
    options.rate = pieces(0.12);
    const TriangleMesh coarse = subdivide(disc, options, "disc");
    EXPECT_GT(largest_tilt(coarse), 65);
    options.finest_rate = pieces(0.01);
    const TriangleMesh fine = subdivide(disc, options, "disc");
    EXPECT_LT(largest_tilt(fine), 61);
    EXPECT_GT(fine.triangles.size(), coarse.triangles.size());
    expect_closed_manifold(fine);
    expect_sound(fine);
    // No finer than asked for, and where nothing turns, not finer at all.
    options.finest_rate = options.rate;
    EXPECT_EQ(subdivide(disc, options, "disc").triangles, coarse.triangles);
    const IndexedMesh ball = icosahedron();
    options.finest_rate = nullptr;
    const size_t triangles = subdivide(ball, options, "ball").triangles.size();
    options.finest_rate = pieces(0.01);
    EXPECT_EQ(subdivide(ball, options, "ball").triangles.size(), triangles);
}

/// Every triangle between three sides of whatever rates is covered once, and a slender one, such as
/// those at the pole of a sphere, by no more triangles than its sides have pieces.
TEST(FacePatterns, CoverTheFaceOnce) {
    FacePatterns patterns;
    for (const FaceKind kind : {FaceKind::triangle, FaceKind::quartered_triangle})
        for (const int a : {1, 2, 3, 7, 40})
            for (const int b : {1, 2, 3, 7, 40})
                for (const int c : {1, 2, 3, 7, 40}) {
                    const FacePattern& cut = patterns.get(kind, {a, b, c, 0});
                    const auto place = [&](uint32_t point) {
                        const glm::dvec4 shares = corner_shares(kind, cut.points[point]);
                        return glm::dvec2(shares.y, shares.z);
                    };
                    double area = 0;
                    std::vector<int> uses(cut.points.size(), 0);
                    for (const glm::uvec3& t : cut.triangles) {
                        const glm::dvec2 corner = place(t.x);
                        const glm::dvec2 one = place(t.y) - corner, other = place(t.z) - corner;
                        const double doubled = one.x * other.y - one.y * other.x;
                        EXPECT_GT(doubled, -1e-6) << a << ' ' << b << ' ' << c;
                        area += doubled / 2;
                        for (int k = 0; k < 3; ++k)
                            ++uses[t[k]];
                    }
                    EXPECT_NEAR(area, 0.5, 1e-5) << a << ' ' << b << ' ' << c;
                    EXPECT_TRUE(std::ranges::all_of(uses, [](int count) { return count > 0; }));
                    if (std::min({a, b, c}) == 1) {
                        EXPECT_EQ(cut.triangles.size(), size_t(a + b + c - 2));
                    }
                    // Its sides are cut evenly, for the neighbours to fit.
                    uint32_t at = 0;
                    for (const auto& [rate, from, to] :
                         {std::tuple{a, glm::dvec2(0, 0), glm::dvec2(1, 0)},
                          {b, {1, 0}, {0, 1}},
                          {c, {0, 1}, {0, 0}}})
                        for (int i = 0; i < rate; ++i, ++at)
                            EXPECT_LT(
                                glm::distance(place(at), glm::mix(from, to, double(i) / rate)),
                                1e-6);
                }
}

TEST(Creases, AreWhereTheNormalsOfTheFileDiffer) {
    IndexedMesh mesh = quad_cube();
    SubdivisionOptions options;
    options.rate = uniform_rate(3);
    options.crease_angle = radians(30.0);
    SubdivisionReport report;
    subdivide(mesh, options, "cube", &report);
    EXPECT_EQ(report.creases, 0u); // no normals
    add_face_normals(mesh);
    const TriangleMesh sharp = subdivide(mesh, options, "cube", &report);
    EXPECT_EQ(report.creases, 12u); // but not the diagonals of the faces
    for (size_t v = 0; v < sharp.positions.size(); ++v) {
        const glm::vec3 p = sharp.positions[v], n = sharp.normals[v];
        EXPECT_NEAR(std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}), 1, 1e-6);
        EXPECT_NEAR(glm::dot(p, n), 1,
                    1e-5); // the cube stays a cube, with the normals of its sides
    }
    expect_closed_manifold(sharp);
    options.crease_angle = radians(91.0);
    const TriangleMesh round = subdivide(mesh, options, "cube", &report);
    EXPECT_EQ(report.creases, 0u);
    EXPECT_LT(glm::length(round.positions[0]), 1);
}

TEST(Creases, RunOutInASmoothVertex) {
    // A fold along part of the middle line: there the two sides have normals of their own.
    IndexedMesh mesh = sheet(6, [](float x, float) { return std::abs(x - 0.5f); });
    mesh.normal_index = mesh.position_index;
    for (const glm::vec3& p : mesh.positions)
        mesh.normals.push_back(p.x < 0.5f ? glm::vec3(1, 0, 1) : glm::vec3(-1, 0, 1));
    const auto sharp_end = [&](uint32_t v) {
        return mesh.positions[v].x == 0.5f && mesh.positions[v].y < 0.4f;
    };
    for (glm::uvec3& t : mesh.normal_index) // corners on the left of the fold: normals of the left
        for (int c = 0; c < 3; ++c)
            if (sharp_end(t[c]) &&
                (mesh.positions[t.x] + mesh.positions[t.y] + mesh.positions[t.z]).x < 1.5f)
                t[c] = 0;
    SubdivisionOptions options;
    options.rate = uniform_rate(4);
    options.crease_angle = radians(30.0);
    SubdivisionReport report;
    const TriangleMesh result = subdivide(mesh, options, "fold", &report);
    EXPECT_EQ(report.creases, 3u); // y = 0, 1/6, 2/6 are split: the third edge ends smoothly
    expect_sound(result);
    const auto normals_near = [&](float y) {
        float spread = 0;
        for (size_t v = 0; v < result.positions.size(); ++v)
            if (std::abs(result.positions[v].x - 0.5f) < 1e-3f &&
                std::abs(result.positions[v].y - y) < 0.05f)
                spread = std::max(spread, std::abs(result.normals[v].x));
        return spread;
    };
    EXPECT_GT(normals_near(0.15f), 0.5f);
    EXPECT_LT(normals_near(0.85f), 0.05f);
}

TEST(Quads, AreRecoveredFromPairsOfTriangles) {
    SubdivisionOptions options;
    options.rate = uniform_rate(2);
    options.quads = true;
    SubdivisionReport report;
    const TriangleMesh cube = subdivide(quad_cube(), options, "cube", &report);
    EXPECT_EQ(report.quads, 6u);
    EXPECT_EQ(report.faces, 12u);
    // Halstead, Kass & DeRose 1993: (n² V + 4 Σ edges + Σ faces) / (n (n + 5)), here (9 + 4 −
    // 1)/24.
    float corner = 0;
    for (const glm::vec3& p : cube.positions)
        corner = std::max(corner, std::min({p.x, p.y, p.z}));
    EXPECT_NEAR(corner, 0.5f, 1e-6f);
    expect_closed_manifold(cube);
    subdivide(icosahedron(), options, "icosahedron", &report);
    EXPECT_GT(report.quads, 0u); // whatever pairs there are, beside single triangles
    options.quads = false;
    subdivide(quad_cube(), options, "cube", &report);
    EXPECT_EQ(report.quads, 0u);
}

TEST(Quads, SeamsCreasesAndArrowheadsStayTriangles) {
    SubdivisionOptions options;
    options.quads = true;
    options.crease_angle = radians(30.0);
    SubdivisionReport report;
    const auto quads = [&](const IndexedMesh& mesh) {
        subdivide(mesh, options, "mesh", &report);
        return report.quads;
    };
    IndexedMesh mesh = quad_sheet(1, [](float, float) { return 0.0f; });
    EXPECT_EQ(quads(mesh), 1u);
    IndexedMesh seam = mesh;
    add_separate_uvs(seam);
    EXPECT_EQ(quads(seam), 0u);
    IndexedMesh crease = mesh;
    crease.normals = {{0, 0, 1}, {0, 1, 1}};
    crease.normal_index = {glm::uvec3(0), glm::uvec3(1)};
    EXPECT_EQ(quads(crease), 0u);
    mesh.positions[3] = {0.6f, 0.1f, 0}; // not convex
    EXPECT_EQ(quads(mesh), 0u);
}

/// Every vertex of a sheet on which (u, v) = (x, y), but for a jump of u in the middle if `seam`.
void expect_true_frames(const std::function<float(float, float)>& height, bool seam) {
    IndexedMesh mesh = quad_sheet(7, height);
    // A cell of triangles that cannot be joined, so that Catmull & Clark's triangles occur.
    std::swap(mesh.position_index[20], mesh.position_index[22]);
    add_uvs(mesh, [](const glm::vec3& p) { return glm::vec2(p); });
    const auto offset = static_cast<uint32_t>(mesh.uvs.size());
    for (uint32_t i = 0; i < offset; ++i)
        mesh.uvs.push_back(mesh.uvs[i] + glm::vec2(3, 0));
    for (glm::uvec3& t : mesh.uv_index)
        if (seam && (mesh.uvs[t.x] + mesh.uvs[t.y] + mesh.uvs[t.z]).x > 9 / 7.0f)
            t += offset;
    SubdivisionOptions options;
    options.rate = scattered_rate(5, 1);
    options.quads = true;
    options.need_uvs = true;
    SubdivisionReport report;
    const TriangleMesh result = subdivide(mesh, options, "sheet", &report);
    EXPECT_GT(report.quads, 40u);
    EXPECT_LT(report.quads, 49u);
    for (size_t v = 0; v < result.positions.size(); ++v) {
        ASSERT_LT(glm::distance(glm::vec2(result.weft[v]), glm::vec2(1, 0)), 2e-4f);
        ASSERT_LT(glm::distance(glm::vec2(result.warp[v]), glm::vec2(0, 1)), 2e-4f);
    }
}

TEST(Quads, FramesAreTheDerivatives) {
    expect_true_frames([](float x, float y) { return 0.1f * std::sin(7 * x) * std::cos(5 * y); },
                       false);
    // Beyond a seam the UVs go on in the triangle's plane, which is exact for a flat sheet.
    expect_true_frames([](float, float) { return 0.0f; }, true);
}

/// Two sheets that touch along x = 1 without being joined; the right one has twice as many vertices
/// there, and both rise towards it.
IndexedMesh sheets_with_t_junctions() {
    IndexedMesh mesh = sheet(2, [](float x, float) { return x * x; });
    const IndexedMesh fine = sheet(4, [](float x, float) { return (1 - x) * (1 - x); });
    const auto offset = static_cast<uint32_t>(mesh.positions.size());
    for (const glm::vec3& p : fine.positions)
        mesh.positions.push_back(p + glm::vec3(1, 0, 0));
    for (const glm::uvec3& t : fine.position_index)
        mesh.position_index.push_back(t + offset);
    for (glm::vec3& p : mesh.positions) // the line on which they touch bends at its middle vertex
        p.x += 0.3f * std::abs(p.y - 0.5f);
    return mesh;
}

TEST(TJunctions, StayOnTheLineOnWhichPiecesTouch) {
    const IndexedMesh mesh = sheets_with_t_junctions();
    SubdivisionOptions options;
    options.rate = uniform_rate(4);
    SubdivisionReport report;
    const TriangleMesh result = subdivide(mesh, options, "sheets", &report);
    EXPECT_EQ(report.t_junctions, 2u);
    size_t on_line = 0;
    for (const glm::vec3& p : result.positions)
        if (std::abs(p.z - 1) < 1e-5f) {
            ++on_line;
            EXPECT_NEAR(p.x, 1 + 0.3f * std::abs(p.y - 0.5f), 1e-6f);
        }
    EXPECT_EQ(on_line, 9u + 17u); // 2 edges of 4 pieces on the left, 4 on the right
    // Pieces that are apart by more than a thousandth of the edge are none.
    IndexedMesh apart = mesh;
    for (size_t v = 9; v < apart.positions.size(); ++v)
        apart.positions[v].x += 1e-2f;
    subdivide(apart, options, "sheets", &report);
    EXPECT_EQ(report.t_junctions, 0u);
}

TEST(AutoUvs, HangTheWarpVertically) {
    IndexedMesh mesh = icosahedron();
    add_auto_uvs(mesh);
    SubdivisionReport report;
    const TriangleMesh result = subdivide(mesh, options(3, true), "icosahedron", &report);
    EXPECT_EQ(report.mirrored, 0u);
    EXPECT_EQ(report.frames_repaired, 0u);
    expect_closed_manifold(result);
    expect_sound(result);
    for (size_t v = 0; v < result.positions.size(); ++v) {
        const glm::vec3 n = glm::abs(result.normals[v]);
        const bool on_side = n.y < 0.3f * std::max(n.x, n.z);
        if (on_side) { // the warp climbs straight up: its part across is that of the surface
            const glm::vec3 across = glm::cross(result.normals[v], glm::vec3(0, 1, 0));
            EXPECT_LT(std::abs(glm::dot(glm::normalize(result.warp[v]), glm::normalize(across))),
                      0.6f);
            EXPECT_GT(result.warp[v].y, 0.5f);
        }
    }
}

TEST(GltfShape, IsCutAsFinelyAsItIsSeen) {
    const TemporaryFolder folder;
    write_bytes(folder / "model.glb", quad().glb());
    const auto triangles = [&](const std::string& camera, const std::string& parameters) {
        write_bytes(folder / "scene.pbrt",
                    camera +
                        " Film \"rgb\" \"integer xresolution\" 100 \"integer yresolution\" 100 "
                        "WorldBegin Shape \"gltf\" \"string filename\" \"model.glb\" " +
                        parameters);
        std::vector<std::string> warnings;
        return build_scene(parse_pbrt(folder / "scene.pbrt"), {}, warnings)
            .surfaces()
            .at(0)
            .mesh->triangles.size();
    };
    const std::string near = "LookAt 0 0 3 0 0 0 0 1 0 Camera \"perspective\" \"float fov\" 90",
                      far = "LookAt 0 0 30 0 0 0 0 1 0 Camera \"perspective\" \"float fov\" 90";
    EXPECT_EQ(triangles(near, "\"integer level\" 3"), 18u);
    EXPECT_EQ(triangles(near, "\"integer level\" 0"), 2u);
    // Seen from 3 m, a metre takes 100/6 pixels: 2 pieces of at most 9, the diagonal 3.
    const size_t few = triangles(near, "\"float edgelength\" 9");
    EXPECT_GE(few, 8u);
    EXPECT_LE(few, 18u);
    EXPECT_GT(triangles(near, "\"float edgelength\" 1"), 20 * few);
    EXPECT_EQ(triangles(far, "\"float edgelength\" 9"), 2u);
    EXPECT_EQ(triangles(far, ""), triangles(far, "\"float edgelength\" 3"));
    for (const auto& [parameters, expected] :
         {std::pair{"\"float edgelength\" 0", "above 0"},
          {"\"float edgelength\" 2 \"integer level\" 2", "either"},
          {"\"integer level\" 65", "0 to 64"},
          {"\"float creaseangle\" 200", "0 to 180"}})
        EXPECT_TRUE(mentions(refusal([&, p = parameters] { triangles(near, p); }), expected));
}

/// From 1 mm before a garment, and from within it, only what is in the picture is cut finely.
TEST(GltfShape, IsCutCoarselyWhereItIsOutOfThePicture) {
    const TemporaryFolder folder;
    const auto triangles = [&](const std::string& look_at) {
        write_bytes(folder / "scene.pbrt",
                    "Scale -1 1 1 LookAt " + look_at +
                        " 0 1 0 Camera \"perspective\" \"float fov\" 40 "
                        "Film \"rgb\" \"integer xresolution\" 256 \"integer yresolution\" 256 "
                        "WorldBegin Shape \"gltf\" \"float edgelength\" 4 "
                        "\"string filename\" \"" RAPPORT_SOURCE_DIR "/scenes/garments/dress.glb\"");
        std::vector<std::string> warnings;
        return build_scene(parse_pbrt(folder / "scene.pbrt"), {}, warnings)
            .surfaces()
            .at(0)
            .mesh->triangles.size();
    };
    // Without regard to the picture they would be 1011237 and 447635.
    EXPECT_LT(triangles("-0.00873 0.86092 0.24473 -0.00873 0.86092 0.2"), 600'000u);
    EXPECT_LT(triangles("0 0.86 0 0 0.86 1"), 80'000u);
}

} // namespace
} // namespace rapport
