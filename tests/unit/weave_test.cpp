#include "vgsp/weave.h"

#include "renderer/core/error.h"

#include <gtest/gtest.h>

namespace rapport {
namespace {

using Rows = std::vector<std::string>;

FileError refusal(const Draft& draft) {
    try {
        weavable(draft, "cloth");
    } catch (const FileError& error) {
        return error;
    }
    return FileError("", "", "", "accepted");
}

TEST(Weavable, ReducesToTheSmallestRepeat) {
    Rows rows;
    for (int pick = 0; pick < 12; ++pick)
        rows.push_back(pick % 2 ? "101010" : "010101");
    EXPECT_EQ(draft_rows(weavable(draft_from_rows(rows), "")), (Rows{"01", "10"}));
    EXPECT_EQ(draft_rows(weavable(draft_from_rows({"011011", "101101", "110110"}), "")),
              (Rows{"011", "101", "110"}));
}

TEST(Weavable, KeepsWhatDoesNotRepeatWhole) {
    const Rows five{"10101", "01010"}; // end 5 beside end 1 of the next repeat: not plain
    EXPECT_EQ(draft_rows(weavable(draft_from_rows(five), "")), five);
    const Rows satin = draft_rows(named_weave("satin 8/3"));
    EXPECT_EQ(draft_rows(weavable(named_weave("satin 8/3"), "")), satin);
}

TEST(Weavable, ColoursAreAPartOfTheRepeat) {
    Draft draft = draft_from_rows({"10101010", "01010101", "10101010", "01010101"});
    draft.palette = {{0, 0, 0}, {1, 1, 1}};
    draft.warp_colours = {0, 0, 1, 1, 0, 0, 1, 1};
    draft.weft_colours = {0, 0, 0, 0};
    const Draft woven = weavable(draft, "");
    EXPECT_EQ(woven.ends, 4);
    EXPECT_EQ(woven.picks, 2);
    EXPECT_EQ(woven.warp_colours, (std::vector<int>{0, 0, 1, 1}));
    EXPECT_EQ(woven.weft_colours, (std::vector<int>{0, 0}));
    EXPECT_EQ(woven.palette.size(), 2u);

    draft.weft_colours = {0, 0, 0, 1};
    EXPECT_EQ(weavable(draft, "").picks, 4);
}

TEST(Weavable, DropsOnlyWhatTheDraftLeavesOpen) {
    Draft draft = draft_from_rows({"1000", "0000", "0010"});
    draft.unthreaded_ends = {1, 3};
    draft.empty_picks = {1};
    draft.palette.resize(4);
    draft.warp_colours = {0, 1, 2, 3};
    draft.weft_colours = {3, 2, 1};
    const Draft woven = weavable(draft, "");
    EXPECT_EQ(draft_rows(woven), (Rows{"10", "01"}));
    EXPECT_EQ(woven.warp_colours, (std::vector<int>{0, 2}));
    EXPECT_EQ(woven.weft_colours, (std::vector<int>{3, 1}));
    EXPECT_TRUE(woven.unthreaded_ends.empty());
    ASSERT_EQ(woven.warnings.size(), 1u);
    EXPECT_NE(woven.warnings[0].find("2 unthreaded ends and 1 empty picks"), std::string::npos);

    draft.unthreaded_ends = {3};
    EXPECT_EQ(refusal(draft).place, "end 2"); // threaded, but on top nowhere
}

TEST(Weavable, NamesWhatNeverInterlaces) {
    EXPECT_EQ(refusal(draft_from_rows({"101", "011"})).place, "end 3");
    EXPECT_NE(refusal(draft_from_rows({"101", "011"})).found.find("over every pick"),
              std::string::npos);
    EXPECT_NE(refusal(draft_from_rows({"100", "010"})).found.find("under every pick"),
              std::string::npos);
    // Every end interlaces here, pick 3 lies below them all.
    EXPECT_EQ(refusal(draft_from_rows({"10", "01", "11"})).place, "pick 3");
    EXPECT_NE(refusal(draft_from_rows({"10", "01", "11"})).found.find("under every end"),
              std::string::npos);
    EXPECT_EQ(refusal(draft_from_rows({"1"})).place, "end 1");
    EXPECT_EQ(refusal(draft_from_rows({"1"})).path, "cloth");
}

TEST(Weavable, CountsInTheDraftsOwnNumbers) {
    Draft draft = draft_from_rows({"0010", "0000", "0001", "0011"});
    draft.unthreaded_ends = {0, 1};
    draft.empty_picks = {1};
    EXPECT_EQ(refusal(draft).place, "pick 4");
    draft.unthreaded_ends = {0};
    EXPECT_EQ(refusal(draft).place, "end 2");
}

TEST(Weavable, RefusesADraftThatIsEmpty) {
    Draft draft = draft_from_rows({"00", "00"});
    draft.unthreaded_ends = {0, 1};
    EXPECT_EQ(refusal(draft).found, "no end on a shaft");
    draft.unthreaded_ends.clear();
    draft.empty_picks = {0, 1};
    EXPECT_EQ(refusal(draft).found, "no pick that raises a shaft");
}

} // namespace
} // namespace rapport
