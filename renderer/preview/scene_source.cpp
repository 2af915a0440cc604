#include "renderer/preview/scene_source.h"

#include "renderer/scene/scene_builder.h"
#include "renderer/scene/scene_file.h"

namespace rapport {

LoadedScene load_scene(const SceneSource& source, const ClothTables& known,
                       const LoadingWatch& watch, const StopSignal& stopped) {
    LoadedScene loaded;
    const auto load_table = [&](const std::filesystem::path& path, const std::string& colourway) {
        const std::filesystem::path file = std::filesystem::weakly_canonical(path);
        auto& table = loaded.tables[file];
        if (const auto found = known.find(file); !table && found != known.end())
            table = found->second;
        const auto tell = [&](const GoniophotometerProgress& progress) {
            if (watch)
                watch(path, progress);
        };
        if (!table)
            table = std::make_shared<const ClothTable>(first_table(file, tell, stopped));
        return in_colourway(*table, file, colourway);
    };
    SceneDescription description = read_scene(source.path, {1024, 1024});
    description.settings.seed = source.seed;
    loaded.scene = std::make_shared<const Scene>(
        build_scene(description, {source.cloths, load_table, source.colourways, source.seen_from},
                    loaded.warnings));
    return loaded;
}

std::shared_ptr<const TableBsdf> in_colourway(const ClothTable& table,
                                              const std::filesystem::path& file,
                                              const std::string& colourway) {
    return rapport::colourway(table.dyed, colourway, file.string());
}

} // namespace rapport
