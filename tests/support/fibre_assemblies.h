#pragma once

#include "renderer/core/math.h"
#include "renderer/kernel/fibres.h"

// Assemblies of fibres for tests, all in µm.

namespace rapport::tests {

/// A stack of straight parallel fibres, alternate layers at right angles, one pitch apart: with 16
/// layers, radius 0.46·pitch and index 1.53 the reference of the goniophotometer, whose R and T
/// are known to 1e-4 for light from θ = 30°, φ = 20°. `fibres` to a cell and layer.
inline kernel::FibreAssembly fibre_stack(int layers, double pitch, double radius, int fibres) {
    const double cell = fibres * pitch;
    kernel::FibreAssembly assembly{{cell, cell}, {}};
    for (int layer = 0; layer < layers; ++layer)
        for (int fibre = 0; fibre < fibres; ++fibre) {
            const bool along_x = layer % 2 != 0;
            const double across = (fibre + 0.5) * pitch, z = (layer - 0.5 * (layers - 1)) * pitch;
            assembly.chains.push_back(
                {{along_x ? glm::dvec3(0, across, z) : glm::dvec3(across, 0, z)},
                 along_x ? glm::dvec3(cell, 0, 0) : glm::dvec3(0, cell, 0),
                 radius,
                 0});
        }
    return assembly;
}
inline kernel::FibreAssembly reference_stack(int fibres = 4) {
    return fibre_stack(16, 10, 4.6, fibres);
}

/// One straight fibre along y in a cell so wide that it is alone.
inline kernel::FibreAssembly single_fibre(double radius, double cell_width) {
    return {{cell_width, 10 * radius},
            {{{{cell_width / 2, 0, 0}}, {0, 10 * radius, 0}, radius, 0}}};
}

/// Fibres that wind round axes along x and y, of different radii, some overlapping, one that closes
/// only after two cells, all of them crossing the sides of the cell.
inline kernel::FibreAssembly winding_fibres(const glm::dvec3& moved_by = glm::dvec3(0)) {
    kernel::FibreAssembly assembly{{60, 45}, {}};
    const auto wind = [&](glm::dvec3 start, glm::dvec3 period, double amplitude, double radius,
                          double phase, int joints) {
        kernel::FibreChain chain{{}, period, radius, 0};
        const glm::dvec3 along = glm::normalize(period), across(-along.y, along.x, 0);
        for (int i = 0; i < joints; ++i) {
            const double share = double(i) / joints, angle = phase + 2 * kPi * share;
            chain.points.push_back(moved_by + start + period * share +
                                   across * (amplitude * std::cos(angle)) +
                                   glm::dvec3(0, 0, amplitude * std::sin(angle)));
        }
        assembly.chains.push_back(std::move(chain));
    };
    wind({-20, 5, 12}, {60, 0, 0}, 6, 3, 0, 24);
    wind({-20, 5, 12}, {60, 0, 0}, 6, 3, 3.1, 24);
    wind({-20, 30, 9}, {60, 0, 0}, 3, 5, 1, 16);
    wind({10, 70, -9}, {0, 45, 0}, 5, 4, 2, 20);
    wind({40, 0, -7}, {0, 45, 0}, 2, 4.5, 0.5, 7);
    wind({25, 20, 0}, {0, -90, 0}, 4, 2, 0.3, 40);
    wind({5, 5, 22}, {60, 45, 0}, 2, 1.5, 0, 30);
    assembly.chains.push_back({{moved_by + glm::dvec3(0, 22, -2)}, {60, 0, 0}, 2.5, 0});
    return assembly;
}

/// Fibres in zigzag, half of whose segments have the direction of light from θ = 45°, φ = 0 or π
/// exactly.
inline kernel::FibreAssembly zigzag() {
    kernel::FibreAssembly assembly{{80, 30}, {}};
    for (const double y : {5.0, 15.0, 25.0})
        assembly.chains.push_back({{{0, y, -20}, {40, y, 20}}, {80, 0, 0}, 4, 0});
    return assembly;
}

inline kernel::FibreAssembly scaled(kernel::FibreAssembly assembly, double scale) {
    assembly.cell *= scale;
    for (kernel::FibreChain& chain : assembly.chains) {
        for (glm::dvec3& point : chain.points)
            point *= scale;
        chain.period *= scale;
        chain.radius *= scale;
    }
    return assembly;
}

/// Straight fibres along y that repeat along x.
struct ParallelFibres {
    std::vector<glm::dvec2> centres; ///< in x and z
    double radius = 5, period = 40;

    kernel::FibreAssembly assembly() const {
        kernel::FibreAssembly assembly{{period, 20}, {}};
        for (const glm::dvec2& centre : centres)
            assembly.chains.push_back({{{centre.x, 0, centre.y}}, {0, 20, 0}, radius, 0});
        return assembly;
    }
};

/// Three, at different heights, that do not touch.
inline ParallelFibres parallel_fibres() { return {{{8, -3}, {20, 4}, {33, 0}}}; }

/// Two whose centres are a diameter less `overlap` of it apart, the line of centres at `kPairTilt`
/// to the cloth.
constexpr double kPairTilt = radians(30.0);
inline ParallelFibres fibre_pair(double overlap) {
    ParallelFibres fibres;
    const glm::dvec2 middle(fibres.period / 2, 0);
    const glm::dvec2 half =
        fibres.radius * (1 - overlap) * glm::dvec2(std::cos(kPairTilt), std::sin(kPairTilt));
    fibres.centres = {middle - half, middle + half};
    return fibres;
}

} // namespace rapport::tests
