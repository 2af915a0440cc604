#include "materials/table/measured_fields.h"

#include "renderer/core/error.h"
#include "renderer/core/tensor_file.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace rapport {
namespace {

using Type = TensorField::Type;
using Shape = std::vector<uint64_t>;

/// How far an angle may lie off the end of its range: rounding to float, and then some.
constexpr float kAngleTolerance = 1e-3f;

class Reader {
  public:
    explicit Reader(const std::filesystem::path& path)
        : path_(path.string()), file_(read_tensor_file(path)) {}

    MeasuredFields read() {
        fields_.description = field("description", Type::u8, 1).text();
        const TensorField& jacobian = field("jacobian", Type::u8, 1);
        if (jacobian.shape[0] != 1)
            fail("jacobian", "one number", fmt::format("{}", jacobian.shape[0]));
        fields_.jacobian = jacobian.values<uint8_t>()[0] != 0;
        read_incidence();
        fields_.ndf = grid("ndf", {}, false);
        fields_.sigma = grid("sigma", {}, false);
        const Shape incidence{fields_.phi.size(), fields_.theta.size()};
        fields_.vndf = grid("vndf", incidence, false);
        fields_.luminance = grid("luminance", incidence, false);
        if (fields_.luminance.rows != fields_.luminance.columns)
            fail("luminance", "as many rows as columns",
                 fmt::format("{} × {}", fields_.luminance.rows, fields_.luminance.columns));
        read_colours(incidence);
        return std::move(fields_);
    }

  private:
    [[noreturn]] void fail(const std::string& name, const std::string& expected,
                           const std::string& found) const {
        throw FileError(path_, name, expected, found);
    }

    const TensorField& field(const std::string& name, Type type, size_t dimensions) const {
        const std::string expected =
            fmt::format("{} of {} dimension{}", type == Type::u8 ? "bytes" : "32-bit floats",
                        dimensions, dimensions == 1 ? "" : "s");
        const auto found = file_.find(name);
        if (found == file_.end())
            fail(name, expected, "no such field");
        const TensorField& stored = found->second;
        if (stored.type != type || stored.shape.size() != dimensions)
            fail(name, expected,
                 fmt::format("type {} of shape [{}]", static_cast<int>(stored.type),
                             fmt::join(stored.shape, ", ")));
        return stored;
    }

    std::vector<float> axis(const std::string& name, float low, float high) const {
        std::vector<float> values = field(name, Type::f32, 1).values<float>();
        if (values.empty())
            fail(name, "at least one number", "none");
        for (size_t i = 0; i < values.size(); ++i)
            if (!(values[i] >= low && values[i] <= high && (i == 0 || values[i] > values[i - 1])))
                fail(fmt::format("{}[{}]", name, i),
                     fmt::format("ascending numbers from {:g} to {:g}", low, high),
                     fmt::format("{}", values[i]));
        return values;
    }

    void read_incidence() {
        constexpr auto kHalfTurn = static_cast<float>(kPi);
        fields_.theta = axis("theta_i", 0, kHalfTurn / 2 + kAngleTolerance);
        fields_.phi = axis("phi_i", -kHalfTurn - kAngleTolerance, kHalfTurn + kAngleTolerance);
        if (fields_.isotropic())
            return;
        const int symmetry = fields_.symmetry();
        const float end = -kHalfTurn + 2 * kHalfTurn / static_cast<float>(symmetry);
        if ((symmetry != 1 && symmetry != 2 && symmetry != 4) ||
            std::abs(fields_.phi.front() + kHalfTurn) > kAngleTolerance ||
            std::abs(fields_.phi.back() - end) > kAngleTolerance)
            fail("phi_i", "azimuths from −π to π, to 0 or to −π/2, or at most two",
                 fmt::format("{} from {} to {}", fields_.phi.size(), fields_.phi.front(),
                             fields_.phi.back()));
    }

    /// `leading` extents, then rows and columns.
    MeasuredGrid grid(const std::string& name, const Shape& leading, bool may_be_negative) const {
        const TensorField& stored = field(name, Type::f32, leading.size() + 2);
        const uint64_t rows = stored.shape[leading.size()];
        const uint64_t columns = stored.shape[leading.size() + 1];
        if (rows < 2 || columns < 2 ||
            !std::equal(leading.begin(), leading.end(), stored.shape.begin()))
            fail(name,
                 fmt::format("shape [{}rows, columns], each 2 or more",
                             leading.empty() ? "" : fmt::format("{}, ", fmt::join(leading, ", "))),
                 fmt::format("[{}]", fmt::join(stored.shape, ", ")));
        MeasuredGrid grid{rows, columns, stored.values<float>()};
        for (size_t i = 0; i < grid.values.size(); ++i) {
            float& value = grid.values[i];
            if (!std::isfinite(value) || (value < 0 && !may_be_negative))
                fail(fmt::format("{}[{}]", name, i),
                     may_be_negative ? "a finite number" : "a finite number >= 0",
                     fmt::format("{}", value));
            value = std::max(value, 0.0f);
        }
        return grid;
    }

    void read_colours(Shape leading) {
        leading.push_back(3);
        if (file_.contains("rgb"))
            fields_.rgb = grid("rgb", leading, true);
        if (file_.contains("spectra") || !file_.contains("rgb")) {
            fields_.wavelengths = axis("wavelengths", 1, 1e6f);
            leading.back() = fields_.wavelengths.size();
            fields_.spectra = grid("spectra", leading, true);
        }
        for (const auto& [name, grid] :
             {std::pair("rgb", &fields_.rgb), {"spectra", &fields_.spectra}})
            if (!grid->empty() && (grid->rows != fields_.luminance.rows ||
                                   grid->columns != fields_.luminance.columns))
                fail(name, fmt::format("{0} × {0} as in luminance", fields_.luminance.rows),
                     fmt::format("{} × {}", grid->rows, grid->columns));
    }

    std::string path_;
    TensorFile file_;
    MeasuredFields fields_;
};

} // namespace

int MeasuredFields::symmetry() const {
    return static_cast<int>(std::lround(2 * kPi / (phi.back() - phi.front())));
}

glm::vec2 measured_place(const glm::vec3& direction) {
    // From the chord to the pole, which keeps the digits of a small angle.
    const float chord = glm::length(direction - glm::vec3(0, 0, 1));
    const float theta = 2 * std::asin(std::min(0.5f * chord, 1.0f));
    const float turns = std::atan2(direction.y, direction.x) / static_cast<float>(2 * kPi) + 0.5f;
    return {std::sqrt(theta / static_cast<float>(kPi / 2)), turns - std::floor(turns)};
}

glm::vec3 measured_direction(const glm::vec2& place) {
    const auto kHalfTurn = static_cast<float>(kPi);
    return spherical_direction(square(place.x) * kHalfTurn / 2, (2 * place.y - 1) * kHalfTurn);
}

float measured_jacobian(const glm::vec3& eye, const glm::vec3& m) {
    const float sine = std::hypot(m.x, m.y);
    const float of_half_vector =
        static_cast<float>(2 * kPi * kPi) * measured_place(m).x * sine; // dω(m) / dx dy
    return std::max(of_half_vector, 1e-6f) * 4 * std::abs(glm::dot(eye, m));
}

bool is_measured_file(const std::filesystem::path& path) {
    const TensorFile file = read_tensor_file(path);
    return file.contains("vndf") && !file.contains("intensity");
}

MeasuredFields read_measured(const std::filesystem::path& path) { return Reader(path).read(); }

void write_measured(const MeasuredFields& fields, const std::filesystem::path& path) {
    const uint64_t phis = fields.phi.size(), thetas = fields.theta.size();
    TensorFile file;
    const auto put = [&](const std::string& name, const MeasuredGrid& grid, Shape leading) {
        leading.insert(leading.end(), {grid.rows, grid.columns});
        file[name] = TensorField::of<float>(std::move(leading), grid.values);
    };
    file["description"] = TensorField::text(fields.description);
    file["jacobian"] = TensorField::of<uint8_t>({1}, {fields.jacobian});
    file["theta_i"] = TensorField::of<float>({thetas}, fields.theta);
    file["phi_i"] = TensorField::of<float>({phis}, fields.phi);
    put("ndf", fields.ndf, {});
    put("sigma", fields.sigma, {});
    put("vndf", fields.vndf, {phis, thetas});
    put("luminance", fields.luminance, {phis, thetas});
    if (!fields.rgb.empty())
        put("rgb", fields.rgb, {phis, thetas, 3});
    if (!fields.spectra.empty()) {
        put("spectra", fields.spectra, {phis, thetas, fields.wavelengths.size()});
        file["wavelengths"] =
            TensorField::of<float>({fields.wavelengths.size()}, fields.wavelengths);
    }
    write_tensor_file(file, path);
}

} // namespace rapport
