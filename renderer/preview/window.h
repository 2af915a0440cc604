#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <span>
#include <string>

struct GLFWwindow;

namespace rapport {

/// A window with OpenGL 3.3 and Dear ImGui, which draws all that is seen in it. One at a time.
class Window {
  public:
    static constexpr float kFontSize = 14; ///< on a screen of 96 dpi

    /// FileError where there is no display, or none with OpenGL 3.3.
    Window(const std::string& title, const glm::ivec2& size);
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;
    ~Window();

    /// False once the person has closed it.
    bool open() const;
    bool minimised() const;
    /// Whether the graphics driver was reset and has forgotten all pictures of this window; another
    /// window has to take its place. Asks drivers that can tell.
    bool lost() const;
    glm::ivec2 size() const; ///< in the system's coordinates
    /// Waits for input, but no longer than so [s], and starts a frame.
    void begin_frame(double longest_wait);
    /// Shows the frame, and writes it as a PNG if a file is named.
    void end_frame(const std::filesystem::path& screenshot = {});
    /// Framebuffer pixels to a unit of ImGui's coordinates.
    float pixel_ratio() const;
    /// Size of text and of what is clicked in ImGui's coordinates, relative to a screen of 96 dpi,
    /// and the pixels to a unit of these, for letters as sharp as the screen. It follows the window
    /// from screen to screen; between frames only.
    void set_text_scale(float scale, float pixels = 1);

  private:
    void follow_screen();

    GLFWwindow* window_ = nullptr;
    float screen_scale_ = 1, pixel_ratio_ = 1; ///< that the text has followed
};

/// A picture for ImGui, while its window is open.
class Texture {
  public:
    Texture();
    Texture(const Texture&) = delete;
    Texture& operator=(const Texture&) = delete;
    ~Texture();

    /// RGBA, row 0 at the top.
    void set(std::span<const uint8_t> bytes, int width, int height);
    void* id() const { return reinterpret_cast<void*>(static_cast<uintptr_t>(name_)); }
    bool empty() const { return empty_; }

  private:
    unsigned name_ = 0;
    bool empty_ = true;
};

} // namespace rapport
