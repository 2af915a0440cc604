#include "renderer/scene/table_loader.h"

#include "renderer/core/error.h"
#include "vgsp/measure_cloth.h"

#include <algorithm>
#include <cctype>

namespace rapport {

TableLoader::TableLoader(double accuracy, uint64_t seed, Progress progress)
    : accuracy_(accuracy), seed_(seed), progress_(std::move(progress)) {}

std::shared_ptr<const TableBsdf> TableLoader::load(const std::filesystem::path& path) {
    const std::filesystem::path key = std::filesystem::weakly_canonical(path);
    if (const auto found = loaded_.find(key); found != loaded_.end())
        return found->second;
    std::string extension = path.extension().string();
    std::ranges::transform(extension, extension.begin(),
                           [](unsigned char c) { return std::tolower(c); });
    const bool stored = extension == ".bsdf";
    auto table = std::make_shared<const TableBsdf>(
        stored ? read_table(path) : measure_file(path, extension), path.string());
    loaded_[key] = table;
    if (!stored)
        measured_[path] = table;
    return table;
}

BsdfTable TableLoader::measure_file(const std::filesystem::path& path,
                                    const std::string& extension) const {
    if (extension != ".toml" && extension != ".wif")
        throw FileError(path.string(), "", "a cloth as .bsdf, .toml or .wif",
                        extension.empty() ? "no extension" : extension);
    const Cloth cloth = extension == ".toml" ? read_cloth(path) : viscose_cloth(path);
    MeasureOptions options;
    options.goniophotometer.accuracy = accuracy_;
    options.goniophotometer.seed = seed_;
    const auto progress = [&](const GoniophotometerProgress& now) {
        if (progress_)
            progress_(path, now.accuracy, now.fraction);
    };
    return measure_cloth(cloth, options, progress).table;
}

} // namespace rapport
