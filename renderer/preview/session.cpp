#include "renderer/preview/session.h"

#include "renderer/core/input_file.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace rapport {
namespace {

constexpr float kZoomStep = 1.15f;

/// Of all surfaces that could wear a cloth, or, if there are none, of all that do not shine.
Box subject_of(const Scene& scene) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    for (const bool with_uvs : {true, false}) {
        Box box{glm::vec3(kInfinity), glm::vec3(-kInfinity)};
        for (const Surface& surface : scene.surfaces()) {
            if (surface.emission != Rgb(0) || (with_uvs && surface.mesh->uvs.empty()))
                continue;
            for (const glm::vec3& p : surface.mesh->positions) {
                box.low = glm::min(box.low, p);
                box.high = glm::max(box.high, p);
            }
        }
        if (box.low.x <= box.high.x)
            return box;
    }
    return {};
}

/// The size of the film is the window's business.
bool same_but_for_size(Camera a, const Camera& b) {
    a.resolution = b.resolution;
    return a == b;
}

bool ready(const auto& future) {
    return future.valid() && future.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

} // namespace

Session::Session(SceneSource source, const LoadingWatch& watch) : source_(std::move(source)) {
    take(load(source_, {}, watch, {}));
}

Session::~Session() { stop_reload_ = true; }

Session::Reload Session::load(const SceneSource& source, const ClothTables& known,
                              const LoadingWatch& watch, const StopSignal& stopped) {
    Reload reload;
    const InputLog log(InputLog::Of::names);
    try {
        reload.loaded = load_scene(source, known, watch, stopped);
    } catch (...) {
        reload.failure = std::current_exception();
    }
    reload.inputs = log.files();
    // What cloths are read from is their own business, not the scene's.
    for (const auto& [file, table] : reload.loaded.tables)
        for (const std::filesystem::path& input : table->inputs)
            reload.inputs.erase(input);
    return reload;
}

void Session::take(Reload reload) {
    for (const std::filesystem::path& file : reload.inputs)
        watch_.keep(file);
    if (reload.failure) { // perhaps not all were read: those of before may mend it, too
        scene_inputs_.merge(reload.inputs);
        std::rethrow_exception(reload.failure);
    }
    scene_inputs_ = std::move(reload.inputs);
    const LoadedScene& loaded = reload.loaded;
    const std::shared_ptr<const Scene> before = std::exchange(base_, loaded.scene);
    worn_ = base_;
    subject_ = subject_of(*base_);
    // A person's own view stays until the file tells of another; a bare model tells of none.
    const bool has_camera = lower_extension(source_.path) == ".pbrt";
    if (!before) {
        camera_.emplace(base_->camera, subject_);
    } else if (has_camera && !same_but_for_size(before->camera, base_->camera)) {
        const glm::ivec2 size = camera_->camera().resolution;
        camera_.emplace(base_->camera, subject_);
        camera_->resize(size);
    }
    wearers_ = rapport::wearers(*base_);
    light_kinds_ = rapport::light_kinds(*base_);
    choices_ = worn_cloths(*base_);
    for (const auto& [name, choice] : own_choices_)
        if (wearers_.contains(name))
            choices_[name] = choice;
    for (const auto& [file, table] : loaded.tables)
        if (!documents_.contains(file)) {
            ClothDocument& document = documents_[file];
            document.table = table;
            document.cloth = table->cloth;
            read_from(document, table->inputs);
        }
    for (const auto& [name, choice] : choices_)
        open(choice.file);
    fill_shelf();
    if (!refining_) // they were told before
        for (const std::string& warning : loaded.warnings)
            notes_.push_back("warning: " + warning);
    redress_ = true;
    look_anew();
}

void Session::fill_shelf() {
    std::error_code error; // what cannot be listed has nothing to choose
    std::set<std::filesystem::path> folders{
        std::filesystem::weakly_canonical(source_.path).parent_path(),
        std::filesystem::current_path(error)};
    std::set<std::filesystem::path> files;
    for (const auto& [file, document] : documents_)
        folders.insert(file.parent_path());
    for (const std::filesystem::path& folder : folders) {
        for (const auto& entry : std::filesystem::directory_iterator(folder, error))
            if (const std::string kind = lower_extension(entry.path());
                kind == ".toml" || kind == ".wif" || kind == ".bsdf")
                files.insert(std::filesystem::weakly_canonical(entry.path()));
    }
    shelf_.assign(files.begin(), files.end());
}

void Session::resize(const glm::ivec2& resolution) {
    if (resolution == camera_->camera().resolution || resolution.x < 1 || resolution.y < 1)
        return; // the same, or minimised
    camera_->resize(resolution);
    look_anew();
}

void Session::orbit(const glm::vec2& pixels) {
    camera_->orbit(pixels);
    look_anew();
}

void Session::pan(const glm::vec2& pixels) {
    camera_->pan(pixels);
    look_anew();
}

void Session::zoom(float steps) {
    camera_->zoom(std::pow(kZoomStep, steps));
    look_anew();
}

void Session::focus(const glm::vec2& at) {
    const std::optional<SurfacePoint> point = base_->intersect(camera_->camera().ray(at));
    if (!point)
        return;
    camera_->focus(point->position);
    look_anew();
}

void Session::frame_all() {
    camera_->frame(subject_);
    look_anew();
}

void Session::open(const std::filesystem::path& file) {
    ClothDocument& document = documents_[file];
    if (!document.table && !document.waiting) {
        ask(file, nullptr);
        watch_.keep(file);
    } else if (document.cloth && document.request == 0) {
        ask(file, document.cloth);
        document.waiting = false; // it has a table, in haste
    }
}

bool Session::worn(const std::filesystem::path& file) const {
    return std::ranges::any_of(choices_,
                               [&](const auto& choice) { return choice.second.file == file; });
}

void Session::ask(const std::filesystem::path& file, std::shared_ptr<const Cloth> cloth) {
    ClothDocument& document = documents_[file];
    document.request = worker_.request(file, std::move(cloth));
    document.waiting = true;
    document.error.clear();
}

void Session::choose_cloth(const std::string& material, const ClothChoice& choice) {
    if (choice.file.empty()) {
        own_choices_.erase(material);
        choices_.erase(material);
        choices_.merge(worn_cloths(*base_));
    } else {
        ClothChoice canonical = choice;
        canonical.file = std::filesystem::weakly_canonical(choice.file);
        choices_[material] = own_choices_[material] = canonical;
    }
    if (const auto worn = choices_.find(material); worn != choices_.end())
        open(worn->second.file);
    redress_ = true;
    restart();
}

void Session::set_lights(const LightSettings& lights) {
    if (lights == lights_)
        return;
    lights_ = lights;
    redress_ = true;
    restart();
}

void Session::edit_cloth(const std::filesystem::path& file, Cloth cloth) {
    ClothDocument& document = documents_[file];
    document.cloth = std::make_shared<const Cloth>(std::move(cloth));
    document.edited = true;
    ask(file, document.cloth);
}

std::string Session::error() const { return scene_error_.empty() ? tracer_.error() : scene_error_; }

void Session::look_at_files() {
    for (const std::filesystem::path& changed : watch_.changed()) {
        if (scene_inputs_.contains(changed))
            scene_changed_ = stop_reload_ = true; // one that goes on reads what was there before
        for (const auto& [file, document] : documents_)
            if (file == changed || document.inputs.contains(changed))
                reread(file, changed);
    }
    if (scene_changed_ && !reload_.valid())
        start_reload();
}

void Session::reread(const std::filesystem::path& file, const std::filesystem::path& changed) {
    ClothDocument& document = documents_.at(file);
    if (document.edited) {
        notes_.push_back(changed.filename().string() +
                         " changed on the disk and takes the place of the edits");
        rescue(file, *document.cloth);
    }
    document.edited = false;
    ask(file, nullptr);
}

void Session::read_from(ClothDocument& document, const std::set<std::filesystem::path>& inputs) {
    document.inputs = inputs;
    for (const std::filesystem::path& file : inputs)
        watch_.keep(file);
}

void Session::look_anew() {
    moved_ = Clock::now();
    refined_ = false;
    restart();
}

bool Session::seen_too_coarsely() const {
    constexpr int kRays = 32; // along each side of the picture
    constexpr double kTooLarge = 2;
    constexpr int kFew = 50; // one in so many may be: the picture's edge has some of them
    const Sight before(source_.seen_from.value_or(base_->camera)), now(camera());
    int met = 0, too_large = 0;
    for (int i = 0; i < kRays * kRays; ++i) {
        const glm::vec2 place = (glm::vec2(i % kRays, i / kRays) + 0.5f) / float{kRays};
        const auto point = base_->intersect(camera().ray(glm::vec2(camera().resolution) * place));
        if (!point || !point->surface->cut_by_sight)
            continue;
        const TriangleMesh& mesh = *point->surface->mesh;
        const glm::uvec3 t = mesh.triangles[point->triangle];
        const glm::dvec3 a = mesh.positions[t.x], b = mesh.positions[t.y];
        too_large += now.length(a, b) > kTooLarge * before.length(a, b);
        ++met;
    }
    return too_large > met / kFew;
}

void Session::look_at_surfaces() {
    constexpr std::chrono::milliseconds kRest{500};
    if (refined_ || reload_.valid() || Clock::now() - moved_ < kRest)
        return;
    refined_ = true;
    if (!seen_too_coarsely())
        return;
    source_.seen_from = camera();
    start_reload();
}

void Session::start_reload() {
    ClothTables known;
    for (const auto& [cloth, document] : documents_)
        if (document.table)
            known[cloth] = document.table;
    refining_ = !scene_changed_;
    scene_changed_ = stop_reload_ = false;
    reload_ = std::async(std::launch::async, [this, source = source_, known = std::move(known)] {
        return load(source, known, {}, [this] { return stop_reload_.load(); });
    });
}

void Session::finish_reload() {
    if (!ready(reload_))
        return;
    try {
        take(reload_.get());
        scene_error_.clear();
        notes_.push_back(refining_ ? "surfaces cut for this view"
                                   : "loaded " + source_.path.string());
    } catch (const Stopped&) { // it is loaded anew
    } catch (const std::exception& error) {
        scene_error_ = error.what();
    }
}

void Session::take_news() {
    for (ClothWorker::News& news : worker_.take_news()) {
        const auto found = documents_.find(news.file);
        if (found == documents_.end() || news.request != found->second.request)
            continue;
        ClothDocument& document = found->second;
        document.waiting = false;
        document.error = news.error;
        if (const auto& inputs = news.table ? news.table->inputs : news.inputs; !inputs.empty())
            read_from(document, inputs);
        if (!news.table)
            continue;
        document.table = news.table;
        if (!document.edited)
            document.cloth = news.table->cloth;
        if (worn(news.file)) {
            redress_ = true;
            restart();
        }
    }
}

void Session::tick() {
    look_at_files();
    finish_reload();
    look_at_surfaces();
    take_news();
    if (ready(saving_))
        notes_.push_back(saving_.get());
    // While a cloth's first table is awaited, all hands measure it: the picture will be another.
    const bool waiting = std::ranges::any_of(choices_, [&](const auto& choice) {
        const auto document = documents_.find(choice.second.file);
        return document != documents_.end() && document->second.waiting;
    });
    tracer_.set_samples(waiting ? 1 : std::numeric_limits<int>::max());
    if (stale_)
        show();
}

void Session::show() {
    if (redress_) {
        ClothChoices ready_choices;
        for (const auto& [name, choice] : choices_)
            if (const auto document = documents_.find(choice.file);
                document != documents_.end() && document->second.table &&
                document->second.table->dyed.contains(choice.colourway))
                ready_choices[name] = choice;
        worn_ = std::make_shared<const Scene>(
            dressed(*base_, ready_choices, lights_, camera_->up(),
                    [&](const std::filesystem::path& file, const std::string& colourway) {
                        return in_colourway(*documents_.at(file).table, file, colourway);
                    }));
    }
    tracer_.show(worn_, camera_->camera());
    stale_ = redress_ = false;
}

} // namespace rapport
