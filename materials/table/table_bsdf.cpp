#include "materials/table/table_bsdf.h"

#include "materials/table/packed_table.h"
#include "renderer/core/error.h"

#include <algorithm>

namespace rapport {
namespace {

/// Least |cosθ| of a direction that is sampled: on the horizon it would lose its side.
constexpr float kSmallestCosine = 1e-7f;

float mean(const Rgb& c) { return (c.r + c.g + c.b) * (1.0f / 3); }

} // namespace

TableBsdf::TableBsdf(BsdfTable table, const std::string& name) : table_(std::move(table)) {
    if (table_.partial())
        throw FileError(name, "", "a table of the whole grid of incidence",
                        "a partial table of " + std::to_string(table_.directions()) +
                            " directions of incidence");
    const size_t side_size = table_.grid_theta.size() * table_.grid_phi.size();
    for (const size_t side : {0, 1})
        if (table_.grid_index[side * side_size] == BsdfTable::kAbsent)
            throw FileError(name, "", "a table of both sides of the cloth",
                            side == 0 ? "no front side" : "no back side");
    packed_ = std::make_unique<const PackedTable>(table_);
}

TableBsdf::~TableBsdf() = default;

// On the horizon a direction has no side, and nothing scatters.

Rgb TableBsdf::eval(const glm::vec3& eye, const glm::vec3& light) const {
    return eval_and_pdf(eye, light).intensity;
}

float TableBsdf::pdf(const glm::vec3& eye, const glm::vec3& light) const {
    return eval_and_pdf(eye, light).pdf;
}

TableBsdf::Value TableBsdf::eval_and_pdf(const glm::vec3& eye, const glm::vec3& light) const {
    if (eye.z == 0 || light.z == 0)
        return {Rgb(0), 0};
    const PackedTable::Blend blend = packed_->blend(eye);
    const float albedo = mean(packed_->albedo(blend));
    const Rgb intensity = packed_->intensity(blend, packed_->chart(eye), light);
    return {intensity, albedo > 0 ? mean(intensity) / albedo : 0};
}

std::optional<TableBsdf::Sample> TableBsdf::sample(const glm::vec3& eye, float choice,
                                                   const glm::vec2& u) const {
    if (eye.z == 0)
        return std::nullopt;
    const PackedTable::Blend blend = packed_->blend(eye);
    const float albedo = mean(packed_->albedo(blend));
    if (!(albedo > 0))
        return std::nullopt;
    const ExitChart<float> chart = packed_->chart(eye);
    const PackedTable::Exit exit = packed_->sample(blend, choice, u);
    glm::vec3 light = chart.direction(exit.point);
    light.z = std::max(light.z, kSmallestCosine);
    if (exit.transmitted != (eye.z < 0))
        light.z = -light.z;
    // From the direction, not from the place: what rounding moved over an edge keeps its value.
    const Rgb intensity = packed_->intensity(blend, chart, light);
    const float pdf = mean(intensity) / albedo;
    if (!(pdf > 0))
        return std::nullopt;
    return Sample{light, intensity / pdf, pdf};
}

Rgb TableBsdf::unscattered(const glm::vec3& eye) const {
    return eye.z == 0 ? Rgb(0) : packed_->unscattered(packed_->blend(eye));
}

Rgb TableBsdf::albedo(const glm::vec3& eye) const {
    return eye.z == 0 ? Rgb(0) : packed_->albedo(packed_->blend(eye));
}

} // namespace rapport
