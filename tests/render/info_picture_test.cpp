#include "materials/table/bsdf_table.h"
#include "renderer/app/element_picture.h"
#include "tests/support/file_bytes.h"
#include "tests/support/run_program.h"
#include "tests/support/synthetic_tables.h"
#include "tests/support/temporary_folder.h"
#include "vgsp/micro_element.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <gtest/gtest.h>
#include <memory>
#include <set>
#include <stb/stb_image.h>

namespace rapport {
namespace {

const std::string kScenes = RAPPORT_SOURCE_DIR "/scenes/";

struct Png {
    int width = 0, height = 0;
    std::unique_ptr<uint8_t, void (*)(void*)> pixels{nullptr, stbi_image_free};

    std::array<int, 3> at(int x, int y) const {
        const uint8_t* p = pixels.get() + 3 * (y * width + x);
        return {p[0], p[1], p[2]};
    }
    std::set<std::array<int, 3>> colours() const {
        std::set<std::array<int, 3>> found;
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x)
                found.insert(at(x, y));
        return found;
    }
};

class InfoPicture : public testing::Test {
  protected:
    Png draw(const std::string& file) {
        const std::string png = (folder_ / "picture.png").string();
        const tests::ProgramRun run = tests::run_program({"info", file, "--picture", png});
        EXPECT_EQ(run.status, 0) << run.err;
        Png read;
        int channels;
        read.pixels.reset(stbi_load(png.c_str(), &read.width, &read.height, &channels, 3));
        EXPECT_TRUE(read.pixels);
        return read;
    }
    tests::TemporaryFolder folder_;
};

TEST_F(InfoPicture, ADraftIsItsDrawdown) {
    const Png png = draw(kScenes + "drafts/satin5.wif");
    ASSERT_EQ(png.width, png.height);
    const int cell = png.width / 5;
    int up = 0;
    for (int y = 0; y < 5; ++y)
        for (int x = 0; x < 5; ++x)
            up += png.at(x * cell + cell / 2, y * cell + cell / 2)[0] < 128;
    EXPECT_EQ(up, 20); // warp-faced: the weft is on top once in each pick
}

TEST(ElementViews, OfASatinTheFaceIsWarp) {
    // 5 ends of 1/80 cm by 5 picks of 1/53 cm.
    const Canvas top = element_views(read_cloth(kScenes + "cloths/quickstart.toml")).top;
    EXPECT_EQ(top.height(), 900);
    EXPECT_NEAR(top.width(), 900 * 53 / 80, 1);
    int warp = 0, weft = 0;
    for (int y = 0; y < top.height(); ++y)
        for (int x = 0; x < top.width(); ++x) {
            const glm::vec3 colour = top.at(x, y);
            warp += colour.r > colour.b + 0.08f;
            weft += colour.b > colour.r + 0.08f;
        }
    EXPECT_GT(warp, 2 * weft);
    EXPECT_GT(weft, 0);
}

// Linen's fibres run through many cells before they close.
TEST(ElementViews, ACutShowsEveryFibre) {
    const Cloth linen = read_cloth(kScenes + "cloths/linen.toml");
    const MicroElement element = build_micro_element(linen, {.max_turn_degrees = 4});
    double expected = 0; // area of the warp where the first pick runs through it [µm²]
    for (const kernel::FibreChain& fibre : element.fibres.chains)
        expected += fibre.period.y / element.fibres.cell.y * kPi * square(fibre.radius);

    const ElementViews views = element_views(linen);
    const Canvas& cut = views.weft_cut;
    int warp = 0;
    for (int x = 0; x < cut.width(); ++x) {
        int weft = 0;
        for (int y = 0; y < cut.height(); ++y) {
            const glm::vec3 colour = cut.at(x, y);
            warp += colour.r > colour.b + 0.1f;
            weft += colour.b > colour.r + 0.1f;
        }
        EXPECT_GT(weft, 0) << x; // the first pick runs from side to side
    }
    EXPECT_NEAR(warp / square(views.scale), expected, 0.08 * expected);
}

TEST_F(InfoPicture, ATableIsWhereItSendsLight) {
    const std::string file = (folder_ / "table.bsdf").string();
    write_table(tests::synthetic_table(tests::satin_intensity), file);
    const Png png = draw(file);
    EXPECT_GT(png.colours().size(), 100u);
    EXPECT_EQ(png.at(0, 0), (std::array<int, 3>{255, 255, 255}));
    // The curves of the polar plots, and something dark: their letters.
    const auto colours = png.colours();
    EXPECT_TRUE(colours.contains({0, 115, 179}));
    EXPECT_TRUE(
        std::ranges::any_of(colours, [](const auto& c) { return c[0] + c[1] + c[2] < 90; }));
}

TEST_F(InfoPicture, ErrorsThatDifferLittleAreToldApart) {
    const std::string file = (folder_ / "table.bsdf").string();
    BsdfTable table = tests::synthetic_table(tests::satin_intensity);
    for (size_t d = 0; d < table.directions(); ++d)
        table.accuracy[d] = d % 2 ? 0.75f : 0.8f;
    write_table(table, file);
    const Png png = draw(file);
    int pale = 0, dark = 0;
    for (int y = 0; y < png.height; ++y)
        for (int x = png.width * 3 / 4; x < png.width; ++x) {
            pale += png.at(x, y) == std::array<int, 3>{255, 242, 191};
            dark += png.at(x, y) == std::array<int, 3>{89, 8, 38};
        }
    EXPECT_GT(pale, 20000); // of 83,000 on both discs
    EXPECT_GT(dark, 20000);
}

TEST_F(InfoPicture, AModelIsItsWarp) {
    const Png png = draw(kScenes + "garments/dress.glb");
    EXPECT_EQ(png.width, 900);
    EXPECT_EQ(png.at(2, 2), (std::array<int, 3>{0, 0, 0})); // beside the dress
    std::set<std::array<int, 3>> greys;
    for (int x = 300; x < 600; ++x)
        greys.insert(png.at(x, 600));
    EXPECT_GT(greys.size(), 20u);
}

TEST_F(InfoPicture, TheEndingDecidesTheFormat) {
    const std::string file = (folder_ / "table.bsdf").string();
    write_table(tests::synthetic_table(tests::satin_intensity), file);
    const auto svg = [&](const std::string& of) {
        const std::string target = (folder_ / "picture.svg").string();
        const tests::ProgramRun run = tests::run_program({"info", of, "--picture", target});
        EXPECT_EQ(run.status, 0) << run.err;
        return tests::read_bytes(target);
    };
    const auto count = [](const std::string& text, const std::string& part) {
        int found = 0;
        for (size_t at = text.find(part); at != text.npos; at = text.find(part, at + 1))
            ++found;
        return found;
    };
    const std::string draft = svg(kScenes + "drafts/satin5.wif");
    EXPECT_EQ(count(draft, "fill=\"#1a1a1f\""), 20); // warp up
    EXPECT_EQ(count(draft, "fill=\"#ffffff\""), 5);
    const std::string cloth = svg(kScenes + "cloths/linen.toml");
    EXPECT_EQ(count(cloth, "<image"), 3);
    for (const char* words : {">warp<", ">weft<", ">from the face", ">cut along the lowest pick",
                              ">cut along the leftmost end", ">100 µm<"})
        EXPECT_EQ(count(cloth, words), 1) << words;
    const std::string table = svg(file);
    // Three hemispheres and the errors of both sides, and the scale of the errors.
    EXPECT_EQ(count(table, "<image"), 9);
    EXPECT_EQ(count(table, ">weft<"), 8);
    EXPECT_EQ(count(table, ">warp<"), 8);
    EXPECT_EQ(count(table, "#0073b3"), 8); // two plots: a curve's halves, light and key
    EXPECT_EQ(count(table, "nan"), 0);
    // The embedded pictures are whole PNGs: the end chunk stands at the end of each.
    EXPECT_EQ(count(table, "data:image/png;base64,iVBORw0KGgo"), 9);
    EXPECT_EQ(count(table, "</svg>"), 1);
}

TEST_F(InfoPicture, RefusesWhatItCannotDraw) {
    for (const auto& [file, png] : {std::pair(kScenes + "quickstart.pbrt", folder_ / "a.png"),
                                    {kScenes + "drafts/satin5.wif", folder_ / "a.gif"}}) {
        const tests::ProgramRun run = tests::run_program({"info", file, "--picture", png.string()});
        EXPECT_EQ(run.status, 2);
        EXPECT_FALSE(std::filesystem::exists(png));
    }
}

} // namespace
} // namespace rapport
