#pragma once

#include "vgsp/cloth.h"
#include "vgsp/toml_reader.h"

namespace rapport {

/// The colourways that `file`, the root of a cloth file, tells of; `cloth` has its yarns already.
Cloth::ColourwayDyes read_colourways(const TomlReader& file, const Cloth& cloth);

/// Their table, such that read_colourways() gives the same.
toml::table colourway_table(const Cloth::ColourwayDyes& colourways);

} // namespace rapport
