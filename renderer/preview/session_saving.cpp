#include "renderer/preview/session.h"

#include "renderer/core/atomic_file.h"
#include "renderer/core/error.h"
#include "renderer/core/input_file.h"
#include "renderer/core/png.h"
#include "renderer/preview/camera_file.h"

#include <algorithm>
#include <fmt/format.h>

// What a session writes: cloths, pictures, the camera.

namespace rapport {
namespace {

void write_cloth(const Cloth& cloth, const std::filesystem::path& file) {
    const std::string text = cloth_text(cloth);
    write_stream_atomically(file, [&](std::ofstream& stream) { stream << text; });
}

} // namespace

void Session::attempt(const std::function<void()>& action) {
    try {
        action();
    } catch (const std::exception& error) {
        notes_.push_back(error.what());
    }
}

std::filesystem::path Session::save_cloth(const std::filesystem::path& file,
                                          const std::filesystem::path& target, bool overwrite) {
    std::filesystem::path next = file;
    attempt([&] {
        if (lower_extension(target) != ".toml")
            throw FileError(target.string(), "", "a name that ends in .toml", "another ending");
        const std::filesystem::path saved = std::filesystem::weakly_canonical(target);
        if (saved != file && !overwrite && std::filesystem::exists(saved))
            throw FileError(target.string(), "", "a new name, or to be told again to overwrite",
                            "a file");
        ClothDocument& document = documents_.at(file);
        write_cloth(*document.cloth, saved);
        watch_.add(saved);
        notes_.push_back("saved " + saved.string());
        document.edited = false;
        document.inputs = {saved}; // with its draft in it
        next = saved;
        if (saved != file)
            go_on_with(saved, file);
    });
    return next;
}

bool Session::edited() const {
    return std::ranges::any_of(documents_,
                               [](const auto& document) { return document.second.edited; });
}

void Session::rescue(const std::string& why) {
    notes_.push_back(why);
    for (const auto& [file, document] : documents_)
        if (document.edited)
            rescue(file, *document.cloth);
}

void Session::rescue(const std::filesystem::path& file, const Cloth& cloth) {
    attempt([&] {
        const std::string stem = file.stem().string() + "-rescued";
        std::string name = stem + ".toml";
        for (int copy = 2; std::filesystem::exists(name); ++copy)
            name = fmt::format("{}-{}.toml", stem, copy);
        write_cloth(cloth, name);
        notes_.push_back("saved " + name);
    });
}

/// What was worn from `file` is worn from `target`, where it has just been written; nobody wears
/// `file` any more.
void Session::go_on_with(const std::filesystem::path& target, const std::filesystem::path& file) {
    documents_[target] = std::move(documents_.at(file));
    documents_.erase(file);
    worker_.forget(file);
    const bool waiting = documents_[target].waiting;
    ask(target, documents_[target].cloth);
    documents_[target].waiting = waiting;
    for (auto& [name, choice] : choices_)
        if (choice.file == file) {
            choice.file = target;
            own_choices_[name] = choice;
        }
    fill_shelf();
}

void Session::save_picture(const std::filesystem::path& exr, const std::filesystem::path& png) {
    if (saving_.valid())
        return; // the last one is still being written
    const std::shared_ptr<const TracedPicture> shown = picture();
    if (!shown)
        return;
    saving_ = std::async(std::launch::async, [=, tone = tone, scene = source_.path.string()] {
        try {
            Image image = shown->image;
            image.attributes["command"] = "rapport view " + scene;
            image.attributes["samples"] = std::to_string(shown->samples);
            write_exr(image, exr);
            write_png_bytes(displayed(image, shown->camera, tone), image.width, image.height, 4,
                            png);
            return fmt::format("saved {} and {}: {} x {}, {} samples a pixel", exr.string(),
                               png.string(), image.width, image.height, shown->samples);
        } catch (const std::exception& error) {
            return std::string(error.what());
        }
    });
}

void Session::save_shown() {
    const std::string stem = source_.path.stem().string() + "-view";
    save_picture(stem + ".exr", stem + ".png");
}

void Session::save_camera() {
    attempt([&] {
        std::filesystem::path copy = source_.path;
        copy.replace_filename(copy.stem().string() + "-view.pbrt");
        rapport::save_camera(camera(), source_.path, copy);
        notes_.push_back("saved " + copy.string());
    });
}

} // namespace rapport
