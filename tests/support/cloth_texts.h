#pragma once

#include "tests/support/file_bytes.h"
#include "tests/support/refusal.h"
#include "vgsp/cloth.h"

// Cloth files as text, read from a file of their own.

namespace rapport::tests {

inline constexpr std::string_view kCloth = R"(name = "test cloth"
weave = "twill 2/1 Z"
crimp_balance = 0.25

[warp]
ends_per_cm = 40
section = "parallel"
fibres = 37
width_um = 130.5
height_um = 90
flatten = 0.8
[warp.fibre]
diameter_um = 11.9
refractive_index = 1.526
absorption_per_um = [0.001, 0.002, 0.003]

[weft]
picks_per_cm = 30
section = "twisted"
fibres = 61
diameter_um = 150
twist_per_m = -700
[weft.fibre]
diameter_um = 12
refractive_index = 1.55
color = [0.5, 0.25, 0]
surface_absorption = 0.01
roughness = 0.2
)";

/// `text` with its only `old_words` replaced.
inline std::string replaced(std::string_view text, std::string_view old_words,
                            std::string_view new_words) {
    std::string changed(text);
    const size_t place = changed.find(old_words);
    EXPECT_NE(place, std::string::npos) << old_words;
    EXPECT_EQ(changed.find(old_words, place + 1), std::string::npos) << old_words;
    return changed.replace(place, old_words.size(), new_words);
}

inline Cloth read_text(std::string_view text) {
    const TemporaryFolder folder;
    return read_cloth(write_bytes(folder, "cloth.toml", text));
}

inline FileError refusal(std::string_view text) {
    return refusal_of([&] { read_text(text); });
}

} // namespace rapport::tests
