#include "renderer/core/image.h"

#include <algorithm>
#include <utility>

namespace rapport {

Image::Image(int width, int height, std::vector<std::string> channels)
    : width(width), height(height), channels(std::move(channels)),
      data(this->channels.size(),
           std::vector<float>(static_cast<size_t>(width) * static_cast<size_t>(height))) {}

const std::vector<float>* Image::find(const std::string& channel) const {
    const auto found = std::ranges::find(channels, channel);
    return found == channels.end() ? nullptr : &data[found - channels.begin()];
}

std::vector<float>* Image::find(const std::string& channel) {
    return const_cast<std::vector<float>*>(std::as_const(*this).find(channel));
}

} // namespace rapport
