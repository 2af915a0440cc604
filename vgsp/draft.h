#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace rapport {

/// A weave draft as interlacement: which yarn is on top where end and pick cross, seen from the
/// face. End 1 is leftmost (x = 0), pick 1 is at the bottom (y = 0).
struct Draft {
    int ends = 0;
    int picks = 0;
    std::vector<uint8_t> warp_up; ///< [pick][end], 1 = the end passes over the pick

    /// Index into `palette` of each end and pick; empty if the draft says nothing of colour.
    std::vector<int> warp_colours, weft_colours;
    std::vector<std::array<double, 3>> palette; ///< sRGB-encoded, 0 … 1

    std::vector<std::string> warnings; ///< in a person's words, one line each

    bool up(int end, int pick) const { return warp_up[size_t(pick) * ends + end] != 0; }
    void set_up(int end, int pick, bool up) { warp_up[size_t(pick) * ends + end] = up; }
};

/// Reads a Weaving Information File. Sparse and untidy files are read with warnings; what makes
/// the interlacement ambiguous is a FileError.
Draft read_wif(const std::filesystem::path& path);

/// "plain"; "twill a/b Z" or "twill a/b S" (over a, under b; Z rises to the right); "satin n/s"
/// (n ends, move s, warp-faced) and "sateen n/s" (weft-faced); "basket n". FileError-free: throws
/// std::invalid_argument with the list of what is valid.
Draft named_weave(std::string_view name);

/// From strings of '0' and '1', pick 1 first, end 1 leftmost. Throws std::invalid_argument.
Draft draft_from_rows(const std::vector<std::string>& rows);

/// The interlacement as such rows.
std::vector<std::string> draft_rows(const Draft& draft);

} // namespace rapport
