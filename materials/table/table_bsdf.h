#pragma once

#include "materials/table/packed_table.h"

#include <memory>
#include <optional>

namespace rapport {

/// Evaluates and samples a full table by one interpolant: `eval`, `pdf` and `sample` agree with
/// each other by construction. Between directions of incidence, the nodes around are blended in the
/// chart in which highlights stand still (exit_chart.h), not in place, which would double them. All
/// of it belongs to the *eye* direction, which takes the table's incidence slot (reciprocity):
/// eval(eye, light) = I(eye → light), so albedo and pdf are those of the direction the table was
/// measured for. Directions are in the local frame of the cloth.
class TableBsdf {
  public:
    /// FileError(`name` for the message) for a partial table, or one that lacks a side. Throws
    /// Stopped when told to stop.
    TableBsdf(BsdfTable table, const std::string& name, const StopSignal& stopped = {});
    ~TableBsdf();

    Rgb eval(const glm::vec3& eye, const glm::vec3& light) const;
    float pdf(const glm::vec3& eye, const glm::vec3& light) const;
    using Value = PackedTable::Value;
    /// Both at the price of one.
    Value eval_and_pdf(const glm::vec3& eye, const glm::vec3& light) const;
    using Sample = PackedTable::Sample;
    std::optional<Sample> sample(const glm::vec3& eye, float choice, const glm::vec2& u) const;
    using Shares = PackedTable::Shares;
    Shares shares(const glm::vec3& eye) const;
    Rgb unscattered(const glm::vec3& eye) const { return shares(eye).unscattered; }
    Rgb albedo(const glm::vec3& eye) const { return shares(eye).scattered; }

    const BsdfTable& table() const { return table_; }

  private:
    BsdfTable table_;
    std::unique_ptr<const PackedTable> packed_;
};

} // namespace rapport
