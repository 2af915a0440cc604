#include "renderer/core/error.h"

#include <gtest/gtest.h>

using namespace rapport;

TEST(FileError, IsOneLineThatNamesFilePlaceExpectedAndFound) {
    EXPECT_STREQ(FileError("a.wif", 12, "a number", "\"x\"").what(),
                 "a.wif:12: expected a number, found \"x\"");
    EXPECT_STREQ(FileError("a.glb", "meshes[0]", "POSITION", "none").what(),
                 "a.glb:meshes[0]: expected POSITION, found none");
    EXPECT_STREQ(FileError("a.exr", "", "an OpenEXR file", "text").what(),
                 "a.exr: expected an OpenEXR file, found text");
    EXPECT_STREQ(FileError("a.exr", 0, "b", "c").what(), "a.exr: expected b, found c");
    EXPECT_STREQ(FileError("a.wif", 1, "b", "x\ny\x1b[2J").what(),
                 "a.wif:1: expected b, found x y [2J");
    const FileError error("a.wif", 12, "b", "c");
    EXPECT_EQ(error.place, "12");
    EXPECT_EQ(error.expected, "b");
    EXPECT_EQ(error.found, "c");
}
