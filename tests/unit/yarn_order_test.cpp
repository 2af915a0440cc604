#include "renderer/core/error.h"
#include "tests/support/cloth_texts.h"
#include "vgsp/cloth.h"

#include <gtest/gtest.h>

// Cloths of several kinds of yarn, and what dyes them.

namespace rapport {
namespace {

using Rows = std::vector<std::string>;
using tests::kCloth;
using tests::read_text;
using tests::refusal;

/// Two yarns in the warp, one of them in the weft too.
constexpr std::string_view kStriped = R"(weave = "plain"
[warp]
ends_per_cm = 40
order = ["red", "red", "white"]
[weft]
picks_per_cm = 30
order = ["white"]
[yarn.red]
section = "parallel"
fibres = 19
width_um = 110
height_um = 110
[yarn.red.fibre]
diameter_um = 14
refractive_index = 1.5
[yarn.white]
section = "parallel"
fibres = 7
width_um = 90
height_um = 80
[yarn.white.fibre]
diameter_um = 12
refractive_index = 1.53
[yarn.spare]
section = "parallel"
fibres = 1
width_um = 90
height_um = 90
[yarn.spare.fibre]
diameter_um = 50
refractive_index = 1.53
)";

std::string striped(std::string_view old_words, std::string_view new_words) {
    return tests::replaced(kStriped, old_words, new_words);
}

TEST(YarnOrder, GivesEachThreadItsYarn) {
    const Cloth cloth = read_text(kStriped);
    ASSERT_EQ(cloth.yarns.size(), 2u); // one is spare
    EXPECT_EQ(cloth.yarns[0].name, "red");
    EXPECT_EQ(cloth.yarns[1].yarn.fibres, 7);
    EXPECT_EQ(cloth.draft.ends, 6); // an even repeat of three
    EXPECT_EQ(cloth.draft.warp_yarns, (std::vector<int>{0, 0, 1, 0, 0, 1}));
    EXPECT_EQ(cloth.draft.weft_yarns, (std::vector<int>{1, 1}));
    EXPECT_EQ(draft_rows(cloth.draft), (Rows{"101010", "010101"}));
    const std::vector<YarnKind> kinds = yarn_kinds(cloth);
    ASSERT_EQ(kinds.size(), 2u);
    EXPECT_EQ(kinds[1].place, "yarn.white");

    const Cloth again = read_text(cloth.source);
    EXPECT_EQ(again.source, cloth.source);
    EXPECT_EQ(again.yarns, cloth.yarns);
    EXPECT_EQ(again.draft.warp_yarns, cloth.draft.warp_yarns);
    EXPECT_NE(read_text(striped("\"red\", \"red\"", "\"red\"")).source, cloth.source);
}

constexpr std::string_view kColouredWif =
    "[WEAVING]\nRising Shed=yes\n[WARP]\nThreads=4\n[WEFT]\nThreads=2\nColor=7\n"
    "[THREADING]\n1=1\n2=2\n3=1\n4=2\n[LIFTPLAN]\n1=1\n2=2\n[COLOR PALETTE]\nRange=0,255\n"
    "[COLOR TABLE]\n3=255,0,0\n7=255,255,255\n[WARP COLORS]\n1=3\n2=3\n3=7\n4=7\n";

TEST(YarnOrder, FollowsTheColoursOfTheDraft) {
    const tests::TemporaryFolder folder;
    tests::write_bytes(folder, "stripes.wif", kColouredWif);
    std::string text = striped("weave = \"plain\"", "draft = 'stripes.wif'");
    text.replace(text.find("order = [\"red\", \"red\", \"white\"]"), 31,
                 "colors = {3 = \"white\", 7 = \"red\"}");
    const Cloth cloth = read_cloth(tests::write_bytes(folder, "cloth.toml", text));
    EXPECT_EQ(cloth.yarns[0].name, "white"); // that of the first end
    EXPECT_EQ(cloth.draft.warp_yarns, (std::vector<int>{0, 0, 1, 1}));
    EXPECT_EQ(cloth.draft.weft_yarns, (std::vector<int>{0, 0}));
    EXPECT_EQ(read_text(cloth.source).source, cloth.source);

    const auto refused = [&](std::string_view old_words, std::string_view new_words) {
        std::string wrong = text;
        wrong.replace(wrong.find(old_words), old_words.size(), new_words);
        try {
            read_cloth(tests::write_bytes(folder, "cloth.toml", wrong));
        } catch (const FileError& error) {
            return std::string(error.what());
        }
        return std::string("accepted");
    };
    EXPECT_NE(refused("7 = \"red\"", "8 = \"red\"").find("a yarn for colour 7"), std::string::npos);
    EXPECT_NE(refused("7 = \"red\"", "x = \"red\"").find("number of a colour"), std::string::npos);
    EXPECT_NE(refused("draft = 'stripes.wif'", "weave = 'plain'").find("a draft that tells"),
              std::string::npos);
}

TEST(Colourway, NamesYarnsOfTheCloth) {
    const std::string text = std::string(kStriped) +
                             "[colourway.a]\nyarn.red.color = [0.1, 0.2, 0.3]\n"
                             "yarn.spare.color = [0.1, 0.1, 0.1]\n";
    const Cloth cloth = read_text(text);
    EXPECT_TRUE(cloth.colourways.at("a").at("yarn.red").color);
    EXPECT_EQ(cloth.colourways.at("a").size(), 1u); // the spare is not woven
    EXPECT_NE(refusal(text + "yarn.blue.color = [0, 0, 0]").expected.find("red, spare, white"),
              std::string::npos);
    EXPECT_NE(refusal(text + "warp.color = [0, 0, 0]").expected.find("yarn"), std::string::npos);
    EXPECT_EQ(read_text(cloth.source).colourways, cloth.colourways);
    const auto refused = [&](const std::string& colourway) {
        return refusal(std::string(kCloth) + "[colourway.a]\n" + colourway).expected;
    };
    EXPECT_NE(refused("fill.color = [0, 0, 0]").find("warp, weft"), std::string::npos);
    EXPECT_NE(refused("warp.colour = [0, 0, 0]").find("color, absorption_per_um"),
              std::string::npos);
    EXPECT_NE(refused("warp = {}").find("'color' or"), std::string::npos);
    EXPECT_NE(refused("warp.color = [0, 0]").find("3 numbers"), std::string::npos);
    EXPECT_NE(refused("warp = 1").find("a table"), std::string::npos);
    std::string many(kCloth);
    for (int i = 0; i < 33; ++i)
        many += "[colourway." + std::to_string(i) + "]\n";
    EXPECT_NE(refusal(many).expected.find("at most 32"), std::string::npos);
    EXPECT_NE(refusal(std::string(kCloth) + "[colourway.'']\n").expected.find("a name"),
              std::string::npos);
}

TEST(YarnOrder, BadOrdersAreRefused) {
    EXPECT_NE(refusal(striped("\"red\", \"red\"", "\"blue\"")).expected.find("[yarn.blue]"),
              std::string::npos);
    EXPECT_NE(refusal(striped("order = [\"white\"]", "order = []")).expected.find("names"),
              std::string::npos);
    EXPECT_NE(refusal(striped("order = [\"white\"]", "order = [\"white\"]\nfibres = 3"))
                  .expected.find("picks_per_cm, order"),
              std::string::npos);
    EXPECT_NE(refusal(striped("order = [\"white\"]", "")).expected.find("'weft.section'"),
              std::string::npos);
    EXPECT_NE(refusal(striped("fibres = 19", "fibres = 0")).found.find("0"), std::string::npos);
}

} // namespace
} // namespace rapport
