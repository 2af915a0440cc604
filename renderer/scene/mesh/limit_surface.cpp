#include "renderer/scene/mesh/limit_surface.h"

#include "renderer/scene/mesh/local_uvs.h"

#include <algorithm>
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

std::unique_ptr<const Far::TopologyRefiner> make_refiner(const ControlMesh& control) {
    std::vector<int> sizes, corners, creases, sharp;
    for (const Face& face : control.faces) {
        if (control.detached[face.triangle()])
            continue;
        sizes.push_back(static_cast<int>(face.size));
        for (uint32_t i = 0; i < face.size; ++i) {
            const uint32_t side = face.side[i];
            corners.push_back(static_cast<int>(control.vertex(side)));
            if (control.crease[side] ||
                control.cut.straight[side / 3][static_cast<int>(side % 3)]) {
                creases.push_back(static_cast<int>(control.vertex(side)));
                creases.push_back(static_cast<int>(control.vertex(next_side(side))));
            }
        }
    }
    for (uint32_t v = 0; v < control.cut.attached_vertices; ++v)
        if (control.cut.pinned[v])
            sharp.push_back(static_cast<int>(v));
    const std::vector<float> sharpness(std::max(creases.size() / 2, sharp.size()),
                                       Sdc::Crease::SHARPNESS_INFINITE);

    Descriptor topology;
    topology.numVertices = static_cast<int>(control.cut.attached_vertices);
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
    std::unique_ptr<const Far::TopologyRefiner> refiner(RefinerFactory::Create(
        topology, RefinerFactory::Options(
                      control.has_quads ? Sdc::SCHEME_CATMARK : Sdc::SCHEME_LOOP, scheme)));
    if (!refiner)
        throw std::runtime_error("OpenSubdiv refused a manifold mesh");
    return refiner;
}

/// What evaluating one face needs; its storage is kept from face to face.
struct Patch {
    Bfr::Surface<double> surface;
    std::vector<int> control;           ///< vertices
    std::vector<double> positions, uvs; ///< of the control points, then of those made from them
};

} // namespace

struct LimitSurface::Implementation {
    std::unique_ptr<const Far::TopologyRefiner> refiner;
    Factory factory;
    std::vector<int> number; ///< per face: among the attached ones
    std::vector<double> positions;
    std::optional<LocalUvs> uvs;

    explicit Implementation(const ControlMesh& control)
        : refiner(make_refiner(control)), factory(*refiner) {
        int next = 0;
        for (const Face& face : control.faces)
            number.push_back(control.detached[face.triangle()] ? -1 : next++);
        for (uint32_t v = 0; v < control.cut.attached_vertices; ++v)
            for (int i = 0; i < 3; ++i)
                positions.push_back(control.mesh.positions[control.cut.origin[v]][i]);
        if (!control.mesh.uv_index.empty())
            uvs.emplace(control);
    }
};

LimitSurface::LimitSurface(const ControlMesh& control)
    : implementation_(std::make_unique<Implementation>(control)) {}

LimitSurface::~LimitSurface() = default;

bool LimitSurface::evaluate(uint32_t face, std::span<const glm::vec2> parameters,
                            std::span<LimitPoint> points) const {
    const Implementation& self = *implementation_;
    thread_local Patch patch;
    if (!self.factory.InitVertexSurface(self.number[face], &patch.surface) ||
        !patch.surface.IsValid())
        return false;
    const auto size = static_cast<size_t>(patch.surface.GetNumPatchPoints());
    patch.positions.resize(3 * size);
    patch.surface.PreparePatchPoints(self.positions.data(), 3, patch.positions.data(), 3);
    if (self.uvs) {
        patch.control.resize(static_cast<size_t>(patch.surface.GetNumControlPoints()));
        patch.surface.GetControlPointIndices(patch.control.data());
        patch.uvs.resize(2 * size);
        self.uvs->gather(face, patch.control, patch.uvs);
        patch.surface.ComputePatchPoints(patch.uvs.data(), 2);
    }
    for (size_t i = 0; i < parameters.size(); ++i) {
        LimitPoint& p = points[i] = {};
        const glm::dvec2 parameter(parameters[i]);
        patch.surface.Evaluate(&parameter.x, patch.positions.data(), 3, &p.position.x,
                               &p.position_s.x, &p.position_t.x);
        if (self.uvs)
            patch.surface.Evaluate(&parameter.x, patch.uvs.data(), 2, &p.uv.x, &p.uv_s.x,
                                   &p.uv_t.x);
    }
    return true;
}

LimitPoint flat_point(const IndexedMesh& mesh, uint32_t triangle, const glm::vec2& at) {
    const glm::dvec2 parameter(at);
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
