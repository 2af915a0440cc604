#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace rapport {

/// Named float channels on a pixel grid; row 0 is the top.
struct Image {
    int width = 0, height = 0;
    std::vector<std::string> channels;
    std::vector<std::vector<float>> data; ///< one plane per channel, width·height each
    std::map<std::string, std::string> attributes;

    Image() = default;
    Image(int width, int height, std::vector<std::string> channels);
    /// Plane of that name, or nullptr.
    const std::vector<float>* find(const std::string& channel) const;
    std::vector<float>* find(const std::string& channel);
};

/// OpenEXR: any channel names and depths are read as float; written as float, ZIP, whole or not at
/// all. A damaged, truncated, or non-EXR file is a FileError.
Image read_exr(const std::filesystem::path& path);
void write_exr(const Image& image, const std::filesystem::path& path);

/// The R, G, B channels under the sRGB curve, clipped to [0, 1], 8 bits.
void write_png(const Image& image, const std::filesystem::path& path);

/// How two images differ in R, G and B.
struct ImageDifference {
    double max_absolute = 0, mean_absolute = 0, rms = 0, relative_mse = 0;
    int worst_x = 0, worst_y = 0;
    /// With variance.* in both: the share of pixel channels whose z-score exceeds 3, the smallest
    /// Šidák-corrected p-value over all, and whether the images agree (significance 0.01, and no
    /// systematic offset of the mean).
    bool tested = false;
    double share_beyond_3_sigma = 0, p_value = 1, mean_z = 0;
    bool agree = true;
};
/// Throws std::invalid_argument when sizes or channels do not match.
ImageDifference compare(const Image& a, const Image& b);

} // namespace rapport
