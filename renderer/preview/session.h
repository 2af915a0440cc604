#pragma once

#include "renderer/preview/file_watch.h"
#include "renderer/preview/orbit_camera.h"
#include "renderer/preview/scene_source.h"
#include "renderer/preview/tone.h"
#include "renderer/preview/tracer.h"
#include "renderer/preview/wardrobe.h"

#include <future>

namespace rapport {

/// A cloth file while the window is open.
struct ClothDocument {
    std::shared_ptr<const Cloth> cloth;      ///< as edited; nothing for a stored table
    std::shared_ptr<const ClothTable> table; ///< the latest; of an older edition while waiting
    std::set<std::filesystem::path> inputs;  ///< the files that it was read from
    std::string error;                       ///< why there is none of this edition, or empty
    bool edited = false;                     ///< other than the file
    bool waiting = false;                    ///< for the first table of this edition
    uint64_t request = 0;                    ///< of the worker; 0 = none was made
};

/// All that happens in the window, without the window: a person's actions in, pictures out. To be
/// used from one thread, which never waits: reading, measuring and tracing happen in others.
class Session {
  public:
    /// Loads the scene; FileError where it cannot.
    explicit Session(SceneSource source, const LoadingWatch& watch = {});
    ~Session();

    // What a person does in the picture; positions and ways are in its pixels, y down.
    void resize(const glm::ivec2& resolution);
    void orbit(const glm::vec2& pixels);
    void pan(const glm::vec2& pixels);
    void zoom(float steps); ///< a notch of the wheel each, nearer if positive
    void focus(const glm::vec2& at);
    void frame_all();

    // What a person does in the panel.
    /// Of no file: what it is in the scene.
    void choose_cloth(const std::string& material, const ClothChoice& choice);
    void set_lights(const LightSettings& lights);
    void edit_cloth(const std::filesystem::path& file, Cloth cloth);
    /// Writes the cloth as edited, and goes on with that file; `notes` tells of it. Returns the
    /// file to go on with: `file` if that fails, as it does where the target is no .toml, or, but
    /// for `overwrite`, another file that there is already.
    std::filesystem::path save_cloth(const std::filesystem::path& file,
                                     const std::filesystem::path& target, bool overwrite = false);
    /// Writes the picture as it is: the EXR with all layers, the PNG as displayed. In the
    /// background; `notes` tells of it.
    void save_picture(const std::filesystem::path& exr, const std::filesystem::path& png);
    /// The same, named after the scene, in the working folder.
    void save_shown();
    /// A copy of the scene file, seen from where the camera is, beside it; `notes` tells of it.
    void save_camera();

    /// Writes all edited cloths, if any, into the working folder, named after their files; `notes`
    /// tells of it and of `why`.
    void rescue(const std::string& why);

    /// Takes in what the background has finished and what changed on the disk; once a frame.
    void tick();
    Tone tone; ///< of the display

    // What there is to see.
    std::shared_ptr<const TracedPicture> picture() const { return tracer_.picture(); }
    const Camera& camera() const { return camera_->camera(); }
    const Scene& scene() const { return *base_; }
    const ClothChoices& choices() const { return choices_; }
    bool edited() const; ///< whether there are cloths other than their files
    bool worn(const std::filesystem::path& file) const;
    const std::set<std::string>& wearers() const { return wearers_; }
    const LightSettings& lights() const { return lights_; }
    const LightKinds& light_kinds() const { return light_kinds_; }
    const std::map<std::filesystem::path, ClothDocument>& documents() const { return documents_; }
    /// Cloth files beside those in use and the scene and in the working folder, sorted.
    const std::vector<std::filesystem::path>& shelf() const { return shelf_; }
    const SceneSource& source() const { return source_; }
    bool reloading() const { return reload_.valid(); }
    /// What went wrong with the scene or the picture, or empty; the old scene stays.
    std::string error() const;
    /// What was done, the latest last.
    const std::vector<std::string>& notes() const { return notes_; }
    const Tracer& tracer() const { return tracer_; }
    const ClothWorker& worker() const { return worker_; }

  private:
    struct Reload {
        LoadedScene loaded;
        std::set<std::filesystem::path> inputs;
        std::exception_ptr failure; ///< or nothing
    };
    static Reload load(const SceneSource& source, const ClothTables& known,
                       const LoadingWatch& watch, const StopSignal& stopped);

    /// Writes a cloth as edited into the working folder, under a name of its own.
    void rescue(const std::filesystem::path& file, const Cloth& cloth);
    /// Runs what writes files; what goes wrong becomes a note.
    void attempt(const std::function<void()>& action);
    void go_on_with(const std::filesystem::path& target, const std::filesystem::path& file);
    void take(Reload reload); ///< throws its failure
    /// Has the cloth measured, unless it is already.
    void open(const std::filesystem::path& file);
    void ask(const std::filesystem::path& file, std::shared_ptr<const Cloth> cloth);
    void take_news();
    void look_at_files();
    /// Has the cloth read again, for `changed`, one of its files, is another now.
    void reread(const std::filesystem::path& file, const std::filesystem::path& changed);
    void read_from(ClothDocument& document, const std::set<std::filesystem::path>& inputs);
    /// Of what the view shows, whether much is seen larger than it was cut for.
    bool seen_too_coarsely() const;
    /// Has surfaces cut anew where the view rests that shows them too coarsely.
    void look_at_surfaces();
    void start_reload();
    void finish_reload();
    void fill_shelf();
    void show();
    void restart() { stale_ = true; }
    /// The same for another view.
    void look_anew();

    SceneSource source_;
    std::shared_ptr<const Scene> base_; ///< as it was loaded
    std::shared_ptr<const Scene> worn_; ///< as it is shown
    Box subject_;
    std::optional<OrbitCamera> camera_;
    ClothChoices choices_;
    ClothChoices own_choices_; ///< those that a person made, which outlive a reload
    std::set<std::string> wearers_;
    LightSettings lights_;
    LightKinds light_kinds_;
    std::map<std::filesystem::path, ClothDocument> documents_;
    std::vector<std::filesystem::path> shelf_;
    FileWatch watch_;
    std::set<std::filesystem::path> scene_inputs_; ///< the files that the scene was read from
    std::string scene_error_;
    std::vector<std::string> notes_;
    bool stale_ = true;          ///< the picture is of another view
    bool redress_ = false;       ///< and of other cloths or lights
    bool scene_changed_ = false; ///< on the disk, since it was last loaded
    using Clock = std::chrono::steady_clock;
    Clock::time_point moved_; ///< the view, for the last time
    bool refined_ = true;     ///< or the view has moved since it was last looked at how finely
    bool refining_ = false;   ///< what is being loaded is the same, but cut anew
    std::atomic<bool> stop_reload_ = false;
    std::future<Reload> reload_;
    std::future<std::string> saving_;
    ClothWorker worker_;
    Tracer tracer_;
};

} // namespace rapport
