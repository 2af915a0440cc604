#pragma once

#include <filesystem>

namespace rapport {

/// Draws what is in a file as a PNG: of a draft the drawdown; of a cloth the micro-element from
/// above and cut along its first pick and its first end, fibres coloured by their yarn; of a table
/// where light from three directions goes, reflected above and transmitted below. FileError for
/// files of other kinds.
void draw_picture(const std::filesystem::path& file, const std::filesystem::path& png);

} // namespace rapport
