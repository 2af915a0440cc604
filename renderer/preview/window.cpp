#include "renderer/preview/window.h"

#include "renderer/core/error.h"
#include "renderer/core/png.h"
#include "renderer/preview/font.h"

#include <algorithm>
#include <epoxy/gl.h> // before GLFW, which else brings its own
// clang-format off
#include <GLFW/glfw3.h>
// clang-format on
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <filesystem>
#include <imgui.h>
#include <vector>

namespace rapport {
namespace {

std::string reason() {
    const char* text = nullptr;
    glfwGetError(&text);
    return text ? text : "no reason given";
}

/// Letters of the font that the panels use: Latin, Greek, and signs such as × and ².
void load_font(float size) {
    static const ImWchar ranges[] = {0x20, 0xFF, 0x370, 0x3FF, 0x2010, 0x2033, 0x2190, 0x21FF, 0};
    ImFontAtlas& fonts = *ImGui::GetIO().Fonts;
    if (std::filesystem::exists(kFont)) {
        fonts.AddFontFromFileTTF(kFont, size, nullptr, ranges);
    } else {
        ImFontConfig config;
        config.SizePixels = size;
        fonts.AddFontDefault(&config);
    }
}

void set_style(float scale) {
    ImGuiStyle& style = ImGui::GetStyle();
    style = {};
    ImGui::StyleColorsDark();
    style.WindowRounding = style.WindowBorderSize = 0;
    style.FrameRounding = style.GrabRounding = 3;
    style.ItemSpacing = {8, 5};
    for (const ImGuiCol grey : {ImGuiCol_WindowBg, ImGuiCol_ChildBg})
        style.Colors[grey] = {0.11f, 0.11f, 0.12f, 1};
    style.Colors[ImGuiCol_SliderGrab] = {0.26f, 0.45f, 0.72f, 0.75f};
    style.GrabMinSize = 7;
    style.Colors[ImGuiCol_FrameBg] = {0.20f, 0.20f, 0.22f, 1};
    style.Colors[ImGuiCol_Header] = {0.24f, 0.25f, 0.28f, 1};
    style.ScaleAllSizes(scale);
}

void write_back_buffer(int width, int height, const std::filesystem::path& file) {
    const size_t row = 3 * static_cast<size_t>(width);
    std::vector<uint8_t> bytes(row * height);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, 0, width, height, GL_RGB, GL_UNSIGNED_BYTE, bytes.data());
    for (int y = 0; y < height / 2; ++y) // OpenGL's row 0 is at the bottom
        std::swap_ranges(bytes.begin() + row * y, bytes.begin() + row * (y + 1),
                         bytes.end() - row * (y + 1));
    write_png_bytes(bytes, width, height, 3, file);
}

} // namespace

Window::Window(const std::string& title, const glm::ivec2& size) {
    if (!glfwInit())
        throw FileError("window", "", "a display", reason());
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    glfwWindowHint(GLFW_SCALE_TO_MONITOR, GLFW_TRUE);
    glfwWindowHint(GLFW_CONTEXT_ROBUSTNESS, GLFW_LOSE_CONTEXT_ON_RESET); // where there is that
    window_ = glfwCreateWindow(size.x, size.y, title.c_str(), nullptr, nullptr);
    if (!window_) {
        const std::string why = reason();
        glfwTerminate();
        throw FileError("window", "", "a display with OpenGL 3.3", why);
    }
    glfwMakeContextCurrent(window_);
    glfwSwapInterval(1);

    IMGUI_CHECKVERSION();
    ImGui::CreateContext();
    ImGui::GetIO().IniFilename = nullptr; // leaves no file behind
    ImGui_ImplGlfw_InitForOpenGL(window_, true);
    ImGui_ImplOpenGL3_Init("#version 330 core");
    set_text_scale(1);
    follow_screen();
}

Window::~Window() {
    ImGui_ImplOpenGL3_Shutdown();
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
    glfwDestroyWindow(window_);
    glfwTerminate();
}

bool Window::open() const { return !glfwWindowShouldClose(window_); }

bool Window::minimised() const {
    int width, height;
    glfwGetFramebufferSize(window_, &width, &height);
    return width == 0 || height == 0 || glfwGetWindowAttrib(window_, GLFW_ICONIFIED);
}

bool Window::lost() const {
    if (epoxy_gl_version() >= 45 || epoxy_has_gl_extension("GL_KHR_robustness"))
        return glGetGraphicsResetStatus() != GL_NO_ERROR;
    if (epoxy_has_gl_extension("GL_ARB_robustness"))
        return glGetGraphicsResetStatusARB() != GL_NO_ERROR;
    return false;
}

glm::ivec2 Window::size() const {
    glm::ivec2 size;
    glfwGetWindowSize(window_, &size.x, &size.y);
    return size;
}

void Window::set_text_scale(float scale, float pixels) {
    ImGui::GetIO().Fonts->Clear();
    load_font(std::round(kFontSize * scale * pixels));
    ImGui::GetIO().FontGlobalScale = 1 / pixels;
    set_style(scale);
    ImGui_ImplOpenGL3_DestroyFontsTexture();
    ImGui_ImplOpenGL3_CreateFontsTexture();
}

void Window::follow_screen() {
    float screen, screen_y;
    glfwGetWindowContentScale(window_, &screen, &screen_y);
    screen = std::clamp(screen, 0.5f, 4.0f);
    int pixels, height;
    glfwGetFramebufferSize(window_, &pixels, &height);
    const int units = size().x; // 0 while it is minimised
    float ratio = pixel_ratio_;
    if (units > 0 &&
        pixels > 0) // to an eighth: a window's size is rounded, its screen's ratio is not
        ratio = std::max(1.0f, std::round(8.0f * static_cast<float>(pixels) / units)) / 8;
    if (screen == screen_scale_ && ratio == pixel_ratio_)
        return;
    screen_scale_ = screen;
    pixel_ratio_ = ratio;
    set_text_scale(screen / ratio, ratio);
}

void Window::begin_frame(double longest_wait) {
    glfwWaitEventsTimeout(longest_wait);
    follow_screen();
    ImGui_ImplOpenGL3_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    ImGui::NewFrame();
}

void Window::end_frame(const std::filesystem::path& screenshot) {
    ImGui::Render();
    int width, height;
    glfwGetFramebufferSize(window_, &width, &height);
    glViewport(0, 0, width, height);
    glClearColor(0, 0, 0, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
    if (!screenshot.empty())
        write_back_buffer(width, height, screenshot);
    glfwSwapBuffers(window_);
}

float Window::pixel_ratio() const { return ImGui::GetIO().DisplayFramebufferScale.x; }

Texture::Texture() {
    glGenTextures(1, &name_);
    glBindTexture(GL_TEXTURE_2D, name_);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
}

Texture::~Texture() { glDeleteTextures(1, &name_); }

void Texture::set(std::span<const uint8_t> bytes, int width, int height) {
    glBindTexture(GL_TEXTURE_2D, name_);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, width, height, 0, GL_RGBA, GL_UNSIGNED_BYTE,
                 bytes.data());
    empty_ = false;
}

} // namespace rapport
