#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace rapport {

/// No draft has more ends, more picks or more crossings than this; a file that says so is refused
/// before anything of that size is allocated.
inline constexpr int kMaxThreads = 100'000;
inline constexpr int64_t kMaxCrossings = 100'000'000;

/// A weave draft as interlacement: which yarn is on top where end and pick cross, seen from the
/// face. End 1 is leftmost (x = 0), pick 1 is at the bottom (y = 0).
struct Draft {
    int ends = 0;
    int picks = 0;
    std::vector<uint8_t> warp_up; ///< [pick][end], 1 = the end passes over the pick

    /// Indices of the ends on no shaft and of the picks that raise (or sink) no shaft, ascending:
    /// places that the draft leaves open. weavable() drops them.
    std::vector<int> unthreaded_ends, empty_picks;

    /// Index into `palette` of each end and pick; empty if the draft says nothing of colour.
    std::vector<int> warp_colours, weft_colours;
    std::vector<std::array<double, 3>> palette; ///< sRGB-encoded, 0 … 1
    std::vector<int> palette_numbers;           ///< what the draft calls the palette's colours

    /// Which of its cloth's named yarns each end and pick is; empty if all are alike.
    std::vector<int> warp_yarns, weft_yarns;

    std::vector<std::string> warnings; ///< in a person's words, one line each

    bool up(int end, int pick) const { return warp_up[size_t(pick) * ends + end] != 0; }
    void set_up(int end, int pick, bool up) { warp_up[size_t(pick) * ends + end] = up; }
};

/// A weave that its words or rows do not describe.
struct InvalidWeave : std::invalid_argument {
    InvalidWeave(const std::string& expected, const std::string& found);
    std::string expected, found;
};

/// Reads a Weaving Information File. Sparse and untidy files are read with warnings; what makes
/// the interlacement ambiguous is a FileError.
Draft read_wif(const std::filesystem::path& path);

/// The repeat of
///   plain               1/1;
///   twill a/b Z | S     each end over a picks, then under b; Z rises to the right, S to the left;
///   satin n/s           warp-faced on n ends: from each pick to the next the one place where the
///                       weft lies on top moves s ends to the right;
///   sateen n/s          weft-faced: the same with the end on top;
///   basket n            n ends and n picks at a time woven as one in plain weave.
/// Letter case and the amount of space do not matter. Throws InvalidWeave saying what is valid.
Draft named_weave(std::string_view name);

/// From strings of '0' and '1', pick 1 first, end 1 leftmost. Throws InvalidWeave.
Draft draft_from_rows(const std::vector<std::string>& rows);

/// The interlacement as such rows.
std::vector<std::string> draft_rows(const Draft& draft);

} // namespace rapport
