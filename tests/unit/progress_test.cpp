#include "renderer/core/progress.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <sstream>
#include <thread>

using namespace rapport;
using namespace std::chrono_literals;

TEST(Duration, IsWrittenAsOnAClock) {
    EXPECT_EQ(format_duration(0), "0:00");
    EXPECT_EQ(format_duration(7.4), "0:07");
    EXPECT_EQ(format_duration(59.6), "1:00");
    EXPECT_EQ(format_duration(754), "12:34");
    EXPECT_EQ(format_duration(3 * 3600 + 5), "3:00:05");
    EXPECT_EQ(format_duration(-1), "0:00");
}

TEST(ProgressLine, TellsShareMeasureAndTimeLeft) {
    std::ostringstream out;
    {
        ProgressLine line(out, "satin.toml");
        line.update(0.42, "1.2 M paths/s, accuracy 0.031", 75);
        EXPECT_EQ(out.str(), "\r\x1b[Ksatin.toml  42 %, 1.2 M paths/s, accuracy 0.031, 1:15 left");
    }
    EXPECT_TRUE(out.str().ends_with("left\r\x1b[K")); // nothing stays on the terminal
}

TEST(ProgressLine, IsThrottledAndSilentWithoutWork) {
    std::ostringstream out;
    { ProgressLine line(out, "x"); }
    EXPECT_EQ(out.str(), "");
    ProgressLine line(out, "x");
    const auto start = std::chrono::steady_clock::now();
    for (int i = 0; i < 100000; ++i)
        line.update(i / 1e5);
    const auto intervals = (std::chrono::steady_clock::now() - start) / 200ms;
    const std::string text = out.str();
    EXPECT_GE(std::ranges::count(text, '\r'), 1);
    EXPECT_LE(std::ranges::count(text, '\r'), 1 + intervals);
}

TEST(ProgressLine, EstimatesTheTimeLeftFromTheShare) {
    std::ostringstream out;
    ProgressLine line(out, "x");
    std::this_thread::sleep_for(20ms);
    line.update(1e-5); // 20 ms and more for a hundred-thousandth: over half an hour
    EXPECT_NE(out.str().find(" left"), std::string::npos);
    EXPECT_GE(out.str().find("0:00"), out.str().size());
    EXPECT_EQ(out.str().find("nan"), std::string::npos);

    std::ostringstream at_start;
    ProgressLine unknown(at_start, "x");
    unknown.update(0);
    EXPECT_EQ(at_start.str(), "\r\x1b[Kx   0 %");
}
