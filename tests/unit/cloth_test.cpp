#include "vgsp/cloth.h"

#include "renderer/core/error.h"
#include "renderer/core/math.h"
#include "renderer/core/rng.h"
#include "tests/support/cloth_texts.h"

#include <algorithm>
#include <gtest/gtest.h>

namespace rapport {
namespace {

using Rows = std::vector<std::string>;
using tests::kCloth;
using tests::read_text;
using tests::refusal;

std::string with(std::string_view old_words, std::string_view new_words) {
    return tests::replaced(kCloth, old_words, new_words);
}

constexpr std::string_view kPlainWif =
    "[WEAVING]\nRising Shed=yes\n[WARP]\nThreads=3\n[WEFT]\nThreads=2\n"
    "[THREADING]\n1=1\n2=2\n[LIFTPLAN]\n1=1\n2=2\n";

TEST(Cloth, EveryKeyIsRead) {
    const Cloth cloth = read_text(kCloth);
    EXPECT_EQ(cloth.name, "test cloth");
    EXPECT_EQ(draft_rows(cloth.draft), (Rows{"110", "011", "101"}));
    EXPECT_EQ(cloth.crimp_balance, 0.25);
    EXPECT_EQ(cloth.ends_per_cm, 40);
    EXPECT_EQ(cloth.picks_per_cm, 30);
    EXPECT_TRUE(cloth.bands.is_rgb());

    YarnSpec warp;
    warp.section = YarnSection::parallel;
    warp.fibres = 37;
    warp.width_um = 130.5;
    warp.height_um = 90;
    warp.flatten = 0.8;
    warp.fibre.diameter_um = 11.9;
    warp.fibre.refractive_index = 1.526;
    warp.fibre.absorption_per_um = {0.001, 0.002, 0.003};
    EXPECT_EQ(cloth.warp, warp);

    YarnSpec weft;
    weft.section = YarnSection::twisted;
    weft.fibres = 61;
    weft.width_um = weft.height_um = 150;
    weft.twist_per_m = -700;
    weft.fibre.diameter_um = 12;
    weft.fibre.refractive_index = 1.55;
    weft.fibre.color = {0.5, 0.25, 0};
    weft.fibre.surface_absorption = 0.01;
    weft.fibre.roughness = 0.2;
    EXPECT_EQ(cloth.weft, weft);
}

constexpr std::string_view kColourways = R"(
[colourway.navy]
warp.color = [0.05, 0.08, 0.2]
weft.absorption_per_um = 0.1
[colourway."as it is"]
)";

TEST(Cloth, MayHaveARefractiveIndexForEachBand) {
    const Cloth cloth =
        read_text(with("refractive_index = 1.526", "refractive_index = [1.51, 1.52, 1.53]"));
    EXPECT_EQ(cloth.warp.fibre.refractive_index, (PerBand{1.51, 1.52, 1.53}));
    EXPECT_EQ(read_text(cloth.source).warp, cloth.warp);
    EXPECT_NE(refusal(with("refractive_index = 1.526", "refractive_index = [1.51, 1.52]"))
                  .expected.find("3 numbers"),
              std::string::npos);
}

TEST(Colourway, DyesTheYarnsThatItNames) {
    const Cloth cloth = read_text(std::string(kCloth) + std::string(kColourways));
    const std::vector<double> navy{0.05, 0.08, 0.2}, dark{0.1, 0.1, 0.1};
    ASSERT_EQ(cloth.colourways.size(), 2u);
    EXPECT_TRUE(cloth.colourways.at("as it is").empty());
    EXPECT_EQ(cloth.colourways.at("navy"),
              (std::map<std::string, Dye>{{"warp", {.absorption_per_um = {}, .color = navy}},
                                          {"weft", {.absorption_per_um = dark, .color = {}}}}));
    EXPECT_EQ(read_text(cloth.source).colourways, cloth.colourways);
    EXPECT_EQ(read_text(cloth.source).source, cloth.source);
    EXPECT_NE(cloth.source, read_text(kCloth).source);
}

TEST(Cloth, DefaultsAreThoseOfTheTable) {
    const tests::TemporaryFolder folder;
    std::string text = with("name = \"test cloth\"\n", "");
    const size_t balance = text.find("crimp_balance");
    text.erase(balance, text.find('\n', balance) - balance);
    const Cloth cloth = read_cloth(tests::write_bytes(folder, "linen.toml", text));
    EXPECT_EQ(cloth.name, "linen");
    EXPECT_EQ(cloth.crimp_balance, 0.5);
    EXPECT_EQ(cloth.weft.flatten, 1);
    EXPECT_EQ(cloth.warp.fibre.surface_absorption, 0);
    const Cloth clear = read_text(with("absorption_per_um = [0.001, 0.002, 0.003]", ""));
    EXPECT_FALSE(clear.warp.fibre.absorption_per_um);
    EXPECT_FALSE(clear.warp.fibre.color);
}

// Morton & Hearle: cotton of 1.7 dtex and 1.52 g/cm³ is 11.9 µm thick as a round fibre.
TEST(Fineness, FollowsFromDiameterAndDensity) {
    EXPECT_NEAR(fibre_diameter_um(1.7, 1.52), 11.93, 0.01);
    EXPECT_NEAR(fibre_dtex(fibre_diameter_um(2.3, 1.31), 1.31), 2.3, 1e-12);
    // A 10 µm fibre of water weighs π·25 µm² · 10 km · 1 g/cm³ = 0.785 g.
    EXPECT_NEAR(fibre_dtex(10, 1), 0.7854, 1e-4);
}

TEST(Cloth, FinenessGivesDiameterAndNumber) {
    std::string text = with("diameter_um = 11.9\n", "dtex = 1.7\ndensity_g_cm3 = 1.52\n");
    text.replace(text.find("fibres = 37"), 11, "tex = 6.3");
    const Cloth cloth = read_text(text);
    EXPECT_EQ(cloth.warp.fibres, 37); // 63 dtex of 1.7 each
    EXPECT_NEAR(cloth.warp.fibre.diameter_um, 11.93, 0.01);
    EXPECT_EQ(cloth.warp.fibre.density_g_cm3, 1.52);
    EXPECT_FALSE(cloth.weft.fibre.density_g_cm3);
    EXPECT_EQ(read_text(cloth.source).warp, cloth.warp);
}

TEST(Cloth, PliesAndIrregularityAreReadAndWritten) {
    std::string text = with("section = \"twisted\"", "section = \"plied\"\nplies = 3\n"
                                                     "ply_twist_per_m = 500\nmigration_um = 2\n"
                                                     "deviation_degrees = 3\nstray_fibres = 0.1\n"
                                                     "spacing_jitter_um = 0.5");
    text.replace(text.find("surface_absorption"), 0, "diameter_variation = 0.12\n");
    const Cloth cloth = read_text(text);
    EXPECT_EQ(cloth.weft.section, YarnSection::plied);
    EXPECT_EQ(cloth.weft.plies, 3);
    EXPECT_EQ(cloth.weft.ply_twist_per_m, 500);
    EXPECT_EQ(cloth.weft.irregularity, (Irregularity{2, 3, 0.5, 0.1}));
    EXPECT_NEAR(cloth.weft.irregularity.correlation_length_um(), 2 / std::tan(radians(3.0)), 1e-9);
    EXPECT_EQ(cloth.weft.fibre.diameter_variation, 0.12);
    EXPECT_EQ(cloth.warp.irregularity, Irregularity{});
    EXPECT_EQ(read_text(cloth.source).weft, cloth.weft);
    EXPECT_EQ(read_text(cloth.source).source, cloth.source);
}

TEST(Cloth, BandsSetTheLengthOfSpectra) {
    const std::string four = with("crimp_balance = 0.25\n", "bands.edges_nm = [400, 500.5, 700]\n");
    EXPECT_NE(refusal(four).expected.find("2 numbers"), std::string::npos);
    std::string text = four;
    text.replace(text.find("[0.001, 0.002, 0.003]"), 21, "0.004");
    text.replace(text.find("[0.5, 0.25, 0]"), 14, "[0.5, 0.25]");
    const Cloth cloth = read_text(text);
    EXPECT_EQ(cloth.bands.edges_nm, (std::vector<double>{400, 500.5, 700}));
    EXPECT_EQ(cloth.warp.fibre.absorption_per_um, (std::vector<double>{0.004, 0.004}));
    EXPECT_EQ(cloth.weft.fibre.color, (std::vector<double>{0.5, 0.25}));
}

TEST(Cloth, DraftComesFromAFileANameOrRows) {
    EXPECT_EQ(draft_rows(read_text(with("weave = \"twill 2/1 Z\"", "rows = ['10', '01']")).draft),
              (Rows{"10", "01"}));

    const tests::TemporaryFolder folder;
    std::filesystem::create_directory(folder.path() / "drafts");
    const auto wif = tests::write_bytes(folder, "drafts/plain.wif", kPlainWif);
    const std::string text = with("weave = \"twill 2/1 Z\"", "draft = 'drafts/plain.wif'");
    const Cloth cloth = read_cloth(tests::write_bytes(folder, "cloth.toml", text));
    EXPECT_EQ(draft_rows(cloth.draft), (Rows{"100", "010"})); // as drawn; end 3 is on no shaft
    EXPECT_EQ(cloth.draft.warnings.size(), 2u);               // on reading, and on weaving
    EXPECT_NE(cloth.source.find("rows = [ '10', '01' ]"), std::string::npos) << cloth.source;
    EXPECT_EQ(cloth.source.find("plain.wif"), std::string::npos);

    const Cloth other = read_cloth(tests::write_bytes(folder, "cloth.toml", kCloth), wif);
    EXPECT_EQ(other.source, cloth.source);
    // A draft that is replaced is not looked for.
    const std::string absent = with("weave = \"twill 2/1 Z\"", "draft = 'absent.wif'");
    EXPECT_EQ(read_cloth(tests::write_bytes(folder, "cloth.toml", absent), wif).source,
              cloth.source);
}

TEST(Cloth, SourceReadsBackAsTheSameCloth) {
    for (const std::string& text :
         {std::string(kCloth), with("130.5", "133.33333333333334"),
          with("name = \"test cloth\"", "name = \"a \\\"quoted\\\" 'née' name\\n\""),
          with("crimp_balance = 0.25\n", "bands.edges_nm = [400, 480, 560, 700]\n")}) {
        const Cloth cloth = read_text(text);
        const Cloth again = read_text(cloth.source);
        EXPECT_EQ(again.source, cloth.source);
        EXPECT_EQ(again.name, cloth.name);
        EXPECT_EQ(again.warp, cloth.warp);
        EXPECT_EQ(again.weft, cloth.weft);
        EXPECT_EQ(again.bands, cloth.bands);
        EXPECT_EQ(draft_rows(again.draft), draft_rows(cloth.draft));
    }
}

TEST(Cloth, SourceFollowsWhatDecidesTheCloth) {
    const std::string source = read_text(kCloth).source;
    EXPECT_EQ(read_text("# a comment\n" + with("= 0.25\n", "  =  0.250\n")).source, source);
    EXPECT_EQ(read_text(with("weave = \"twill 2/1 Z\"", "rows = ['110', '011', '101']")).source,
              source);
    for (const auto& [key, other] : {std::pair("twill 2/1 Z", "twill 2/1 S"),
                                     {"0.25\n", "0.26\n"},
                                     {"= 40", "= 41"},
                                     {"= 30", "= 31"},
                                     {"130.5", "130.6"},
                                     {"= 90", "= 91"},
                                     {"fibres = 61", "fibres = 62"},
                                     {"-700", "700"},
                                     {"0.8", "0.81"},
                                     {"= 150", "= 151"},
                                     {"1.526", "1.527"},
                                     {"0.003]", "0.0031]"},
                                     {"0]", "0.1]"},
                                     {"0.01\n", "0.02\n"},
                                     {"11.9", "11.8"}})
        EXPECT_NE(read_text(with(key, other)).source, source) << key;
}

/// Line and column of the first `words` in `text`.
std::string place_of(const std::string& text, std::string_view words) {
    const size_t place = text.find(words);
    const size_t line_start = place == 0 ? 0 : text.rfind('\n', place - 1) + 1;
    return std::to_string(1 +
                          std::count(text.begin(), text.begin() + std::ptrdiff_t(place), '\n')) +
           ":" + std::to_string(1 + place - line_start);
}

TEST(Cloth, BadValuesAreRefusedAtTheirPlace) {
    struct Case {
        const char *old_words, *new_words, *culprit, *expected;
    };
    for (const Case& c : {
             Case{"ends_per_cm = 40", "ends_per_cm = 0", "0\nsection = \"par", "(0, 1000]"},
             {"picks_per_cm = 30", "picks_per_cm = -1", "-1\n", "(0, 1000]"},
             {"crimp_balance = 0.25", "crimp_balance = 1.5", "1.5\n", "[0, 1]"},
             {"crimp_balance = 0.25", "crimp_balance = nan", "nan", "[0, 1]"},
             {"width_um = 130.5", "width_um = inf", "inf", "(0, 10000]"},
             {"width_um = 130.5", "width_um = '130'", "'130'", "(0, 10000]"},
             {"flatten = 0.8", "flatten = 0", "0\n[warp.fibre]", "(0, 1]"},
             {"flatten = 0.8", "flatten = 1.01", "1.01", "(0, 1]"},
             {"fibres = 37", "fibres = 0", "0\nwidth", "1 … 10000"},
             {"fibres = 37", "fibres = 37.5", "37.5", "1 … 10000"},
             {"fibres = 37", "fibres = 9000000000", "9000000000", "1 … 10000"},
             {"diameter_um = 11.9", "diameter_um = -11.9", "-11.9", "(0, 1000]"},
             {"refractive_index = 1.526", "refractive_index = 0.99", "0.99", "[1, 4]"},
             {"surface_absorption = 0.01", "surface_absorption = 1.1", "1.1", "[0, 1]"},
             {"roughness = 0.2", "roughness = 1.1", "1.1", "[0, 1]"},
             {"[0.5, 0.25, 0]", "[0.5, 1, 0]", "1, 0]", "[0, 1)"},
             {"[0.5, 0.25, 0]", "[0.5, 0.25]", "[0.5, 0.25]", "3 numbers"},
             {"[0.5, 0.25, 0]", "[0.5, 0.25, 0, 0]", "[0.5, 0.25, 0, 0]", "3 numbers"},
             {"[0.5, 0.25, 0]", "0.5", "0.5\nsurface", "3 numbers"},
             {"0.002, 0.003]", "-0.002, 0.003]", "-0.002", "not below 0"},
             {"0.002, 0.003]", "0.003]", "[0.001, 0.003]", "3 numbers"},
             {"twist_per_m = -700", "twist_per_m = true", "true", "a number"},
             {"section = \"twisted\"", "section = \"twist\"", "\"twist\"",
              "\"parallel\" or \"twisted\" or \"plied\""},
             {"fibres = 37", "fibres = 37\ntex = 6", "6\nwidth", "one of 'warp.fibres' and"},
             {"fibres = 37", "tex = 6", "6\nwidth", "'density_g_cm3'"},
             {"diameter_um = 11.9", "diameter_um = 11.9\ndtex = 2", "2\nrefr",
              "one of 'warp.fibre.diameter_um' and"},
             {"diameter_um = 11.9", "dtex = 2", "[warp.fibre]", "density_g_cm3"},
             {"flatten = 0.8", "migration_um = 2", "2\n[warp.fibre]", "together"},
             {"flatten = 0.8", "deviation_degrees = 2", "2\n[warp.fibre]", "together"},
             {"flatten = 0.8", "stray_fibres = 1.2", "1.2", "[0, 1]"},
             {"twist_per_m = -700", "twist_per_m = -700\nplies = 2", "plies", "twist_per_m"},
             {"weave = \"twill 2/1 Z\"", "weave = \"twill 2/1\"", "\"twill 2/1\"", "twill a/b Z"},
             {"weave = \"twill 2/1 Z\"", "weave = 5", "5\n", "a text"},
             {"weave = \"twill 2/1 Z\"", "rows = ['01', '1']", "['01', '1']", "2 crossings"},
             {"weave = \"twill 2/1 Z\"", "rows = ['01', 10]", "10]", "a text"},
             {"weave = \"twill 2/1 Z\"", "rows = []", "[]", "one for each pick"},
             {"weave = \"twill 2/1 Z\"", "draft = 'no.wif'", "'no.wif'", "a draft file"},
             {"weave = \"twill 2/1 Z\"", "draft = ''", "''", "a draft file"},
             {"crimp_balance = 0.25", "rows = ['01', '10']", "['01", "one of 'draft', 'weave'"},
             {"crimp_balance = 0.25", "bands = 3", "3\n", "a table"},
             {"crimp_balance = 0.25", "bands.edges_nm = [400]", "[400]", "2 or more"},
             {"crimp_balance = 0.25", "bands.edges_nm = [400, 400]", "[400, 400]", "increasing"},
             {"crimp_balance = 0.25", "bands.edges_nm = [0, 400]", "0, 400", "above 0"},
             {"absorption_per_um = [0.001", "color = [0.1,0.1,0.1]\nabsorption_per_um = [0.001",
              "[0.1,0.1,0.1]", "one of 'absorption_per_um' and 'color'"},
             {"crimp_balance = 0.25", "crimp = 0.25", "crimp = 0.25", "crimp_balance"},
             {"crimp_balance = 0.25", "\"new\\nline\" = 1", "\"new\\nline\"", "crimp_balance"},
             {"width_um = 130.5", "diameter_um = 130.5", "diameter_um = 130.5", "width_um"},
             {"twist_per_m = -700", "width_um = 7", "width_um = 7", "twist_per_m"},
             {"color = [0.5, 0.25, 0]", "colour = [0.5, 0.25, 0]", "colour", "color"},
             {"fibres = 37", "", "[warp]", "'warp.fibres'"},
             {"ends_per_cm = 40", "", "[warp]", "'warp.ends_per_cm'"},
             {"section = \"parallel\"", "", "[warp]", "'warp.section'"},
             {"crimp_balance = 0.25", "crimp_balance = ", "\n\n[warp]", "TOML"},
         }) {
        const std::string text = with(c.old_words, c.new_words);
        const FileError error = refusal(text);
        EXPECT_EQ(error.place, place_of(text, c.culprit)) << c.new_words << error.what();
        EXPECT_NE(error.expected.find(c.expected), std::string::npos)
            << c.new_words << error.what();
    }
}

TEST(Cloth, WhatIsMissingIsNamed) {
    EXPECT_EQ(refusal(with("weave = \"twill 2/1 Z\"", "")).expected,
              "one of 'draft', 'weave' and 'rows'");
    EXPECT_NE(refusal("weave = 'plain'\n").expected.find("'warp'"), std::string::npos);
    EXPECT_NE(refusal("").expected.find("'warp'"), std::string::npos);
    const tests::TemporaryFolder folder;
    EXPECT_THROW(read_cloth(folder.path() / "absent.toml"), FileError);
    EXPECT_THROW(read_cloth(folder.path()), FileError);
    EXPECT_THROW(viscose_cloth(folder.path() / "absent.wif"), FileError);
}

TEST(Cloth, ADraftThatCannotBeWovenIsRefusedInItsOwnFile) {
    const FileError rows = refusal(with("weave = \"twill 2/1 Z\"", "rows = ['101', '011']"));
    EXPECT_EQ(rows.place, "end 3");

    const tests::TemporaryFolder folder;
    std::string text(kPlainWif);
    const auto wif = tests::write_bytes(
        folder, "float.wif", text.replace(text.find("\n2=2\n", text.find("LIFT")), 5, "\n2=1\n"));
    const auto cloth = tests::write_bytes(folder, "cloth.toml",
                                          with("weave = \"twill 2/1 Z\"", "draft = 'float.wif'"));
    try {
        read_cloth(cloth);
        ADD_FAILURE() << "accepted";
    } catch (const FileError& error) {
        EXPECT_EQ(error.path, wif.string());
        EXPECT_EQ(error.place, "end 1");
    }
}

// Whatever the bytes, reading ends in a cloth or a FileError of one line.
TEST(Cloth, SurvivesRandomDamage) {
    const tests::TemporaryFolder folder;
    int refused = 0;
    for (int round = 0; round < 500; ++round) {
        CounterRng rng(2, Purpose::test, 0, round);
        const auto below = [&](size_t n) { return size_t(rng.uniform() * double(n)); };
        std::string text(kCloth);
        if (round % 4 == 0)
            text.resize(below(text.size()));
        for (size_t flips = 1 + below(4); flips > 0 && !text.empty(); --flips)
            text[below(text.size())] = round % 2 ? char(below(256)) : "019-.=[]{}\"'#\n"[below(14)];
        try {
            read_cloth(tests::write_bytes(folder, "damaged.toml", text));
        } catch (const FileError& error) {
            ++refused;
            EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
        }
    }
    EXPECT_GT(refused, 0);
}

TEST(ViscoseCloth, IsWovenToTheDraft) {
    const tests::TemporaryFolder folder;
    const auto wif = tests::write_bytes(folder, "plain.wif", kPlainWif);
    const Cloth cloth = viscose_cloth(wif);
    EXPECT_EQ(cloth.name, "viscose");
    EXPECT_EQ(cloth.path, wif);
    EXPECT_EQ(draft_rows(cloth.draft), (Rows{"100", "010"}));
    EXPECT_EQ(cloth.warp, cloth.weft);
    EXPECT_EQ(read_text(cloth.source).source, cloth.source);
    // 20·√(dtex/(π·ρ)) [µm] for 1.7 dtex at 1.52 g/cm³.
    EXPECT_NEAR(cloth.warp.fibre.diameter_um, 11.93, 0.05);
}

} // namespace
} // namespace rapport
