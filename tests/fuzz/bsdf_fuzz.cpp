#include "materials/table/measured_brdf.h"
#include "materials/table/table_bsdf.h"
#include "tests/fuzz/input_file.h"

#include <cmath>

using namespace rapport;

namespace {

void expect_sound(const Rgb& value, float pdf) {
    if (!(value.r >= 0 && value.g >= 0 && value.b >= 0 && pdf >= 0))
        std::terminate();
}

} // namespace

/// A table of ours or of others; what is read must also evaluate to something that is no NaN.
extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    return tests::fuzz_file("input.bsdf", data, size, [](const std::filesystem::path& path) {
        const glm::vec3 eye = glm::normalize(glm::vec3(0.3f, -0.2f, 0.6f));
        const glm::vec3 light = glm::normalize(glm::vec3(-0.5f, 0.1f, 0.4f));
        if (is_measured_file(path)) {
            const MeasuredBrdf brdf(read_measured(path));
            const MeasuredBrdf::Value value = brdf.eval_and_pdf(eye, light);
            expect_sound(value.value, value.pdf);
            const MeasuredBrdf::Value sampled =
                brdf.eval_and_pdf(eye, brdf.sample(eye, {0.3f, 0.7f}));
            expect_sound(sampled.value, sampled.pdf);
            return;
        }
        // Not `read_table`: the checksum would refuse whatever has been changed.
        const TableBsdf bsdf(table_of(read_tensor_file(path), path), path.string());
        const TableBsdf::Value value = bsdf.eval_and_pdf(eye, -light);
        expect_sound(value.intensity, value.pdf);
        if (const auto sample = bsdf.sample(-eye, 0.4f, {0.3f, 0.7f}))
            expect_sound(sample->weight, sample->pdf);
    });
}
