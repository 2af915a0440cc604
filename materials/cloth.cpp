#include "materials/bsdf.h"
#include "materials/table/table_bsdf.h"

#include <cmath>

namespace rapport {
namespace {

/// A cloth by its measured table.
///     "string filename"  a `.bsdf` table or a cloth `.toml`; required
///     "string colourway" in which of the cloth's dyes; default its own
///     "float rotation"   turns the weave on the surface: degrees, counter-clockwise as seen from
///                        the face, so that 90 lays the weft along +v; default 0
///     "bool mirrored"    the weave as a mirror across the warp shows it, a Z twill as an S twill:
///                        for parts whose UVs are mirrored, of a cloth made in both hands; default
///                        false. The mirrored weave is then turned.
class Cloth final : public Bsdf {
  public:
    Cloth(std::shared_ptr<const TableBsdf> table, float rotation, bool mirrored)
        : table_(std::move(table)), cosine_(std::cos(rotation)), sine_(std::sin(rotation)),
          weft_(mirrored ? -1.0f : 1.0f) {}

    Rgb eval(const glm::vec3& eye, const glm::vec3& light) const override {
        return table_->eval(to_weave(eye), to_weave(light));
    }

    float pdf(const glm::vec3& eye, const glm::vec3& light) const override {
        return table_->pdf(to_weave(eye), to_weave(light));
    }

    BsdfValue eval_and_pdf(const glm::vec3& eye, const glm::vec3& light) const override {
        const TableBsdf::Value both = table_->eval_and_pdf(to_weave(eye), to_weave(light));
        return {both.intensity, both.pdf};
    }

    std::optional<BsdfSample> sample(const glm::vec3& eye, float choice,
                                     const glm::vec2& u) const override {
        const auto sample = table_->sample(to_weave(eye), choice, u);
        if (!sample)
            return std::nullopt;
        return BsdfSample{from_weave(sample->light), sample->weight, sample->pdf};
    }

    Rgb unscattered(const glm::vec3& eye) const override {
        return table_->unscattered(to_weave(eye));
    }

    Rgb albedo(const glm::vec3& eye) const override { return table_->albedo(to_weave(eye)); }

    BsdfShares shares(const glm::vec3& eye) const override {
        const TableBsdf::Shares both = table_->shares(to_weave(eye));
        return {both.unscattered, both.scattered};
    }

  private:
    glm::vec3 to_weave(const glm::vec3& w) const {
        return {weft_ * (cosine_ * w.x + sine_ * w.y), cosine_ * w.y - sine_ * w.x, w.z};
    }
    glm::vec3 from_weave(const glm::vec3& w) const {
        const float x = weft_ * w.x;
        return {cosine_ * x - sine_ * w.y, cosine_ * w.y + sine_ * x, w.z};
    }

    std::shared_ptr<const TableBsdf> table_;
    float cosine_, sine_;
    float weft_; ///< its direction in the frame, ±1
};

std::shared_ptr<const Bsdf> make_cloth(const MaterialContext& context) {
    const std::string filename = context.params.get_string("filename", "");
    if (filename.empty())
        context.params.fail("filename", "\"string filename\" of a .bsdf or .toml", "none");
    const float rotation = context.params.get_float("rotation", 0);
    const bool mirrored = context.params.get_bool("mirrored", false);
    const std::string colourway = context.params.get_string("colourway", "");
    return std::make_shared<Cloth>(context.load_table(context.base_dir / filename, colourway),
                                   radians(rotation), mirrored);
}

const Registered<MaterialFactory> registered("cloth", make_cloth);

} // namespace
} // namespace rapport
