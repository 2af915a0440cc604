#include "renderer/scene/limit_surface.h"

#include "renderer/scene/local_uvs.h"

#include <mutex>
#include <opensubdiv/bfr/refinerSurfaceFactory.h>
#include <opensubdiv/bfr/surface.h>
#include <opensubdiv/far/topologyDescriptor.h>
#include <opensubdiv/far/topologyRefinerFactory.h>
#include <optional>
#include <shared_mutex>
#include <stdexcept>

namespace rapport {
namespace {

using namespace OpenSubdiv;

using Cache =
    Bfr::SurfaceFactoryCacheThreaded<std::shared_mutex, std::shared_lock<std::shared_mutex>,
                                     std::unique_lock<std::shared_mutex>>;
using Factory = Bfr::RefinerSurfaceFactory<Cache>;
using Descriptor = Far::TopologyDescriptor;

std::unique_ptr<const Far::TopologyRefiner> make_refiner(const ManifoldMesh& cut,
                                                         const std::vector<char>& detached) {
    std::vector<int> corners, creases, sharp;
    for (size_t t = 0; t < cut.triangles.size(); ++t) {
        if (detached[t])
            continue;
        for (int c = 0; c < 3; ++c) {
            corners.push_back(static_cast<int>(cut.triangles[t][c]));
            if (cut.straight[t][c]) {
                creases.push_back(static_cast<int>(cut.triangles[t][c]));
                creases.push_back(static_cast<int>(cut.triangles[t][(c + 1) % 3]));
            }
        }
    }
    for (uint32_t v = 0; v < cut.attached_vertices; ++v)
        if (cut.pinned[v])
            sharp.push_back(static_cast<int>(v));
    const std::vector<int> sizes(corners.size() / 3, 3);
    const std::vector<float> sharpness(std::max(creases.size() / 2, sharp.size()),
                                       Sdc::Crease::SHARPNESS_INFINITE);

    Descriptor topology;
    topology.numVertices = static_cast<int>(cut.attached_vertices);
    topology.numFaces = static_cast<int>(sizes.size());
    topology.numVertsPerFace = sizes.data();
    topology.vertIndicesPerFace = corners.data();
    topology.numCreases = static_cast<int>(creases.size() / 2);
    topology.creaseVertexIndexPairs = creases.data();
    topology.creaseWeights = sharpness.data();
    topology.numCorners = static_cast<int>(sharp.size());
    topology.cornerVertexIndices = sharp.data();
    topology.cornerWeights = sharpness.data();

    Sdc::Options scheme;
    scheme.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER);
    using RefinerFactory = Far::TopologyRefinerFactory<Descriptor>;
    std::unique_ptr<const Far::TopologyRefiner> refiner(
        RefinerFactory::Create(topology, RefinerFactory::Options(Sdc::SCHEME_LOOP, scheme)));
    if (!refiner)
        throw std::runtime_error("OpenSubdiv refused a manifold mesh");
    return refiner;
}

/// What evaluating one triangle needs; its storage is kept from triangle to triangle.
struct Patch {
    Bfr::Surface<double> surface;
    std::vector<int> control;           ///< vertices
    std::vector<double> positions, uvs; ///< of the control points, then of those made from them
};

} // namespace

struct LimitSurface::Implementation {
    std::unique_ptr<const Far::TopologyRefiner> refiner;
    Factory factory;
    std::vector<int> face; ///< per triangle: number among the attached ones
    std::vector<double> positions;
    std::optional<LocalUvs> uvs;

    Implementation(const ManifoldMesh& cut, const std::vector<char>& detached,
                   const IndexedMesh& mesh)
        : refiner(make_refiner(cut, detached)), factory(*refiner) {
        int next = 0;
        for (const char is_detached : detached)
            face.push_back(is_detached ? -1 : next++);
        for (uint32_t v = 0; v < cut.attached_vertices; ++v)
            for (int i = 0; i < 3; ++i)
                positions.push_back(mesh.positions[cut.origin[v]][i]);
        if (!mesh.uv_index.empty())
            uvs.emplace(cut, detached, mesh);
    }
};

LimitSurface::LimitSurface(const ManifoldMesh& cut, const std::vector<char>& detached,
                           const IndexedMesh& mesh)
    : implementation_(std::make_unique<Implementation>(cut, detached, mesh)) {}

LimitSurface::~LimitSurface() = default;

bool LimitSurface::evaluate(uint32_t triangle, std::span<const glm::dvec2> parameters,
                            std::span<LimitPoint> points) const {
    const Implementation& self = *implementation_;
    thread_local Patch patch;
    if (!self.factory.InitVertexSurface(self.face[triangle], &patch.surface) ||
        !patch.surface.IsValid())
        return false;
    const auto size = static_cast<size_t>(patch.surface.GetNumPatchPoints());
    patch.positions.resize(3 * size);
    patch.surface.PreparePatchPoints(self.positions.data(), 3, patch.positions.data(), 3);
    if (self.uvs) {
        patch.control.resize(static_cast<size_t>(patch.surface.GetNumControlPoints()));
        patch.surface.GetControlPointIndices(patch.control.data());
        patch.uvs.resize(2 * size);
        self.uvs->gather(triangle, patch.control, patch.uvs);
        patch.surface.ComputePatchPoints(patch.uvs.data(), 2);
    }
    for (size_t i = 0; i < parameters.size(); ++i) {
        LimitPoint& p = points[i] = {};
        patch.surface.Evaluate(&parameters[i].x, patch.positions.data(), 3, &p.position.x,
                               &p.position_s.x, &p.position_t.x);
        if (self.uvs)
            patch.surface.Evaluate(&parameters[i].x, patch.uvs.data(), 2, &p.uv.x, &p.uv_s.x,
                                   &p.uv_t.x);
    }
    return true;
}

LimitPoint flat_point(const IndexedMesh& mesh, uint32_t triangle, const glm::dvec2& parameter) {
    LimitPoint point{};
    const glm::uvec3 corner = mesh.position_index[triangle];
    const glm::dvec3 origin = mesh.positions[corner.x];
    point.position_s = glm::dvec3(mesh.positions[corner.y]) - origin;
    point.position_t = glm::dvec3(mesh.positions[corner.z]) - origin;
    point.position = origin + parameter.x * point.position_s + parameter.y * point.position_t;
    if (!mesh.uv_index.empty()) {
        const glm::uvec3 uv = mesh.uv_index[triangle];
        const glm::dvec2 uv_origin = mesh.uvs[uv.x];
        point.uv_s = glm::dvec2(mesh.uvs[uv.y]) - uv_origin;
        point.uv_t = glm::dvec2(mesh.uvs[uv.z]) - uv_origin;
        point.uv = uv_origin + parameter.x * point.uv_s + parameter.y * point.uv_t;
    }
    return point;
}

} // namespace rapport
