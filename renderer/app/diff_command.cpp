#include "renderer/app/commands.h"
#include "renderer/core/error.h"
#include "renderer/core/image.h"

#include <fmt/format.h>
#include <memory>
#include <stdexcept>

namespace rapport {
namespace {

struct DiffOptions {
    std::string a, b;
    double max_error = -1; ///< < 0: not asked
};

ImageDifference difference(const DiffOptions& options) {
    const Image a = read_exr(options.a), b = read_exr(options.b);
    try {
        return compare(a, b);
    } catch (const std::invalid_argument& mismatch) {
        throw FileError(options.b, "", "an image like " + options.a, mismatch.what());
    }
}

bool same(const DiffOptions& options) {
    const ImageDifference d = difference(options);
    fmt::print("largest |difference| {:.6g} at ({}, {}), mean {:.6g}, RMS {:.6g}, relMSE {:.6g}\n",
               d.max_absolute, d.worst_x, d.worst_y, d.mean_absolute, d.rms, d.relative_mse);
    if (options.max_error >= 0)
        return d.max_absolute <= options.max_error;
    if (!d.tested)
        return d.max_absolute == 0;
    fmt::print("against the images' own variance: {} (p = {:.3g}, {:.2f} % beyond 3 sigma, "
               "mean z {:.2f})\n",
               d.agree ? "equal within noise" : "different", d.p_value,
               100 * d.share_beyond_3_sigma, d.mean_z);
    return d.agree;
}

} // namespace

void add_diff_command(CLI::App& app, int& status) {
    const auto options = std::make_shared<DiffOptions>();
    CLI::App* command =
        app.add_subcommand("diff", "Compare two EXR images; exit status 1 when they differ");
    command->add_option("a", options->a, "EXR image")->required();
    command->add_option("b", options->b, "EXR image")->required();
    command
        ->add_option("--max", options->max_error,
                     "Largest |difference| of R, G or B to accept (default: a test against the "
                     "images' variance where both have it, else 0)")
        ->check(non_negative_number());
    command->callback([options, &status] {
        if (!same(*options))
            status = 1;
    });
}

} // namespace rapport
