#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <iterator>
#include <map>
#include <regex>
#include <set>
#include <sstream>

// Which room may include which: the arrows between the folders, held against every source file.

namespace rapport {
namespace {

using Folders = std::set<std::string>;

/// What each room includes directly; what those include, it may include too.
const std::map<std::string, Folders> kArrows = {
    {"renderer/core", {}},
    {"renderer/kernel", {"renderer/core"}},
    {"materials/table", {"renderer/core"}},
    {"materials", {"materials/table"}},
    {"vgsp", {"renderer/kernel", "materials/table"}},
    {"renderer/scene", {"renderer/kernel", "materials", "vgsp"}},
    {"renderer/integrator", {"renderer/scene"}},
    {"renderer/preview", {"renderer/integrator"}},
    {"renderer/app", {"renderer/preview"}},
};

Folders reachable_from(const std::string& room) {
    Folders reached{room};
    for (const std::string& next : kArrows.at(room))
        reached.merge(reachable_from(next));
    return reached;
}

/// The room that `file` lies in, at whatever depth; empty if in none.
std::string room_of(const std::string& file) {
    std::filesystem::path folder = std::filesystem::path(file).parent_path();
    while (!folder.empty() && !kArrows.contains(folder.generic_string()))
        folder = folder.parent_path();
    return folder.generic_string();
}

/// What is wrong with a source file's includes, a line for each; empty if nothing is. `file` is
/// named from the root.
std::string violations(const std::string& file, const std::string& source) {
    const std::string room = room_of(file);
    if (room.empty())
        return file + " lies in no room\n";
    const Folders allowed = reachable_from(room);
    static const std::regex include(R"re(^[ \t]*#[ \t]*include[ \t]*(["<])([^">]*)[">])re");
    std::string found;
    std::istringstream lines(source);
    std::string line;
    for (int number = 1; std::getline(lines, line); ++number) {
        std::smatch match;
        if (!std::regex_search(line, match, include))
            continue;
        const bool own = match[1] == "\"";
        const std::string header = match[2];
        const std::string place = file + ":" + std::to_string(number) + ": " + header;
        if (header.find("embree") != header.npos && room != "renderer/kernel")
            found += place + " is for renderer/kernel only\n";
        if (own == room_of(header).empty())
            found += place + (own ? " is not named from the root\n" : " is ours, so use quotes\n");
        else if (own && !allowed.contains(room_of(header)))
            found += place + " is against the arrows\n";
    }
    return found;
}

TEST(IncludeRules, HoldInEverySourceFile) {
    const std::filesystem::path root = RAPPORT_SOURCE_DIR;
    std::string found;
    int files = 0;
    for (const char* folder : {"renderer", "vgsp", "materials"})
        for (const auto& entry : std::filesystem::recursive_directory_iterator(root / folder)) {
            const std::filesystem::path extension = entry.path().extension();
            if (extension != ".h" && extension != ".cpp")
                continue;
            std::ifstream stream(entry.path());
            const std::string source{std::istreambuf_iterator<char>(stream), {}};
            found += violations(entry.path().lexically_relative(root).generic_string(), source);
            ++files;
        }
    EXPECT_EQ(found, "");
    EXPECT_GT(files, 20);
}

TEST(IncludeRules, ArrowsAreTransitiveAndPointOneWay) {
    EXPECT_TRUE(reachable_from("renderer/app").contains("materials/table"));
    EXPECT_TRUE(reachable_from("vgsp").contains("renderer/core"));
    for (const auto& [room, direct] : kArrows)
        for (const std::string& next : direct)
            EXPECT_FALSE(reachable_from(next).contains(room)) << room << " and " << next;
}

TEST(IncludeRules, SoundIncludesPass) {
    EXPECT_EQ(violations("vgsp/cloth.cpp", "#include \"vgsp/cloth.h\"\n#include <vector>\n"
                                           "#include \"renderer/kernel/fibres.h\"\n"
                                           "// #include \"renderer/app/x.h\" in a comment\n"
                                           "const char* s = \"#include\";\n"),
              "");
    EXPECT_EQ(violations("renderer/kernel/scene.cpp", "#include <embree3/rtcore.h>\n"), "");
    EXPECT_EQ(violations("materials/cloth.cpp", "#include \"materials/table/bsdf_table.h\"\n"), "");
}

// The wrong twins: each of these must be reported, at its line.
TEST(IncludeRules, BadIncludesAreReported) {
    const auto reported = [](const char* file, const char* line) {
        return violations(file, std::string("#pragma once\n") + line + "\n");
    };
    const std::string upwards = reported("vgsp/cloth.h", "#include \"renderer/scene/scene.h\"");
    EXPECT_EQ(upwards, "vgsp/cloth.h:2: renderer/scene/scene.h is against the arrows\n");
    for (const auto& [file, line] : {
             std::pair("renderer/core/math.h", "#include \"renderer/kernel/scene.h\""),
             {"renderer/kernel/scene.h", "#include \"materials/bsdf.h\""},
             {"materials/table/a.h", "#include \"materials/bsdf.h\""},
             {"materials/cloth.cpp", "#include \"vgsp/cloth.h\""},
             {"materials/cloth.cpp", "#include \"renderer/kernel/scene.h\""},
             {"vgsp/draft.cpp", "#include \"materials/bsdf.h\""},
             {"renderer/scene/gltf/gltf.cpp", "  #  include \"renderer/integrator/path_tracer.h\""},
             {"renderer/app/main.cpp", "#include <embree3/rtcore.h>"},
             {"renderer/kernel/a/b.cpp", "#include \"renderer/scene/mesh/mesh.h\""},
             {"vgsp/draft.cpp", "#include \"draft.h\""},
             {"vgsp/draft.cpp", "#include \"../vgsp/draft.h\""},
             {"vgsp/draft.cpp", "#include <vgsp/draft.h>"},
             {"vgsp/draft.cpp", "#include \"tests/support/shared_data.h\""},
             {"renderer/loose.cpp", "#include <vector>"},
         })
        EXPECT_NE(reported(file, line), "") << file << " " << line;
}

} // namespace
} // namespace rapport
