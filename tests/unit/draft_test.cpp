#include "vgsp/draft.h"

#include <gtest/gtest.h>

namespace rapport {
namespace {

using Rows = std::vector<std::string>;

TEST(NamedWeave, PlainHasEndOnePassOverPickOne) {
    EXPECT_EQ(draft_rows(named_weave("plain")), (Rows{"10", "01"}));
}

// Row 1 is pick 1, which pictures show at the bottom: from row to row the Z line moves right.
TEST(NamedWeave, TwillZRisesToTheRight) {
    EXPECT_EQ(draft_rows(named_weave("twill 2/2 Z")), (Rows{"1100", "0110", "0011", "1001"}));
    EXPECT_EQ(draft_rows(named_weave("twill 3/1 Z")), (Rows{"1110", "0111", "1011", "1101"}));
}

TEST(NamedWeave, TwillSRisesToTheLeft) {
    EXPECT_EQ(draft_rows(named_weave("twill 2/2 S")), (Rows{"1100", "1001", "0011", "0110"}));
    EXPECT_EQ(draft_rows(named_weave("twill 1/2 S")), (Rows{"100", "001", "010"}));
}

TEST(NamedWeave, TwillEndsGoOverThenUnderThatManyPicks) {
    const Draft draft = named_weave("twill 3/2 Z");
    for (int end = 0; end < 5; ++end) {
        int ups = 0, turns = 0;
        for (int pick = 0; pick < 5; ++pick) {
            ups += draft.up(end, pick);
            turns += draft.up(end, pick) != draft.up(end, (pick + 1) % 5);
        }
        EXPECT_EQ(ups, 3);
        EXPECT_EQ(turns, 2);
    }
}

TEST(NamedWeave, SatinIsWarpFacedAndSateenItsOpposite) {
    EXPECT_EQ(draft_rows(named_weave("satin 5/2")),
              (Rows{"01111", "11011", "11110", "10111", "11101"}));
    EXPECT_EQ(draft_rows(named_weave("sateen 5/2")),
              (Rows{"10000", "00100", "00001", "01000", "00010"}));
    EXPECT_EQ(draft_rows(named_weave("sateen 8/3"))[1], "00010000");
}

TEST(NamedWeave, BasketDoublesPlainInBothDirections) {
    EXPECT_EQ(draft_rows(named_weave("basket 2")), (Rows{"1100", "1100", "0011", "0011"}));
}

TEST(NamedWeave, CaseAndSpaceDoNotMatter) {
    EXPECT_EQ(draft_rows(named_weave("  Twill\t2/1  z ")), draft_rows(named_weave("twill 2/1 Z")));
}

TEST(NamedWeave, SaysWhatIsValid) {
    const auto expected = [](const char* name) -> std::string {
        try {
            named_weave(name);
        } catch (const InvalidWeave& error) {
            EXPECT_NE(error.found.find(name), std::string::npos);
            return error.expected;
        }
        return "accepted";
    };
    for (const char* name : {"", "herringbone", "plain 2", "satinn 5/2"})
        EXPECT_NE(expected(name).find("\"plain\""), std::string::npos) << name;
    for (const char* name : {"twill", "twill 2/2", "twill 2/2 X", "twill 0/2 Z", "twill 2 Z",
                             "twill -1/2 Z", "twill 2/2/1 Z", "twill 999999999999/1 Z"})
        EXPECT_NE(expected(name).find("twill a/b Z"), std::string::npos) << name;
    EXPECT_NE(expected("satin 8/2").find("3, 5"), std::string::npos);
    EXPECT_NE(expected("satin 5/4").find("2, 3"), std::string::npos); // a twill
    EXPECT_NE(expected("satin 6/5").find("5 ends or on 7"), std::string::npos);
    EXPECT_NE(expected("sateen 5").find("sateen n/s"), std::string::npos);
    EXPECT_NE(expected("basket 1").find("2 …"), std::string::npos);
    EXPECT_NE(expected("basket 501").find("… 500"), std::string::npos);
}

TEST(NamedWeave, EveryMoveThatTheMessageOffersInterlacesOncePerEnd) {
    for (const int move : {3, 5}) {
        const Draft draft = named_weave("satin 8/" + std::to_string(move));
        for (int end = 0; end < 8; ++end) {
            int ups = 0;
            for (int pick = 0; pick < 8; ++pick)
                ups += draft.up(end, pick);
            EXPECT_EQ(ups, 7);
        }
    }
}

TEST(DraftRows, KeepTheirOrder) {
    const Rows rows{"0111", "1000"};
    const Draft draft = draft_from_rows(rows);
    EXPECT_EQ(draft.ends, 4);
    EXPECT_EQ(draft.picks, 2);
    EXPECT_FALSE(draft.up(0, 0));
    EXPECT_TRUE(draft.up(1, 0));
    EXPECT_TRUE(draft.up(0, 1));
    EXPECT_EQ(draft_rows(draft), rows);
}

TEST(DraftRows, RefuseWhatIsNoMatrix) {
    EXPECT_THROW(draft_from_rows({}), InvalidWeave);
    EXPECT_THROW(draft_from_rows({""}), InvalidWeave);
    EXPECT_THROW(draft_from_rows({"01", "0"}), InvalidWeave);
    EXPECT_THROW(draft_from_rows({"01", "1x"}), InvalidWeave);
    EXPECT_THROW(draft_from_rows(Rows(size_t(kMaxThreads) + 1, "1")), InvalidWeave);
}

} // namespace
} // namespace rapport
