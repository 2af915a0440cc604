#include "renderer/scene/table_loader.h"

#include "renderer/core/input_file.h"
#include "vgsp/measure_cloth.h"

namespace rapport {

TableLoader::TableLoader(double accuracy, uint64_t seed, Progress progress)
    : accuracy_(accuracy), seed_(seed), progress_(std::move(progress)) {}

std::shared_ptr<const TableBsdf> TableLoader::load(const std::filesystem::path& path,
                                                   const std::string& colourway) {
    auto& loaded = loaded_[{std::filesystem::weakly_canonical(path), colourway}];
    if (!loaded.table)
        loaded = {path,
                  std::make_shared<const TableBsdf>(
                      all_colourways(path)->in_colourway(colourway, path.string()), path.string())};
    return loaded.table;
}

std::shared_ptr<const BsdfTable> TableLoader::all_colourways(const std::filesystem::path& path) {
    auto& table = whole_[std::filesystem::weakly_canonical(path)];
    if (!table)
        table = std::make_shared<const BsdfTable>(
            lower_extension(path) == ".bsdf" ? read_table(path) : measure_file(path));
    return table;
}

BsdfTable TableLoader::measure_file(const std::filesystem::path& path) const {
    const Cloth cloth = load_cloth(path);
    MeasureOptions options;
    options.goniophotometer.accuracy = accuracy_;
    options.goniophotometer.seed = seed_;
    const auto progress = [&](const GoniophotometerProgress& now) {
        if (progress_)
            progress_(path, now);
    };
    return measure_cloth(cloth, options, progress).table;
}

} // namespace rapport
