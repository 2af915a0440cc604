#pragma once

namespace rapport {

/// DejaVu Sans (Debian: fonts-dejavu-core), which has Greek letters and typographic signs. Where it
/// is not, Dear ImGui's own font serves.
inline constexpr const char* kFont = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";

} // namespace rapport
