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

/// OpenEXR: any channel names and depths are read as float, the pixels of the data window; written
/// as float, ZIP, whole or not at all. Attributes are those of string type. A damaged, truncated,
/// or non-EXR file is a FileError, and so is one with several parts, deep pixels or subsampled
/// channels.
Image read_exr(const std::filesystem::path& path);
void write_exr(const Image& image, const std::filesystem::path& path);

/// The R, G, B channels under the sRGB curve, clipped to [0, 1], 8 bits. Throws
/// std::invalid_argument if one is missing.
void write_png(const Image& image, const std::filesystem::path& path);

/// How two images differ in R, G and B. A value that is not finite in one image alone, or NaN in
/// either, differs by infinity.
struct ImageDifference {
    double max_absolute = 0, mean_absolute = 0, rms = 0;
    double relative_mse = 0; ///< mean of Δ² / (b² + 0.01)
    int worst_x = 0, worst_y = 0;

    /// Whether both images carry variance.*, the variance of each pixel's mean, so that noise can
    /// be told from difference. Then Δ is compared with its standard error for every pixel, every
    /// tile of 8 × 8 pixels, and the whole image, which find spots, regions, and a systematic
    /// offset too small to be seen in any one pixel. A pixel's standard error is the larger of
    /// what the two images tell of it.
    bool tested = false;
    double share_beyond_3_sigma = 0; ///< of the pixel channels
    double mean_z = 0; ///< z-score of the mean's offset, in the channel where it is largest
    /// Chance of differences as significant as the most significant one if both images have the
    /// same expectation, corrected for the number of tests.
    double p_value = 1;
    /// p_value ≥ 0.01; without variance, whether the images are equal.
    bool agree = true;
};

/// Compares `a` with `b`. The test takes pixels as independent (no filter wider than a pixel) and
/// their variances as estimated from at least 16 samples each. Throws std::invalid_argument when
/// sizes or channels do not match, or a variance is negative or not finite.
ImageDifference compare(const Image& a, const Image& b);

} // namespace rapport
