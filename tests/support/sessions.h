#pragma once

#include "renderer/preview/session.h"
#include "tests/support/file_bytes.h"
#include "tests/support/gltf_models.h"
#include "tests/support/synthetic_tables.h"
#include "tests/support/temporary_folder.h"

#include <chrono>
#include <functional>
#include <gtest/gtest.h>
#include <thread>

// A session on a small scene of its own: a square of cloth under a sky and a lamp.

namespace rapport::tests {

inline constexpr const char* kSquareScene = R"(Scale -1 1 1
LookAt 0.5 0.5 3  0.5 0.5 0  0 1 0
Camera "perspective" "float fov" 30
Film "rgb" "integer xresolution" 64 "integer yresolution" 48
Sampler "sobol" "integer pixelsamples" 16
Integrator "path" "integer maxdepth" 3
WorldBegin
LightSource "infinite" "rgb L" [0.5 0.5 0.6]
AttributeBegin
  AreaLightSource "diffuse" "rgb L" [8 8 8]
  Shape "trianglemesh" "point3 P" [-1 2 2  0 2 2  0 3 1  -1 3 1] "integer indices" [0 2 1 0 3 2]
AttributeEnd
MakeNamedMaterial "Body" "string type" "cloth" "string filename" "CLOTH"
Shape "gltf" "string filename" "square.glb" "integer level" 0
)";

/// A coarse cloth that is quickly measured; `colour` is its warp's in red.
inline std::string coarse_cloth(const std::string& colour) {
    const std::string yarn =
        "section = \"parallel\"\nfibres = 3\nwidth_um = 200\nheight_um = 120\n";
    const std::string fibre = "diameter_um = 60\nrefractive_index = 1.5\n";
    return "name = \"coarse\"\nweave = \"plain\"\n[warp]\nends_per_cm = 20\n" + yarn +
           "[warp.fibre]\n" + fibre + "color = [" + colour + ", 0.3, 0.3]\n[weft]\n" +
           "picks_per_cm = 20\n" + yarn + "[weft.fibre]\n" + fibre + "color = [0.3, 0.3, 0.3]\n";
}

/// The scene in a folder of its own, in a cloth that is measured on the way or in a stored table.
class SquareScene {
  public:
    enum class Worn { measured, stored };
    explicit SquareScene(Worn worn) {
        GltfWriter model = quad();
        model.json["materials"] = {{{"name", "Body"}}};
        model.json["meshes"][0]["primitives"][0]["material"] = 0;
        write_bytes(folder_ / "square.glb", model.glb());
        write_bytes(cloth(), coarse_cloth("0.3"));
        if (worn == Worn::stored)
            write_table(synthetic_table(satin_intensity), table());
        std::string text = kSquareScene;
        text.replace(text.find("CLOTH"), 5, worn == Worn::stored ? "table.bsdf" : "cloth.toml");
        write_bytes(scene(), text);
    }
    std::filesystem::path scene() const { return folder_ / "scene.pbrt"; }
    std::filesystem::path cloth() const {
        return std::filesystem::weakly_canonical(folder_ / "cloth.toml");
    }
    std::filesystem::path table() const { return folder_ / "table.bsdf"; }
    std::filesystem::path operator/(const std::string& name) const { return folder_ / name; }

  private:
    TemporaryFolder folder_;
};

/// Ticks as a window does until `done`; fails after so many seconds, which the sanitizers on a busy
/// machine do not need.
inline bool tick_until(Session& session, const std::function<bool()>& done, double seconds = 300) {
    const auto until = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
    while (std::chrono::steady_clock::now() < until) {
        session.tick();
        if (done())
            return true;
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    ADD_FAILURE() << "nothing came within " << seconds << " s";
    return false;
}

/// The next picture of what the session shows now, of at least so many samples at full resolution.
inline std::shared_ptr<const TracedPicture> next_picture(Session& session, int samples) {
    session.tick();
    const uint64_t view = session.tracer().latest();
    std::shared_ptr<const TracedPicture> picture;
    tick_until(session, [&] {
        picture = session.picture();
        return picture && picture->view >= view && picture->scale == 1 &&
               picture->samples >= samples;
    });
    return picture;
}

} // namespace rapport::tests
