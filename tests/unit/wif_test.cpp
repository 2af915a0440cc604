#include "vgsp/draft.h"

#include "renderer/core/error.h"
#include "renderer/core/rng.h"
#include "tests/support/file_bytes.h"
#include "tests/support/long_run.h"
#include "tests/support/refusal.h"
#include "tests/support/shared_data.h"
#include "tests/support/temporary_folder.h"
#include "vgsp/weave.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <map>
#include <sstream>

namespace rapport {
namespace {

using Rows = std::vector<std::string>;

/// A 4-end twill by tie-up and treadling, in sections that a test can exchange or leave out.
std::map<std::string, std::string> twill_sections() {
    return {{"WIF", "Version=1.1\n"},
            {"WEAVING", "Shafts=4\nTreadles=4\nRising Shed=yes\n"},
            {"WARP", "Threads=4\n"},
            {"WEFT", "Threads=4\n"},
            {"THREADING", "1=1\n2=2\n3=3\n4=4\n"},
            {"TIEUP", "1=1,2\n2=2,3\n3=3,4\n4=1,4\n"},
            {"TREADLING", "1=1\n2=2\n3=3\n4=4\n"}};
}

std::string wif_text(const std::map<std::string, std::string>& sections) {
    std::string text;
    for (const auto& [name, entries] : sections)
        text += "[" + name + "]\n" + entries;
    return text;
}

Draft read_text(std::string_view text) {
    const tests::TemporaryFolder folder;
    return read_wif(tests::write_bytes(folder, "draft.wif", text));
}

FileError refusal(std::string_view text) {
    return tests::refusal_of([&] { read_text(text); });
}

bool warns(const Draft& draft, std::string_view words) {
    for (const std::string& warning : draft.warnings)
        if (warning.find(words) != std::string::npos)
            return true;
    return false;
}

const Rows kTwill{"1100", "0110", "0011", "1001"};

std::vector<std::filesystem::path> files_in(const std::filesystem::path& folder) {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
        if (entry.path().extension() == ".wif")
            files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    return files;
}

/// A plain PBM, in which the digits of a row need no space between them.
Rows read_pbm(const std::filesystem::path& path) {
    std::istringstream file(tests::read_bytes(path));
    std::string magic, comment;
    std::getline(file, magic);
    std::getline(file, comment);
    size_t width = 0, height = 0;
    file >> width >> height;
    Rows rows(height);
    char digit;
    for (std::string& row : rows)
        while (row.size() < width && file >> digit)
            row += digit;
    return rows;
}

TEST(SharedDrafts, EqualTheirGoldenInterlacement) {
    RAPPORT_SHARED_DATA_OR_SKIP(data);
    const auto files = files_in(data / "wif");
    EXPECT_EQ(files.size(), 18u);
    for (const auto& file : files) {
        const auto golden = data / "wif" / "golden" / file.filename().replace_extension(".pbm");
        EXPECT_TRUE(draft_rows(read_wif(file)) == read_pbm(golden)) << file;
    }
}

TEST(SharedDrafts, CanBeWovenOnceTrimmed) {
    RAPPORT_SHARED_DATA_OR_SKIP(data);
    for (const auto& file : files_in(data / "wif")) {
        const Draft draft = read_wif(file);
        const Draft woven = weavable(draft, file.string());
        EXPECT_LE(woven.ends, draft.ends) << file;
        EXPECT_GE(woven.ends, 2) << file;
    }
    const auto sparse = data / "wif" / "r-owen_MIT_many_color_single_treadles.wpo.wif";
    EXPECT_TRUE(warns(read_wif(sparse), "1196 of 1200 ends are on no shaft; the first is end 5"));
    const Draft woven = weavable(read_wif(sparse), sparse.string());
    EXPECT_EQ(woven.ends, 4);
    EXPECT_EQ(woven.picks, 6);
}

TEST(SharedDrafts, BadOnesAreRefusedAtTheirLine) {
    RAPPORT_SHARED_DATA_OR_SKIP(data);
    const std::map<std::string, std::pair<std::string, std::string>> errors = {
        {"default_warp_color_too_big", {"82", "colour 11"}},
        {"missing_color_table_warp", {"58", "no such table"}},
        {"missing_liftplan", {"62", "the end of the file"}},
        {"missing_tieup", {"70", "the end of the file"}},
        {"missing_treadling", {"70", "the end of the file"}},
        {"too_many_treadles_in_treadline", {"44", "treadle 7"}},
        {"warp_color_too_big", {"39", "colour 11"}},
    };
    const auto files = files_in(data / "wif" / "bad");
    EXPECT_EQ(files.size(), errors.size());
    for (const auto& file : files) {
        const auto expected = errors.find(file.stem().string());
        ASSERT_NE(expected, errors.end()) << file;
        try {
            read_wif(file);
            ADD_FAILURE() << file << " was accepted";
        } catch (const FileError& error) {
            EXPECT_EQ(error.path, file.string());
            EXPECT_EQ(error.place, expected->second.first) << error.what();
            EXPECT_NE(error.found.find(expected->second.second), std::string::npos) << error.what();
        }
    }
}

// Whatever the bytes, reading ends in a draft of bounded size or a FileError of one line.
TEST(SharedDrafts, SurviveRandomDamage) {
    RAPPORT_SHARED_DATA_OR_SKIP(data);
    const tests::TemporaryFolder folder;
    auto files = files_in(data / "wif");
    for (const auto& file : files_in(data / "wif" / "bad"))
        files.push_back(file);
    const int rounds = tests::long_run() ? 2000 : 40;
    int refused = 0;
    for (size_t f = 0; f < files.size(); ++f) {
        const std::string original = tests::read_bytes(files[f]);
        for (int round = 0; round < rounds; ++round) {
            CounterRng rng(1, Purpose::test, f, round);
            const auto below = [&](size_t n) { return size_t(rng.uniform() * double(n)); };
            std::string text = original;
            if (round % 2)
                text.resize(below(text.size()));
            const size_t flips = round % 4 == 1 ? 0 : 1 + below(8);
            for (size_t i = 0; i < flips && !text.empty(); ++i)
                text[below(text.size())] =
                    round % 3 ? char(below(256)) : "0123456789=,[];\r\n"[below(17)];
            try {
                const Draft draft = read_wif(tests::write_bytes(folder, "damaged.wif", text));
                EXPECT_LE(int64_t(draft.ends) * draft.picks, kMaxCrossings);
                EXPECT_EQ(draft.warp_up.size(), size_t(draft.ends) * draft.picks);
            } catch (const FileError& error) {
                ++refused;
                EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
            }
        }
    }
    EXPECT_GT(refused, 0);
}

TEST(Wif, TieupAndTreadlingMakeTheInterlacement) {
    const Draft draft = read_text(wif_text(twill_sections()));
    EXPECT_EQ(draft_rows(draft), kTwill);
    EXPECT_TRUE(draft.warnings.empty());
    EXPECT_TRUE(draft.warp_colours.empty());
}

TEST(Wif, TieupAndTreadlingWinOverALiftplan) {
    auto sections = twill_sections();
    sections["LIFTPLAN"] = "1=4\n2=3\n3=2\n4=1\n";
    const Draft both = read_text(wif_text(sections));
    EXPECT_EQ(draft_rows(both), kTwill);
    EXPECT_TRUE(warns(both, "[LIFTPLAN] is passed over"));

    sections["TREADLING"] = ""; // a header alone does not count
    EXPECT_EQ(draft_rows(read_text(wif_text(sections))), (Rows{"0001", "0010", "0100", "1000"}));
    sections.erase("TIEUP");
    EXPECT_EQ(draft_rows(read_text(wif_text(sections))), (Rows{"0001", "0010", "0100", "1000"}));
}

TEST(Wif, SinkingShedInverts) {
    auto sections = twill_sections();
    sections["WEAVING"] = "Shafts=4\nTreadles=4\nRising Shed=no\n";
    EXPECT_EQ(draft_rows(read_text(wif_text(sections))), (Rows{"0011", "1001", "1100", "0110"}));
}

TEST(Wif, AnyOrderCaseLineEndAndCommentReadsTheSame) {
    const std::string untidy =
        "\xEF\xBB\xBF; a draft\r\n\r\n"
        "[Notes]\r\n1=caf\xE9 [caf\xC3\xA9]\r\npasted = junk; here\r\nor there\r\n"
        "[treadling] ; order is free\r\n 4 = 4\r\n1=1\r\n3=3 ; three\r\n2=2\r\n"
        "[TieUp]\r\n1=2,1\r\n2= 2 , 3\r\n3=3,4,\r\n4=0,4,1\r\n"
        "[weft]\r\nTHREADS = 4 ; picks\r\nUnits=Inches\r\n"
        "[Weaving]\r\nrising shed=ON ; yes\r\nShafts=4\r\nTreadles=4\r\n"
        "[PRIVATE X Y]\r\n1=[\r\n[CONTENTS]\r\nWARP=maybe\r\n"
        "[Warp]\r\nthreads=4\r\n[threading]\r\n4=4\r\n3=3\r\n2=2\r\n1=1";
    const Draft draft = read_text(untidy);
    EXPECT_EQ(draft_rows(draft), kTwill);
    EXPECT_TRUE(draft.warnings.empty());

    std::string old_mac = wif_text(twill_sections());
    std::replace(old_mac.begin(), old_mac.end(), '\n', '\r');
    EXPECT_EQ(draft_rows(read_text(old_mac)), kTwill);
}

TEST(Wif, SparseEntriesAreReadAndReported) {
    auto sections = twill_sections();
    sections["THREADING"] = "1=1,3\n2=\n3=0\n4=4\n5=0\n";
    sections["TREADLING"] = "1=1\n3=1,4\n4=\n";
    const Draft draft = read_text(wif_text(sections));
    EXPECT_EQ(draft_rows(draft), (Rows{"1000", "0000", "1001", "0000"}));
    EXPECT_EQ(draft.unthreaded_ends, (std::vector<int>{1, 2}));
    EXPECT_EQ(draft.empty_picks, (std::vector<int>{1, 3}));
    EXPECT_TRUE(warns(draft, "2 of 4 ends are on no shaft; the first is end 2"));
    EXPECT_TRUE(warns(draft, "2 of 4 picks raise nothing; the first is pick 2"));
}

TEST(Wif, ShaftsAndTreadlesAboveTheirCountAreReported) {
    auto sections = twill_sections();
    sections["WEAVING"] = "Shafts=3\nTreadles=3\nRising Shed=1\n";
    const Draft draft = read_text(wif_text(sections));
    EXPECT_EQ(draft_rows(draft), kTwill);
    EXPECT_TRUE(warns(draft, "[THREADING] uses shaft 4, above Shafts=3"));
    EXPECT_TRUE(warns(draft, "[TIEUP] uses shaft 4 (and 1 more), above Shafts=3"));
    EXPECT_TRUE(warns(draft, "[TREADLING] uses treadle 4, above Treadles=3"));
}

TEST(Wif, ATreadleMayBeTiedToNothingButMustBeKnown) {
    auto sections = twill_sections();
    sections["TIEUP"] = "1=1,2\n2=2,3\n3=3,4\n";
    const Draft draft = read_text(wif_text(sections));
    EXPECT_EQ(draft_rows(draft)[3], "0000");
    EXPECT_EQ(draft.empty_picks, (std::vector<int>{3}));
    EXPECT_TRUE(warns(draft, "treadle 4 is tied to no shaft"));
    sections["WEAVING"] = "Treadles=3\nRising Shed=1\n";
    EXPECT_EQ(refusal(wif_text(sections)).found, "treadle 4");
}

TEST(Wif, WhatWeavingLeavesOutIsSaid) {
    auto sections = twill_sections();
    sections.erase("WEAVING");
    const Draft draft = read_text(wif_text(sections));
    EXPECT_EQ(draft_rows(draft), kTwill);
    EXPECT_TRUE(warns(draft, "taken as rising"));
    sections["WEAVING"] = "Profile=yes\nRising Shed=yes\n";
    EXPECT_TRUE(warns(read_text(wif_text(sections)), "profile draft"));
}

TEST(Wif, ColoursFollowTheirTableAndRange) {
    auto sections = twill_sections();
    sections["COLOR PALETTE"] = "Range=0,999\nEntries=3\n";
    sections["COLOR TABLE"] = "1=0,0,0\n2=999,0,0\n7=0,0,999\n";
    sections["WARP"] = "Threads=4\nColor=2\n";
    sections["WARP COLORS"] = "2=7,0,0,999\n3=1\n4=0\n"; // the old form repeats the colour
    sections["WEFT COLORS"] = "1=2\n2=2\n";
    const Draft draft = read_text(wif_text(sections));
    ASSERT_EQ(draft.palette.size(), 3u);
    EXPECT_EQ(draft.palette[2], (std::array<double, 3>{0, 0, 1}));
    EXPECT_EQ(draft.warp_colours, (std::vector<int>{1, 2, 0, 1}));
    EXPECT_EQ(draft.weft_colours, (std::vector<int>{1, 1, 0, 0}));
    EXPECT_TRUE(warns(draft, "2 of 4 threads of the weft have no colour"));
}

/// The line of `words` in the text, for errors that should point at it.
std::string line_of(const std::string& text, const std::string& words) {
    const auto end = text.begin() + std::ptrdiff_t(text.find(words));
    return std::to_string(1 + std::count(text.begin(), end, '\n'));
}

TEST(Wif, AmbiguousTextIsRefusedAtItsLine) {
    struct Case {
        const char *section, *entries, *culprit, *expected;
    };
    for (const Case& c : {
             Case{"THREADING", "1=1\n2=2\n0=3\n", "0=3", "numbered 1 or more"},
             {"THREADING", "1=1\n2=2\n5=3\n", "5=3", "end 1 … 4"},
             {"THREADING", "1=1\n2=2\n02=3\n", "02=3", "one entry 2"},
             {"THREADING", "1=1\n2=-2\n", "2=-2", "a shaft"},
             {"THREADING", "1=1\n2=two\n", "2=two", "a shaft"},
             {"THREADING", "1=1\n2=99999999999999\n", "2=999", "a shaft"},
             {"THREADING", "1=1\n<html>\n", "<html>", "key=value"},
             {"THREADING", "1=1\n[2=1\n", "[2=1", "key=value"},
             {"TREADLING", "5=1\n", "5=1", "pick 1 … 4"},
             {"TREADLING", "1=9\n", "1=9", "a treadle that [TIEUP] ties"},
             {"TIEUP", "0=1,2\n1=1\n", "0=1,2", "numbered 1 or more"},
             {"WEAVING", "Rising Shed=perhaps\n", "Rising", "true, on, yes"},
             {"WARP", "Threads=0\n", "Threads=0", "1 … 100000"},
             {"WARP", "Threads=2000000000\n", "Threads=2", "1 … 100000"},
             {"WARP", "Threads=4\nThreads=5\n", "Threads=5", "one \"threads\""},
             {"WARP", "Spacing=1\n", "[WARP]", "Threads="},
             {"WARP COLORS", "1=1\n", "1=1\n[WEAVING", "a colour of [COLOR TABLE]"},
             {"COLOR TABLE", "1=1,2\n", "1=1,2\n[THR", "red,green,blue"},
             {"COLOR TABLE", "1=1,2,256\n", "1=1,2,256", "0 … 255"},
         }) {
        auto sections = twill_sections();
        sections[c.section] = c.entries;
        const std::string text = wif_text(sections);
        const FileError error = refusal(text);
        EXPECT_EQ(error.place, line_of(text, c.culprit)) << c.entries << error.what();
        EXPECT_NE(error.expected.find(c.expected), std::string::npos) << c.entries << error.what();
    }
}

TEST(Wif, ColourRangeIsAnInterval) {
    auto sections = twill_sections();
    sections["COLOR TABLE"] = "1=0,0,0\n";
    for (const char* range : {"Range=0\n", "Range=9,9\n", "Range=0,255,255\n"}) {
        sections["COLOR PALETTE"] = range;
        EXPECT_EQ(refusal(wif_text(sections)).expected, "Range=low,high");
    }
    sections.erase("COLOR PALETTE");
    EXPECT_TRUE(warns(read_text(wif_text(sections)), "taken as 0,255"));
}

TEST(Wif, MissingAndDoubledSectionsAreNamed) {
    for (const char* name : {"WARP", "WEFT", "THREADING", "TIEUP", "TREADLING"}) {
        auto sections = twill_sections();
        sections.erase(name);
        EXPECT_NE(refusal(wif_text(sections)).expected.find("[" + std::string(name) + "]"),
                  std::string::npos);
    }
    const std::string text = wif_text(twill_sections());
    const FileError error = refusal(text + text);
    EXPECT_EQ(error.expected, "one section [THREADING]");
    EXPECT_EQ(error.place, std::to_string(1 + std::count(text.begin(), text.end(), '\n')));
    EXPECT_EQ(refusal("a letter\nto nobody\n").expected, "a [SECTION] header");
    EXPECT_EQ(refusal("").place, "1");
    EXPECT_EQ(refusal("\xFF\xFE[\0").found, "UTF-16");
}

TEST(Wif, HugeDraftsAreRefusedBeforeTheyAreBuilt) {
    auto sections = twill_sections();
    sections["WARP"] = "Threads=100000\n";
    sections["WEFT"] = "Threads=100000\n";
    EXPECT_NE(refusal(wif_text(sections)).expected.find("100000000 crossings"), std::string::npos);

    // Few crossings, but each end on very many shafts.
    std::string shafts = "1";
    for (int shaft = 2; shaft <= 1200; ++shaft)
        shafts += "," + std::to_string(shaft);
    sections["WARP"] = "Threads=4\n";
    sections["THREADING"] = "1=" + shafts + "\n";
    EXPECT_NE(refusal(wif_text(sections)).expected.find("100000000 crossings"), std::string::npos);
}

TEST(Wif, WhatIsNoFileIsRefused) {
    const tests::TemporaryFolder folder;
    EXPECT_THROW(read_wif(folder.path() / "absent.wif"), FileError);
    EXPECT_THROW(read_wif(folder.path()), FileError);
}

} // namespace
} // namespace rapport
