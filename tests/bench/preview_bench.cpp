#include "renderer/preview/view.h"
#include "tests/support/virtual_display.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <thread>

// What a person at the window of `rapport view` waits for, at 1280 × 720: a window on a display
// without a screen opens, and then the session does what it does under the window, without one.
//
//   build/tests/tests/preview_bench [CLOTH.toml]

namespace rapport {
namespace {

using Clock = std::chrono::steady_clock;
constexpr glm::ivec2 kSize{1280, 720};
constexpr auto kFrame = std::chrono::milliseconds(16);

double since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

double wait(Session& session, const std::function<bool()>& done) {
    const Clock::time_point start = Clock::now();
    for (session.tick(); !done(); session.tick())
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    return since(start);
}

void frames(Session& session, double seconds, const std::function<void()>& each) {
    for (const Clock::time_point start = Clock::now(); since(start) < seconds;) {
        each();
        session.tick();
        std::this_thread::sleep_for(kFrame);
    }
}

/// A picture that is there before a frame has been shown by the next one.
void open_window(const SceneSource& source) {
    if (!tests::VirtualDisplay::available()) {
        std::printf("no window: Xvfb (Debian: xvfb) is not here\n");
        return;
    }
    const tests::VirtualDisplay display;
    Session session(source);
    const Clock::time_point start = Clock::now();
    double open = 0;
    bool traced = false;
    const auto before_frame = [&](int frame) {
        if (frame == 0)
            open = since(start);
        if (traced) {
            std::printf("a window opens in %.0f ms and shows a picture %.0f ms later\n", 1e3 * open,
                        1e3 * (since(start) - open));
            glfwSetWindowShouldClose(glfwGetCurrentContext(), GLFW_TRUE);
        }
        traced = session.picture() != nullptr;
    };
    view(session, kSize, {0, {}, before_frame});
}

void orbit(Session& session) {
    constexpr double kSeconds = 4;
    std::set<uint64_t> views;
    int64_t pixels = 0;
    frames(session, kSeconds, [&] {
        session.orbit({4, 0});
        if (const auto picture = session.picture(); picture && views.insert(picture->view).second)
            pixels += picture->image.width;
    });
    std::printf("turning: %.1f pictures/s, %.0f pixels wide in the mean\n",
                static_cast<double>(views.size()) / kSeconds,
                static_cast<double>(pixels) / static_cast<double>(views.size()));
}

void stop_tracing(Session& session) {
    double longest = 0, sum = 0;
    constexpr int kTimes = 20;
    for (int i = 0; i < kTimes; ++i) {
        frames(session, 0.15 + 0.02 * i, [] {});
        session.orbit({1, 0});
        wait(session, [&] { return session.picture()->view == session.tracer().latest(); });
        longest = std::max(longest, session.tracer().seconds_to_stop());
        sum += session.tracer().seconds_to_stop();
    }
    std::printf("a view stops within %.1f ms in the mean, %.1f ms at most\n", 1e3 * sum / kTimes,
                1e3 * longest);
}

void edit(Session& session, const std::filesystem::path& file) {
    const auto document = [&]() -> const ClothDocument& { return session.documents().at(file); };
    Cloth cloth = *document().cloth;
    double longest = 0, sum = 0;
    constexpr int kTimes = 20;
    constexpr double kLongest = 3; // well into the second round
    for (int i = 0; i < kTimes; ++i) {
        cloth.picks_per_cm -= 0.05;
        session.edit_cloth(file, cloth);
        frames(session, 0.05 + kLongest * std::fmod(0.618 * i, 1), [] {});
        longest = std::max(longest, session.worker().seconds_to_stop());
        sum += session.worker().seconds_to_stop();
    }
    std::printf("a measurement stops within %.1f ms in the mean, %.1f ms at most\n",
                1e3 * sum / kTimes, 1e3 * longest);
    cloth.picks_per_cm -= 0.05;
    session.edit_cloth(file, cloth);
    wait(session, [&] { return !document().waiting; });
    std::printf("first table of an edited cloth: %.2f s, accuracy %.2f\n",
                document().table->seconds, document().table->accuracy);
    for (int better = 0; better < 3; ++better) {
        const auto last = document().table;
        wait(session, [&] { return document().table != last; });
        std::printf("a better one: %.2f s, accuracy %.2f\n", document().table->seconds,
                    document().table->accuracy);
    }
}

void without_window(const SceneSource& source, const std::filesystem::path& cloth) {
    const Clock::time_point start = Clock::now();
    Session session(source);
    std::printf("scene and first table: %.2f s\n", since(start));
    session.resize(kSize);
    std::printf("first picture: %.0f ms\n",
                1e3 * wait(session, [&] { return session.picture() != nullptr; }));
    orbit(session);
    const double full = wait(session, [&] {
        return session.picture()->view == session.tracer().latest() &&
               session.picture()->scale == 1;
    });
    std::printf("full resolution after %.1f s, %.2f Mrays/s\n", full,
                1e-6 * session.picture()->rays_per_second);
    stop_tracing(session);
    edit(session, cloth);
}

void run(const std::filesystem::path& cloth) {
    const std::filesystem::path scenes = std::filesystem::path(RAPPORT_SOURCE_DIR) / "scenes";
    const std::filesystem::path file = std::filesystem::weakly_canonical(
        cloth.empty() ? scenes / "cloths/quickstart.toml" : cloth);
    const SceneSource source{scenes / "quickstart.pbrt", {{"Body", file}}};
    without_window(source, file);
    open_window(source); // when nothing else is at work any more
}

} // namespace
} // namespace rapport

int main(int argc, char** argv) {
    std::setvbuf(stdout, nullptr, _IOLBF, 0);
    rapport::run(argc > 1 ? argv[1] : "");
}
