#include "tests/support/file_bytes.h"
#include "vgsp/cloth.h"
#include "vgsp/micro_element.h"

#include <gtest/gtest.h>
#include <tuple>

namespace rapport {
namespace {

std::vector<Cloth> our_cloths() {
    const auto folder = std::filesystem::path(RAPPORT_SOURCE_DIR) / "scenes" / "cloths";
    std::vector<Cloth> cloths;
    for (const auto& file : std::filesystem::directory_iterator(folder))
        if (file.path().extension() == ".toml")
            cloths.push_back(read_cloth(file.path()));
    return cloths;
}

// A cloth of perfect fibres is the paper's known fault.
TEST(OurCloths, AreOfImperfectFibresWithAKnownWeight) {
    const std::vector<Cloth> cloths = our_cloths();
    EXPECT_GE(cloths.size(), 10u);
    for (const Cloth& cloth : cloths)
        for (const YarnKind& kind : yarn_kinds(cloth)) {
            EXPECT_TRUE(kind.yarn->fibre.density_g_cm3) << cloth.path << kind.place;
            EXPECT_GT(kind.yarn->fibre.diameter_variation, 0) << cloth.path << kind.place;
            EXPECT_GT(kind.yarn->fibre.roughness, 0) << cloth.path << kind.place;
            EXPECT_GT(kind.yarn->irregularity.deviation_degrees, 0) << cloth.path << kind.place;
            EXPECT_GT(kind.yarn->irregularity.spacing_jitter_um, 0) << cloth.path << kind.place;
            EXPECT_GT(kind.yarn->irregularity.stray_fibres, 0) << cloth.path << kind.place;
        }
}

// The published twills after which these two are made.
TEST(OurCloths, WeighWhatTheirSourcesSay) {
    for (const auto& [name, mass, thickness] :
         {std::tuple("denim", 249.0, 500.0), {"cotton-twill", 248.0, 530.0}}) {
        const MicroElement element = build_micro_element(
            read_cloth(std::string(RAPPORT_SOURCE_DIR "/scenes/cloths/") + name + ".toml"),
            {.max_turn_degrees = 8});
        EXPECT_NEAR(element.mass_g_per_m2.value(), mass, 0.15 * mass) << name;
        EXPECT_NEAR(element.thickness_um, thickness, 0.15 * thickness) << name;
    }
}

TEST(OurCloths, TheReadmesIsWovenOfAnyOfOurDrafts) {
    constexpr std::string_view kOpening = "```toml\n";
    const std::string readme = tests::read_bytes(RAPPORT_SOURCE_DIR "/README.md");
    const size_t start = readme.find(kOpening) + kOpening.size();
    const tests::TemporaryFolder folder;
    const auto cloth = tests::write_bytes(
        folder, "my.toml",
        std::string_view(readme).substr(start, readme.find("```", start) - start));
    for (const auto& draft :
         std::filesystem::directory_iterator(RAPPORT_SOURCE_DIR "/scenes/drafts")) {
        std::filesystem::copy_file(draft, folder / "my.wif",
                                   std::filesystem::copy_options::overwrite_existing);
        EXPECT_GT(build_micro_element(read_cloth(cloth)).segments, 0u) << draft;
    }
}

} // namespace
} // namespace rapport
