#include "materials/bsdf.h"
#include "materials/table/measured_brdf.h"

namespace rapport {
namespace {

/// A measured reflectance in the file format of Dupuy & Jakob 2018, as Mitsuba 3 and pbrt-v4 read
/// it. Nothing passes through; both sides reflect, as in pbrt: the back side shows what the face
/// shows to directions turned to their opposites.
///     "string filename"  the .bsdf file; required
class Measured final : public Bsdf {
  public:
    explicit Measured(const MeasuredFields& fields) : brdf_(fields) {}

    Rgb eval(const glm::vec3& eye, const glm::vec3& light) const override {
        return eval_and_pdf(eye, light).value;
    }

    float pdf(const glm::vec3& eye, const glm::vec3& light) const override {
        return eval_and_pdf(eye, light).pdf;
    }

    BsdfValue eval_and_pdf(const glm::vec3& eye, const glm::vec3& light) const override {
        if (eye.z == 0)
            return {Rgb(0), 0};
        const float side = glm::sign(eye.z);
        const MeasuredBrdf::Value both = brdf_.eval_and_pdf(side * eye, side * light);
        return {both.value, both.pdf};
    }

    std::optional<BsdfSample> sample(const glm::vec3& eye, float /*choice*/,
                                     const glm::vec2& u) const override {
        if (eye.z == 0)
            return std::nullopt;
        const glm::vec3 light = glm::sign(eye.z) * brdf_.sample(glm::sign(eye.z) * eye, u);
        // From the direction, not from the warp: rounding may have moved it over a step.
        const BsdfValue both = eval_and_pdf(eye, light);
        if (!(both.pdf > 0))
            return std::nullopt;
        return BsdfSample{light, both.value / both.pdf, both.pdf};
    }

    Rgb albedo(const glm::vec3& eye) const override {
        return eye.z == 0 ? Rgb(0) : brdf_.albedo(glm::sign(eye.z) * eye);
    }

  private:
    MeasuredBrdf brdf_;
};

std::shared_ptr<const Bsdf> make_measured(const MaterialContext& context) {
    const std::string filename = context.params.get_string("filename", "");
    if (filename.empty())
        context.params.fail("filename", "\"string filename\" of a .bsdf", "none");
    return std::make_shared<Measured>(read_measured(context.base_dir / filename));
}

const Registered<MaterialFactory> registered("measured", make_measured);

} // namespace
} // namespace rapport
