#pragma once

#include "renderer/core/image.h"
#include "renderer/integrator/path_tracer.h"
#include "tests/support/small_scenes.h"

#include <algorithm>
#include <gtest/gtest.h>

// Pictures of scenes under test. When a test fails, what it has rendered is kept to be looked at.

namespace rapport::tests {

class Picture {
  public:
    /// Throws, naming the pixel, where a radiance is not finite.
    explicit Picture(const Scene& scene) : image_(rapport::render(scene).image()) {}
    ~Picture() {
        if (!testing::Test::HasFailure())
            return;
        const auto* test = testing::UnitTest::GetInstance()->current_test_info();
        const std::string path =
            testing::TempDir() + "rapport-" + test->test_suite_name() + '-' + test->name() + ".exr";
        write_exr(image_, path);
        std::printf("a picture of this scene: %s\n", path.c_str());
    }

    const std::vector<float>& channel(const std::string& name) const { return *image_.find(name); }
    double mean(const std::string& name = "G") const {
        double sum = 0;
        for (const float value : channel(name))
            sum += value;
        return sum / static_cast<double>(channel(name).size());
    }
    /// Of the mean, in one standard error.
    double error() const { return std::sqrt(mean("variance.G") / channel("G").size()); }
    float largest() const { return *std::ranges::max_element(channel("G")); }
    float least() const { return *std::ranges::min_element(channel("G")); }

  private:
    Image image_;
};

} // namespace rapport::tests
