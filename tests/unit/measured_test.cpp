#include "materials/table/measured_brdf.h"
#include "materials/table/measured_fields.h"
#include "renderer/core/error.h"
#include "renderer/core/rng.h"
#include "renderer/core/tensor_file.h"
#include "tests/support/file_bytes.h"
#include "tests/support/measured_files.h"
#include "tests/support/temporary_folder.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <limits>

namespace rapport {
namespace {

using tests::small_measured;

glm::vec3 direction(double theta_degrees, double phi_degrees) {
    return glm::vec3(spherical_direction(radians(theta_degrees), radians(phi_degrees)));
}

class MeasuredFile : public testing::Test {
  protected:
    /// The place and what was found when the file with one field changed is read; "" if it is.
    template <class Change> std::string place_after(const Change& change) {
        TensorFile file = read_tensor_file(path_);
        change(file);
        write_tensor_file(file, changed_);
        try {
            read_measured(changed_);
        } catch (const FileError& error) {
            EXPECT_FALSE(error.expected.empty());
            return error.place;
        }
        return "";
    }
    std::string place_after_setting(const std::string& name, size_t i, float value) {
        return place_after([&](TensorFile& file) {
            std::vector<float> values = file[name].values<float>();
            values.at(i) = value;
            file[name] = TensorField::of<float>(file[name].shape, values);
        });
    }
    void SetUp() override { write_measured(small_measured(), path_); }

    tests::TemporaryFolder folder_;
    std::filesystem::path path_ = folder_ / "a.bsdf", changed_ = folder_ / "b.bsdf";
};

TEST_F(MeasuredFile, RoundTripIsExact) {
    for (const size_t phis : {1, 2, 5}) {
        const MeasuredFields fields = small_measured(phis);
        write_measured(fields, path_);
        EXPECT_TRUE(is_measured_file(path_));
        const MeasuredFields again = read_measured(path_);
        EXPECT_EQ(again.description, fields.description);
        EXPECT_EQ(again.theta, fields.theta);
        EXPECT_EQ(again.phi, fields.phi);
        EXPECT_EQ(again.vndf.values, fields.vndf.values);
        EXPECT_EQ(again.rgb.values, fields.rgb.values);
        EXPECT_EQ(again.isotropic(), phis <= 2);
        write_measured(again, changed_);
        EXPECT_EQ(tests::read_bytes(path_), tests::read_bytes(changed_));
    }
}

TEST_F(MeasuredFile, NamesTheFieldThatIsMissingOrOfWrongTypeOrShape) {
    for (const auto& [name, field] : read_tensor_file(path_)) {
        const std::string expected =
            name == "rgb" ? "wavelengths" : name; // one of the two is asked
        EXPECT_EQ(place_after([&name = name](TensorFile& file) { file.erase(name); }), expected);
        EXPECT_EQ(place_after([&name = name](TensorFile& file) {
                      file[name] = TensorField::of<int32_t>({2, 1}, {1, 2});
                  }),
                  name);
        EXPECT_EQ(place_after([&name = name](TensorFile& file) {
                      file[name] = TensorField::of<float>({1, 1, 1, 1, 1, 1}, {1});
                  }),
                  name);
    }
    const auto reshaped = [&](const std::string& name, std::vector<uint64_t> shape) {
        return place_after([&](TensorFile& file) {
            uint64_t count = 1;
            for (const uint64_t extent : shape)
                count *= extent;
            file[name] = TensorField::of<float>(shape, std::vector<float>(count, 0.5f));
        });
    };
    EXPECT_EQ(reshaped("ndf", {1, 12}), "ndf");
    EXPECT_EQ(reshaped("vndf", {5, 2, 3, 3}), "vndf");
    EXPECT_EQ(reshaped("vndf", {3, 5, 3, 3}), "vndf");
    EXPECT_EQ(reshaped("luminance", {5, 3, 4, 5}), "luminance");
    EXPECT_EQ(reshaped("luminance", {5, 3, 6, 6}), "rgb");
    EXPECT_EQ(reshaped("rgb", {5, 3, 4, 4, 4}), "rgb");
    EXPECT_EQ(reshaped("theta_i", {0}), "theta_i");
}

TEST_F(MeasuredFile, NamesTheBadValue) {
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    for (const char* name : {"ndf", "sigma", "vndf", "luminance"})
        for (const float bad : {kNan, kInfinity, -0.1f})
            EXPECT_EQ(place_after_setting(name, 5, bad), std::string(name) + "[5]");
    EXPECT_EQ(place_after_setting("rgb", 5, kNan), "rgb[5]");
    EXPECT_EQ(place_after_setting("rgb", 5, -1e-4f), ""); // left by measurements; cut
    EXPECT_EQ(place_after_setting("theta_i", 1, 0), "theta_i[1]");
    EXPECT_EQ(place_after_setting("theta_i", 2, 1.7f), "theta_i[2]");
    EXPECT_EQ(place_after_setting("theta_i", 0, kNan), "theta_i[0]");
    EXPECT_EQ(place_after_setting("phi_i", 1, 3), "phi_i[2]");
    EXPECT_EQ(place_after_setting("phi_i", 4, 3.3f), "phi_i[4]");
    EXPECT_EQ(place_after_setting("phi_i", 0, -2), "phi_i"); // neither the circle nor a part of it
    EXPECT_EQ(place_after_setting("phi_i", 4, 2), "phi_i");
}

TEST_F(MeasuredFile, EveryTruncationIsAnError) {
    const std::string whole = tests::read_bytes(path_);
    for (size_t i = 0; i < 200; ++i) {
        tests::write_bytes(changed_, whole.substr(0, whole.size() * i / 200));
        EXPECT_THROW(read_measured(changed_), FileError) << i;
    }
}

TEST(MeasuredBrdf, PlacesAndDirectionsInvertEachOther) {
    for (const double theta : {0.001, 3.0, 45.0, 89.0})
        for (const double phi : {-179.0, -90.0, 0.0, 33.0, 179.0}) {
            const glm::vec3 w = direction(theta, phi);
            const glm::vec2 place = measured_place(w);
            EXPECT_NEAR(place.x, std::sqrt(theta / 90), 1e-5);
            EXPECT_NEAR(place.y, (phi + 180) / 360, 1e-5);
            EXPECT_NEAR(glm::distance(measured_direction(place), w), 0, 1e-5);
        }
}

/// What the format's papers and plugins say, formula by formula, at a node of incidence.
TEST(MeasuredBrdf, IsTheFormulaOfTheFormat) {
    const MeasuredFields fields = small_measured();
    const MeasuredBrdf brdf(fields);
    const glm::vec3 eye = spherical_direction(fields.theta[1], fields.phi[3]);
    const size_t slice = 3 * fields.theta.size() + 1;
    const MarginalWarp vndf(fields.vndf.values, fields.vndf.rows, fields.vndf.columns);
    const auto bilinear = [](const MeasuredGrid& grid, size_t first, const glm::vec2& at) {
        const double x = at.x * double(grid.columns - 1), y = at.y * double(grid.rows - 1);
        double sum = 0;
        for (size_t i = 0; i < grid.rows; ++i)
            for (size_t j = 0; j < grid.columns; ++j)
                sum += std::max(0.0, 1 - std::abs(y - double(i))) *
                       std::max(0.0, 1 - std::abs(x - double(j))) *
                       grid.values[(first * grid.rows + i) * grid.columns + j];
        return sum;
    };
    for (const glm::vec3& light : {direction(20, 0), direction(50, 120), direction(70, -100)}) {
        const glm::vec3 m = glm::normalize(eye + light);
        const double theta_m = std::acos(m.z), phi_m = std::atan2(m.y, m.x);
        const glm::vec2 place(std::sqrt(theta_m * 2 / kPi), (phi_m + kPi) / (2 * kPi));
        const glm::vec2 eye_place(std::sqrt(fields.theta[1] * 2 / kPi),
                                  (fields.phi[3] + kPi) / (2 * kPi));
        const auto s = vndf.invert({{slice}, {1}}, place);
        const MeasuredBrdf::Value value = brdf.eval_and_pdf(eye, light);
        for (int channel = 0; channel < 3; ++channel)
            EXPECT_NEAR(value.value[channel],
                        bilinear(fields.rgb, 3 * slice + size_t(channel), s.position) *
                            bilinear(fields.ndf, 0, place) /
                            (4 * bilinear(fields.sigma, 0, eye_place)),
                        2e-4);
        const double jacobian = 2 * kPi * kPi * place.x * std::sin(theta_m) * 4 * glm::dot(eye, m);
        const MarginalWarp luminance(fields.luminance.values, 4, 4);
        const double density = luminance.pdf({{slice}, {1}}, s.position);
        EXPECT_NEAR(value.pdf, density * s.pdf / jacobian, 1e-3 * value.pdf);
    }
}

TEST(MeasuredBrdf, TheDensityIsThatOfTheSamplesAtGrazingEyesToo) {
    // The area on the sphere that a small square of random numbers is mapped to, times the density:
    // but for kinks between nodes it is the area of the square.
    const MeasuredBrdf brdf(tests::small_measured());
    constexpr float kHalf = 0x1p-11f;
    for (const float theta : {10.0f, 60.0f, 85.0f, 89.9f}) {
        const glm::vec3 eye = spherical_direction(radians(theta), 0.7f);
        CounterRng rng(1, Purpose::test, 0, 0);
        std::vector<double> ratios;
        for (int i = 0; i < 2000; ++i) {
            const glm::vec2 u(0.01f + 0.98f * rng.uniform_float(),
                              0.01f + 0.98f * rng.uniform_float());
            const auto at = [&](float x, float y) {
                return glm::dvec3(brdf.sample(eye, u + kHalf * glm::vec2(x, y)));
            };
            const double area =
                glm::length(glm::cross(at(1, 0) - at(-1, 0), at(0, 1) - at(0, -1))) /
                square(2.0 * kHalf);
            ratios.push_back(area * brdf.eval_and_pdf(eye, brdf.sample(eye, u)).pdf);
        }
        std::ranges::sort(ratios);
        EXPECT_NEAR(ratios[1000], 1, 1e-3) << theta;
        EXPECT_NEAR(ratios[100], 1, 0.02) << theta;
        EXPECT_NEAR(ratios[1900], 1, 0.02) << theta;
    }
}

TEST(MeasuredBrdf, SymmetriesAreUndone) {
    const glm::vec3 eye = direction(40, 25), light = direction(60, -110);
    const auto turned = [](const glm::vec3& w) { return glm::vec3(-w.x, -w.y, w.z); };
    const auto mirrored = [](const glm::vec3& w) { return glm::vec3(-w.x, w.y, w.z); };
    const auto value = [](const MeasuredBrdf& brdf, const glm::vec3& eye, const glm::vec3& light) {
        return brdf.eval_and_pdf(eye, light).value.r;
    };
    const MeasuredBrdf two(small_measured(5, 2)), four(small_measured(5, 4)), one(small_measured());
    EXPECT_NEAR(value(two, eye, light), value(two, turned(eye), turned(light)), 1e-4);
    EXPECT_GT(std::abs(value(two, eye, light) - value(two, mirrored(eye), mirrored(light))), 1e-3);
    EXPECT_NEAR(value(four, eye, light), value(four, turned(eye), turned(light)), 1e-4);
    EXPECT_NEAR(value(four, eye, light), value(four, mirrored(eye), mirrored(light)), 1e-4);
    EXPECT_GT(std::abs(value(one, eye, light) - value(one, turned(eye), turned(light))), 1e-3);

    MeasuredFields one_azimuth = small_measured(1);
    std::ranges::fill(one_azimuth.sigma.values, 0.7f); // the format looks σ up by azimuth
    const MeasuredBrdf isotropic(one_azimuth);
    EXPECT_NEAR(value(isotropic, eye, light),
                value(isotropic, direction(40, 125), direction(60, -10)), 1e-4);
}

TEST(MeasuredBrdf, WithoutJacobianTheSpectraAreTheValue) {
    MeasuredFields fields = small_measured();
    fields.jacobian = false;
    std::ranges::fill(fields.rgb.values, 0.3f);
    EXPECT_NEAR(MeasuredBrdf(fields).eval_and_pdf(direction(30, 0), direction(20, 90)).value.g,
                0.3f, 1e-6);
}

TEST(MeasuredBrdf, SpectraBecomeColours) {
    MeasuredFields fields = small_measured();
    fields.wavelengths = {400, 450, 500, 550, 600, 650, 700};
    const MeasuredGrid rgb = fields.rgb;
    fields.rgb = {};
    fields.spectra = {4, 4, std::vector<float>(7 * 15 * 16, 0.25f)};
    fields.jacobian = false;
    const Rgb grey = MeasuredBrdf(fields).eval_and_pdf(direction(30, 0), direction(20, 90)).value;
    for (int channel = 0; channel < 3; ++channel)
        EXPECT_NEAR(grey[channel], 0.25f, 1e-4); // the same at all wavelengths
    for (size_t i = 0; i < fields.spectra.values.size(); ++i)
        fields.spectra.values[i] = i / 16 % 7 >= 5 ? 0.25f : 0; // 650 and 700 nm only
    const Rgb red = MeasuredBrdf(fields).eval_and_pdf(direction(30, 0), direction(20, 90)).value;
    EXPECT_GT(red.r, 5 * red.g);
    EXPECT_GE(red.g, 0);
}

} // namespace
} // namespace rapport
