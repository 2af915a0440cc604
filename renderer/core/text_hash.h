#pragma once

#include <cstdint>
#include <fmt/format.h>
#include <string>
#include <string_view>

namespace rapport {

/// FNV-1a, 64 bits, as "fnv1a64:" and 16 digits: tells one text from another, the same on every
/// machine. No defence against forgery.
inline std::string text_hash(std::string_view text) {
    uint64_t hash = 0xcbf29ce484222325;
    for (const char character : text)
        hash = (hash ^ static_cast<unsigned char>(character)) * 0x100000001b3;
    return fmt::format("fnv1a64:{:016x}", hash);
}

} // namespace rapport
