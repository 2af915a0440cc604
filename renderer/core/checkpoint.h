#pragma once

#include "renderer/core/error.h"
#include "renderer/core/tensor_file.h"

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace rapport {

/// Where a long run keeps what it has summed so far: a file that is replaced whole at each
/// increment. A run that goes on from it ends with the same numbers as one that was never
/// interrupted. It is for the caller to remove it, once the result is safe.
struct Checkpoint {
    std::filesystem::path path; ///< empty = none is kept
    bool resume = false;        ///< go on from the file, if there is one
};

/// How much longer a run works between two checkpoints than it takes to write one.
constexpr double kWorkPerSaving = 20;

/// What tells one run from another, as the field `run` of its checkpoint: a JSON object of all that
/// decides the result.
TensorField run_field(const nlohmann::json& run);
/// FileError where the checkpoint `file` is of another run: it names the first thing that differs.
void check_same_run(const nlohmann::json& run, const TensorFile& file,
                    const std::filesystem::path& path);

/// One array of a checkpoint; FileError unless it is laid out as this run's.
template <class T>
std::vector<T> checkpoint_array(const TensorFile& file, const std::string& name,
                                const std::vector<uint64_t>& shape,
                                const std::filesystem::path& path) {
    const auto found = file.find(name);
    if (found == file.end())
        throw FileError(path.string(), name, "an array of that name", "none");
    const TensorField like = TensorField::of<T>({0}, {});
    if (found->second.type != like.type || found->second.shape != shape)
        throw FileError(path.string(), name, "an array laid out as this run's",
                        "another type or shape");
    return found->second.template values<T>();
}

} // namespace rapport
