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

/// True when standard error is a terminal and progress is wanted.
bool shows_progress(const CommonOptions& common);

} // namespace rapport
