#include "renderer/preview/hemisphere.h"

#include <algorithm>

namespace rapport {

glm::vec3 disc_direction(const glm::vec2& position, Side side) {
    const float length = glm::length(position);
    constexpr float kLargest = 0.9998f; // 88.9°: just above the horizon
    const glm::vec2 inside = length > kLargest ? position * (kLargest / length) : position;
    const float height = safe_sqrt(1 - glm::dot(inside, inside));
    return {inside, side == Side::front ? height : -height};
}

std::vector<uint8_t> hemisphere_map(const TableBsdf& table, const glm::vec3& from, Side seen,
                                    int size) {
    std::vector<Rgb> values(static_cast<size_t>(size) * size, Rgb(-1));
    float brightest = 0;
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) {
            const glm::vec2 position(2 * (x + 0.5f) / size - 1, 1 - 2 * (y + 0.5f) / size);
            if (glm::length(position) > 1)
                continue;
            const Rgb value = table.eval(from, disc_direction(position, seen));
            values[static_cast<size_t>(y) * size + x] = value;
            brightest = std::max({brightest, value.r, value.g, value.b});
        }
    std::vector<uint8_t> bytes(4 * values.size(), 0);
    for (size_t i = 0; i < values.size(); ++i) {
        if (values[i].r < 0)
            continue;
        for (int c = 0; c < 3; ++c) {
            const float root = brightest > 0 ? std::sqrt(values[i][c] / brightest) : 0;
            bytes[4 * i + c] = static_cast<uint8_t>(255 * root + 0.5f);
        }
        bytes[4 * i + 3] = 255;
    }
    return bytes;
}

std::vector<float> intensity_profile(const TableBsdf& table, const glm::vec3& from, Side seen,
                                     bool along_warp, int count) {
    std::vector<float> profile;
    for (int i = 0; i < count; ++i) {
        const float theta = static_cast<float>(kPi) * ((i + 0.5f) / count - 0.5f);
        const float across = std::sin(theta);
        const float along = seen == Side::front ? std::cos(theta) : -std::cos(theta);
        const Rgb value =
            table.eval(from, {along_warp ? 0 : across, along_warp ? across : 0, along});
        profile.push_back((value.r + value.g + value.b) / 3);
    }
    return profile;
}

} // namespace rapport
