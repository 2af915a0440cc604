#include "renderer/app/lettering.h"

#include "renderer/preview/font.h"

#include <cmath>
#include <filesystem>
#include <imgui.h>

namespace rapport {
namespace {

constexpr float kSize = 12;

/// Dear ImGui's atlas of letters as pixels of memory: it needs no window.
class Letters {
  public:
    Letters() {
        static const ImWchar ranges[] = {0x20, 0xFF, 0x370, 0x3FF, 0x2010, 0x2033, 0};
        ImFontConfig config;
        config.SizePixels = kSize;
        config.OversampleH = 1; // a pixel of the atlas is one of the picture
        config.PixelSnapH = true;
        font_ = std::filesystem::exists(kFont)
                    ? atlas_.AddFontFromFileTTF(kFont, std::round(1.2f * kSize), &config, ranges)
                    : atlas_.AddFontDefault(&config);
        int height;
        atlas_.GetTexDataAsAlpha8(&pixels_, &width_, &height);
        height_ = height;
    }

    /// Calls visit(glyph, pen) for each letter; returns where the pen ends.
    template <class Visit> double each(const std::string& words, const Visit& visit) const {
        double pen = 0;
        for (size_t i = 0; i < words.size();) {
            const ImFontGlyph& glyph = *font_->FindGlyph(static_cast<ImWchar>(next(words, i)));
            visit(glyph, pen);
            pen += glyph.AdvanceX;
        }
        return pen;
    }
    float ascent() const { return font_->Ascent; }
    float coverage(const ImFontGlyph& glyph, int x, int y) const {
        const int u = static_cast<int>(std::lround(glyph.U0 * width_)) + x;
        const int v = static_cast<int>(std::lround(glyph.V0 * height_)) + y;
        return pixels_[v * width_ + u] / 255.0f;
    }

  private:
    /// Decodes UTF-8 of at most three bytes.
    static uint32_t next(const std::string& words, size_t& i) {
        const auto byte = [&] { return static_cast<uint8_t>(i < words.size() ? words[i++] : 0); };
        const uint32_t first = byte();
        if (first < 0x80)
            return first;
        if (first < 0xE0)
            return (first & 0x1F) << 6 | (byte() & 0x3F);
        const uint32_t second = byte() & 0x3F;
        return (first & 0x0F) << 12 | second << 6 | (byte() & 0x3F);
    }

    ImFontAtlas atlas_;
    ImFont* font_;
    unsigned char* pixels_;
    int width_, height_;
};

const Letters& letters() {
    static const Letters made;
    return made;
}

} // namespace

double text_width(const std::string& words) {
    return letters().each(words, [](const ImFontGlyph&, double) {});
}

void draw_text(Canvas& canvas, double x, double y, const std::string& words) {
    constexpr Canvas::Colour kBlack{0, 0, 0};
    letters().each(words, [&](const ImFontGlyph& glyph, double pen) {
        const int left = static_cast<int>(std::lround(x + pen + glyph.X0));
        const int top = static_cast<int>(std::lround(y - letters().ascent() + glyph.Y0));
        for (int v = 0; v < std::lround(glyph.Y1 - glyph.Y0); ++v)
            for (int u = 0; u < std::lround(glyph.X1 - glyph.X0); ++u)
                canvas.blend(left + u, top + v, kBlack, letters().coverage(glyph, u, v));
    });
}

} // namespace rapport
