#pragma once

#include "vgsp/cloth.h"
#include "vgsp/toml_reader.h"

namespace rapport {

/// The yarn whose keys (cloth.h) `file` has; it may have the other keys `keys` too.
YarnSpec read_yarn(const TomlReader& file, std::vector<std::string_view> keys, size_t bands);

/// Its keys, such that read_yarn() gives the same yarn. Fineness is told as number and diameter.
toml::table yarn_table(const YarnSpec& yarn);

/// The dye whose keys `file` has, if any; the other keys are not looked at.
Dye read_dye(const TomlReader& file, size_t bands);
void add_dye(const Dye& dye, toml::table& table);

template <class T> toml::array toml_array(const std::vector<T>& values) {
    toml::array array;
    for (const T& value : values)
        array.push_back(value);
    return array;
}

} // namespace rapport
