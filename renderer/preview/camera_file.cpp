#include "renderer/preview/camera_file.h"

#include "renderer/core/atomic_file.h"
#include "renderer/core/error.h"
#include "renderer/core/input_file.h"
#include "renderer/scene/pbrt/pbrt_lexer.h"

#include <fmt/format.h>
#include <sstream>

namespace rapport {
namespace {

/// The line of the Camera directive, counted from 1, and its column.
PbrtToken find_camera(const std::filesystem::path& scene) {
    PbrtLexer lexer(scene);
    for (PbrtToken token = lexer.next(); token.kind != PbrtToken::Kind::end; token = lexer.next())
        if (token.kind == PbrtToken::Kind::identifier && token.text == "Camera")
            return token;
    throw FileError(scene.string(), "", "a Camera of its own, not in an included file", "none");
}

std::string transform_text(const glm::mat4& matrix) {
    std::string text = "Transform [";
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row)
            text += fmt::format(" {}", matrix[column][row]);
    return text + " ]\n";
}

} // namespace

void save_camera(const Camera& camera, const std::filesystem::path& scene,
                 const std::filesystem::path& copy) {
    const PbrtToken place = find_camera(scene);
    std::ostringstream read;
    read << open_input(scene).stream.rdbuf();
    std::string text = read.str();
    size_t at = 0;
    for (int line = 1; line < place.line; ++line)
        at = text.find('\n', at) + 1;
    at += static_cast<size_t>(place.column - 1);
    text.insert(at, transform_text(glm::inverse(camera.to_world)));
    write_stream_atomically(copy, [&](std::ofstream& stream) { stream << text; });
}

} // namespace rapport
