#pragma once

#include <CLI/CLI.hpp>

#include <cstdint>
#include <filesystem>
#include <string>

namespace rapport {

/// Options that every subcommand takes.
struct CommonOptions {
    int threads = 0; ///< 0 = as many as the machine has
    uint64_t seed = 0;
    bool quiet = false;
};

// Each adds one subcommand, whose callback does the work; a check that fails sets `status` to 1.
void add_vgsp_command(CLI::App& app, const CommonOptions& common);
void add_render_command(CLI::App& app, const CommonOptions& common);
void add_view_command(CLI::App& app, const CommonOptions& common);
void add_diff_command(CLI::App& app, int& status);
void add_info_command(CLI::App& app);
void add_export_command(CLI::App& app, const CommonOptions& common);

// Checks of options that are numbers: CLI11's own let NaN through, and a minus before what has no
// sign.
CLI::Validator finite_number(double least, double most);
CLI::Validator positive_number();
CLI::Validator non_negative_number();
CLI::Validator whole_number(uint64_t least);

/// True when standard error is a terminal and progress is wanted.
bool shows_progress(const CommonOptions& common);

} // namespace rapport
