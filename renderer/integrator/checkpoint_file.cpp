#include "renderer/integrator/checkpoint_file.h"

#include <cmath>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace rapport {
namespace {

/// All by which one picture is told from another.
nlohmann::json identity(const RenderCheckpoint& checkpoint, const RenderSettings& settings,
                        const Film& film) {
    nlohmann::json run = checkpoint.made_of;
    run["program"] = RAPPORT_VERSION;
    run["size"] = {film.resolution().x, film.resolution().y};
    if (settings.error > 0)
        run["error"] = settings.error;
    else
        run["samples"] = settings.samples;
    run["depth"] = settings.max_depth;
    run["sampler"] = settings.sampler == Sampler::Kind::sobol ? "sobol" : "independent";
    run["seed"] = settings.seed;
    run["filter"] = {settings.filter_radius.x, settings.filter_radius.y};
    return run;
}

std::vector<uint64_t> shape_of_sums(const Film& film) {
    return {static_cast<uint64_t>(film.resolution().y), static_cast<uint64_t>(film.resolution().x),
            Film::kSums};
}

} // namespace

void write_checkpoint(const RenderCheckpoint& checkpoint, const RenderSettings& settings,
                      const Film& film, std::span<const int> planned) {
    std::vector<int> samples;
    for (const Film::Tile& tile : film.tiles())
        samples.push_back(tile.samples);
    TensorFile file;
    file["run"] = run_field(identity(checkpoint, settings, film));
    file["samples"] = TensorField::of<int>({samples.size()}, samples);
    file["planned"] =
        TensorField::of<int>({planned.size()}, std::vector(planned.begin(), planned.end()));
    const auto sums = film.sums();
    file["sums"] = {TensorField::Type::f64, shape_of_sums(film), {sums.begin(), sums.end()}};
    write_tensor_file(file, checkpoint.path);
}

void read_checkpoint(const RenderCheckpoint& checkpoint, const RenderSettings& settings, Film& film,
                     std::vector<int>& planned) {
    const std::filesystem::path& path = checkpoint.path;
    const TensorFile file = read_tensor_file(path);
    check_same_run(identity(checkpoint, settings, film), file, path);
    const uint64_t tiles = film.tiles().size();
    planned = checkpoint_array<int>(file, "planned", {tiles}, path);
    const auto samples = checkpoint_array<int>(file, "samples", {tiles}, path);
    for (size_t i = 0; i < tiles; ++i) {
        if (samples[i] < 0 || planned[i] < samples[i])
            throw FileError(path.string(), fmt::format("samples[{}]", i),
                            fmt::format("none to {}", planned[i]), fmt::format("{}", samples[i]));
        film.tiles()[i].samples = samples[i];
    }
    const auto sums = checkpoint_array<double>(file, "sums", shape_of_sums(film), path);
    for (size_t i = 0; i < sums.size(); ++i)
        if (!std::isfinite(sums[i]))
            throw FileError(path.string(), fmt::format("sums[{}]", i), "a finite number",
                            fmt::format("{}", sums[i]));
    film.restore(sums);
}

} // namespace rapport
