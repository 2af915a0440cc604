#include "materials/table/table_bsdf.h"

#include "renderer/core/error.h"

namespace rapport {

TableBsdf::TableBsdf(BsdfTable table, const std::string& name, const StopSignal& stopped)
    : table_(std::move(table)) {
    if (table_.partial())
        throw FileError(name, "", "a table of the whole grid of incidence",
                        "a partial table of " + std::to_string(table_.directions()) +
                            " directions of incidence");
    const size_t side_size = table_.grid_theta.size() * table_.grid_phi.size();
    for (const size_t side : {0, 1})
        if (table_.grid_index[side * side_size] == BsdfTable::kAbsent)
            throw FileError(name, "", "a table of both sides of the cloth",
                            side == 0 ? "no front side" : "no back side");
    packed_ = std::make_unique<const PackedTable>(table_, stopped);
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
    return packed_->eval_and_pdf(eye, light);
}

std::optional<TableBsdf::Sample> TableBsdf::sample(const glm::vec3& eye, float choice,
                                                   const glm::vec2& u) const {
    if (eye.z == 0)
        return std::nullopt;
    return packed_->sample(eye, choice, u);
}

TableBsdf::Shares TableBsdf::shares(const glm::vec3& eye) const {
    return eye.z == 0 ? Shares{Rgb(0), Rgb(0)} : packed_->shares(eye);
}

} // namespace rapport
