#pragma once

#include "materials/table/table_bsdf.h"
#include "vgsp/goniophotometer.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>

namespace rapport {

/// Gets measured tables by file name and colourway: a `.bsdf` is read; a cloth `.toml`, or a `.wif`
/// in the built-in viscose yarns, is measured by the goniophotometer first, in all its colourways.
/// Each file is read or measured once.
class TableLoader {
  public:
    /// Told while `path` is being measured.
    using Progress =
        std::function<void(const std::filesystem::path& path, const GoniophotometerProgress&)>;

    /// `accuracy` is the ε asked of a measurement.
    explicit TableLoader(double accuracy = 0.2, uint64_t seed = 0, Progress progress = {});

    /// An empty colourway is the cloth's own dyes; FileError for one that the cloth has not.
    std::shared_ptr<const TableBsdf> load(const std::filesystem::path& path,
                                          const std::string& colourway);

    /// A table in one colourway, read or measured so far.
    struct Loaded {
        std::filesystem::path path; ///< as it was first asked for
        std::shared_ptr<const TableBsdf> table;
    };
    /// By the file's canonical path and the colourway.
    using Tables = std::map<std::pair<std::filesystem::path, std::string>, Loaded>;
    const Tables& tables() const { return loaded_; }

  private:
    std::shared_ptr<const BsdfTable> all_colourways(const std::filesystem::path& path);
    BsdfTable measure_file(const std::filesystem::path& path) const;

    double accuracy_;
    uint64_t seed_;
    Progress progress_;
    std::map<std::filesystem::path, std::shared_ptr<const BsdfTable>> whole_;
    Tables loaded_;
};

} // namespace rapport
