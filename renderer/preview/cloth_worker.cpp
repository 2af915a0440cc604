#include "renderer/preview/cloth_worker.h"

#include "renderer/core/input_file.h"

#include <algorithm>
#include <utility>

namespace rapport {
namespace {

constexpr double kFinestAccuracy = 0.1;
constexpr uint64_t kMostPaths = 1 << 20; ///< per direction, for cloths whose light is hard to count

bool is_stored(const std::filesystem::path& file) { return lower_extension(file) == ".bsdf"; }

std::shared_ptr<const Cloth> read(const std::filesystem::path& file) {
    return std::make_shared<const Cloth>(load_cloth(file));
}

/// `name` is for messages.
ClothTable ready(BsdfTable table, std::shared_ptr<const Cloth> cloth, const std::string& name,
                 const StopSignal& stopped = {}) {
    ClothTable made;
    made.cloth = std::move(cloth);
    made.accuracy = table.largest_accuracy();
    const auto dye = [&](const std::string& colourway) {
        made.dyed[colourway] =
            std::make_shared<const TableBsdf>(table.in_colourway(colourway, name), name, stopped);
    };
    dye("");
    for (const auto& [colourway, scattering] : table.colourways)
        dye(colourway);
    made.table = std::make_shared<const BsdfTable>(std::move(table));
    return made;
}

ClothTable ready(const RisingMeasurement& measurement, const std::filesystem::path& file,
                 const StopSignal& stopped = {}) {
    ClothTable made = ready(measurement.table(), measurement.cloth(), file.string(), stopped);
    made.swatches = measurement.swatches();
    return made;
}

} // namespace

ClothTable first_table(const std::filesystem::path& file, const MeasuringWatch& watch,
                       const StopSignal& stopped) {
    const auto asked = std::chrono::steady_clock::now();
    const InputLog log(InputLog::Of::names);
    ClothTable made;
    if (is_stored(file)) {
        made = ready(read_table(file), nullptr, file.string(), stopped);
    } else {
        RisingMeasurement measurement(read(file));
        measurement.advance(stopped, watch);
        made = ready(measurement, file, stopped);
    }
    made.inputs = log.files();
    made.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - asked).count();
    return made;
}

ClothWorker::ClothWorker() : thread_([this] { run(); }) {}

ClothWorker::~ClothWorker() {
    {
        const std::scoped_lock lock(mutex_);
        closing_ = stop_current_ = true;
    }
    changed_.notify_all();
    thread_.join();
}

uint64_t ClothWorker::request(const std::filesystem::path& file,
                              std::shared_ptr<const Cloth> cloth) {
    auto task = std::make_shared<Task>();
    task->file = file;
    task->cloth = std::move(cloth);
    task->asked = Clock::now();
    uint64_t number;
    {
        const std::scoped_lock lock(mutex_);
        number = task->request = ++requests_;
        tasks_[file] = std::move(task);
        stop_current();
    }
    changed_.notify_all();
    return number;
}

void ClothWorker::forget(const std::filesystem::path& file) {
    const std::scoped_lock lock(mutex_);
    tasks_.erase(file);
    if (current_ && current_->file == file)
        stop_current();
}

void ClothWorker::stop_current() {
    if (!current_ || stop_current_)
        return;
    stop_current_ = true;
    stopped_at_ = Clock::now();
}

std::vector<ClothWorker::News> ClothWorker::take_news() {
    const std::scoped_lock lock(mutex_);
    return std::exchange(news_, {});
}

std::filesystem::path ClothWorker::working_on() const {
    const std::scoped_lock lock(mutex_);
    return current_ ? current_->file : std::filesystem::path();
}

double ClothWorker::seconds_to_stop() const {
    const std::scoped_lock lock(mutex_);
    return seconds_to_stop_;
}

void ClothWorker::tell(News news) {
    const std::scoped_lock lock(mutex_);
    // What has been asked for anew in the meantime is of no interest any more.
    const auto task = tasks_.find(news.file);
    if (task != tasks_.end() && task->second->request == news.request)
        news_.push_back(std::move(news));
}

void ClothWorker::run() {
    const auto paths = [](const auto& task) {
        return task.second->measurement ? task.second->measurement->paths() : 0;
    };
    for (;;) {
        std::shared_ptr<Task> task;
        {
            std::unique_lock lock(mutex_);
            if (stop_current_ && current_)
                seconds_to_stop_ =
                    std::chrono::duration<double>(Clock::now() - stopped_at_).count();
            current_ = nullptr;
            changed_.wait(lock, [&] { return closing_ || !tasks_.empty(); });
            if (closing_)
                return;
            task = current_ = std::ranges::min_element(tasks_, {}, paths)->second;
            stop_current_ = false;
        }
        bool more = true;
        const InputLog log(InputLog::Of::names);
        try {
            more = advance(*task, [this] { return stop_current_.load(); });
        } catch (const Stopped&) { // a newer task may come first
        } catch (const std::exception& error) {
            tell({task->file, task->request, nullptr, error.what(), log.files()});
            more = false;
        }
        const std::scoped_lock lock(mutex_);
        const auto own = tasks_.find(task->file);
        if (!more && own != tasks_.end() && own->second == task)
            tasks_.erase(own);
    }
}

bool ClothWorker::advance(Task& task, const StopSignal& stopped) {
    const auto tell_of = [&](ClothTable table) {
        table.seconds = std::chrono::duration<double>(Clock::now() - task.asked).count();
        tell({task.file, task.request, std::make_shared<const ClothTable>(std::move(table))});
    };
    if (!task.cloth && is_stored(task.file)) {
        tell_of(first_table(task.file, {}, stopped));
        return false;
    }
    if (!task.measurement) {
        const InputLog log(InputLog::Of::names);
        task.measurement.emplace(task.cloth ? task.cloth : read(task.file));
        task.inputs = log.files();
    }
    RisingMeasurement& measurement = *task.measurement;
    measurement.advance(stopped);
    const bool done = measurement.table().largest_accuracy() <= kFinestAccuracy ||
                      measurement.paths() >= kMostPaths;
    if (done || measurement.paths() >= 2 * task.told_paths) {
        task.told_paths = measurement.paths();
        ClothTable table = ready(measurement, task.file, stopped);
        table.inputs = task.inputs;
        tell_of(std::move(table));
    }
    return !done;
}

} // namespace rapport
