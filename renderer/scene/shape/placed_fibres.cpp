#include "renderer/scene/shape/placed_fibres.h"

#include "renderer/scene/shape/fibre_swatch.h"

#include <stdexcept>

namespace rapport {
namespace {

constexpr double kMetresPerMicrometre = 1e-6;

} // namespace

PlacedFibres::PlacedFibres(std::shared_ptr<const FibreSwatch> swatch, const glm::mat4& to_world)
    : swatch_(std::move(swatch)), place_(to_world[3]) {
    const glm::dmat3 linear(glm::dmat4{to_world});
    const double scale = glm::length(linear[0]);
    turn_ = linear / scale;
    const glm::dmat3 rest = glm::transpose(turn_) * turn_;
    bool similar = scale > 0 && std::isfinite(scale) && glm::determinant(turn_) > 0;
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column)
            similar = similar && std::abs(rest[column][row] - (row == column)) < 1e-4;
    if (!similar)
        throw std::invalid_argument("fibres are placed by more than a turn, a move and a scale");
    scale_ = scale * kMetresPerMicrometre;
}

glm::dvec3 PlacedFibres::to_swatch(const glm::vec3& position) const {
    return (glm::dvec3(position) - place_) * turn_ / scale_; // v·M = Mᵀ·v
}

glm::dvec3 PlacedFibres::turned_to_swatch(const glm::vec3& direction) const {
    return glm::normalize(glm::dvec3(direction) * turn_);
}

template <class Found>
std::optional<PlacedFibres::Passage> PlacedFibres::in_world(const Found& found) const {
    if (!found)
        return std::nullopt;
    return Passage{place_ + turn_ * found->position * scale_,
                   glm::normalize(turn_ * found->direction), turn_ * found->normal, found->weight,
                   found->scattered};
}

std::optional<PlacedFibres::Passage>
PlacedFibres::follow(const glm::vec3& position, const glm::vec3& direction, CounterRng& rng) const {
    return in_world(swatch_->follow(to_swatch(position), turned_to_swatch(direction), rng));
}

std::optional<PlacedFibres::Passage> PlacedFibres::pass(const glm::vec3& position,
                                                        const glm::vec3& direction) const {
    return in_world(swatch_->pass(to_swatch(position), turned_to_swatch(direction)));
}

} // namespace rapport
