#pragma once

#include <filesystem>

namespace rapport {

/// Draws what is in a file as a PNG or SVG, by the ending of `target`: of a draft the drawdown; of
/// a cloth the micro-element (element_picture.h); of a table where light goes, and its error
/// (table_picture.h); of a model the frames that a cloth would lie along. FileError for files of
/// other kinds.
void draw_picture(const std::filesystem::path& file, const std::filesystem::path& target);

} // namespace rapport
