#include "renderer/core/image.h"

#include "renderer/core/error.h"
#include "renderer/core/rng.h"
#include "renderer/core/srgb.h"
#include "tests/support/file_bytes.h"
#include "tests/support/temporary_folder.h"

#include <ImathBox.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfDeepScanLineOutputFile.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfOutputPart.h>
#include <OpenEXR/ImfPartType.h>
#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <stb/stb_image.h>

using namespace rapport;
using namespace rapport::tests;

namespace {

Image noise_image(int width, int height, std::vector<std::string> channels) {
    Image image(width, height, std::move(channels));
    CounterRng rng(3, Purpose::test, 0, 0);
    for (std::vector<float>& plane : image.data)
        for (float& value : plane)
            value = static_cast<float>(rng.uniform());
    return image;
}

std::string exr_error(const std::filesystem::path& path) {
    try {
        read_exr(path);
    } catch (const FileError& error) {
        EXPECT_EQ(error.path, path.string());
        return error.what();
    }
    return "";
}

/// A picture of one channel "Y" written with OpenEXR itself.
void write_foreign(const std::filesystem::path& path, const Imath::Box2i& window,
                   Imf::PixelType type, Imf::Compression compression, const void* pixels,
                   int sampling = 1) {
    Imf::Header header(Imath::Box2i({0, 0}, {99, 99}), window);
    header.compression() = compression;
    header.channels().insert("Y", Imf::Channel(type, sampling, sampling));
    Imf::FrameBuffer frame;
    frame.insert("Y", Imf::Slice::Make(type, pixels, window, 0, 0, sampling, sampling));
    Imf::OutputFile file(path.c_str(), header);
    file.setFrameBuffer(frame);
    file.writePixels(window.max.y - window.min.y + 1);
}

} // namespace

TEST(Exr, RoundTripIsExact) {
    const TemporaryFolder folder;
    Image image = noise_image(37, 19, {"R", "G", "B", "Z", "variance.R"});
    (*image.find("Z"))[5] = std::numeric_limits<float>::infinity();
    (*image.find("R"))[7] = -1e-40f;
    image.attributes["samples"] = "64";
    image.attributes["command"] = "render a.pbrt";
    write_exr(image, folder / "a.exr");
    const Image again = read_exr(folder / "a.exr");
    EXPECT_EQ(again.width, 37);
    EXPECT_EQ(again.height, 19);
    EXPECT_EQ(again.attributes, image.attributes);
    ASSERT_EQ(again.channels.size(), image.channels.size());
    for (const std::string& channel : image.channels) // stored in alphabetic order
        EXPECT_EQ(*again.find(channel), *image.find(channel)) << channel;
    EXPECT_EQ(again.find("absent"), nullptr);

    write_exr(image, folder / "b.exr");
    EXPECT_EQ(read_bytes(folder / "a.exr"), read_bytes(folder / "b.exr"));
}

TEST(Exr, ReadsOtherDepthsCodecsAndWindows) {
    const TemporaryFolder folder;
    const Imath::Box2i window({-3, 5}, {12, 20}); // 16 × 16, not at the origin
    std::vector<half> halves(256);
    std::vector<uint32_t> integers(256);
    for (int i = 0; i < 256; ++i) {
        halves[i] = half(0.25f * i);
        integers[i] = 1000 * i;
    }
    write_foreign(folder / "half.exr", window, Imf::HALF, Imf::PIZ_COMPRESSION, halves.data());
    write_foreign(folder / "uint.exr", window, Imf::UINT, Imf::ZIPS_COMPRESSION, integers.data());
    write_foreign(folder / "dwa.exr", window, Imf::HALF, Imf::DWAA_COMPRESSION, halves.data());
    const Image from_half = read_exr(folder / "half.exr");
    const Image from_uint = read_exr(folder / "uint.exr");
    const Image from_dwa = read_exr(folder / "dwa.exr");
    EXPECT_EQ(from_half.width, 16);
    EXPECT_EQ(from_half.height, 16);
    for (int i = 0; i < 256; ++i) {
        EXPECT_EQ(from_half.data[0][i], 0.25f * i);
        EXPECT_EQ(from_uint.data[0][i], 1000.0f * i);
        EXPECT_NEAR(from_dwa.data[0][i], 0.25f * i, 1.0f); // a lossy codec
    }
}

TEST(Exr, RefusesWhatIsNoPlainPicture) {
    const TemporaryFolder folder;
    Imf::Header header(4, 4);
    header.channels().insert("Y", Imf::Channel(Imf::HALF));
    header.setType(Imf::SCANLINEIMAGE);
    {
        std::vector<Imf::Header> headers{header, header};
        headers[0].setName("left");
        headers[1].setName("right");
        const std::vector<half> pixels(16);
        Imf::MultiPartOutputFile file((folder / "parts.exr").c_str(), headers.data(), 2);
        for (int part = 0; part < 2; ++part) {
            Imf::OutputPart output(file, part);
            Imf::FrameBuffer frame;
            frame.insert("Y", Imf::Slice::Make(Imf::HALF, pixels.data(), header.dataWindow()));
            output.setFrameBuffer(frame);
            output.writePixels(4);
        }
    }
    EXPECT_NE(exr_error(folder / "parts.exr").find("2 parts"), std::string::npos);

    header.setType(Imf::DEEPSCANLINE);
    header.compression() = Imf::NO_COMPRESSION;
    { Imf::DeepScanLineOutputFile file((folder / "deep.exr").c_str(), header); }
    EXPECT_NE(exr_error(folder / "deep.exr").find("deep"), std::string::npos);

    const std::vector<half> pixels(256);
    write_foreign(folder / "sub.exr", Imath::Box2i({0, 0}, {15, 15}), Imf::HALF,
                  Imf::ZIP_COMPRESSION, pixels.data(), 2);
    EXPECT_NE(exr_error(folder / "sub.exr").find("subsampled"), std::string::npos);

    write_bytes(folder / "text.exr", "this is no picture");
    EXPECT_NE(exr_error(folder / "text.exr").find("another kind"), std::string::npos);
    write_bytes(folder / "empty.exr", "");
    EXPECT_NE(exr_error(folder / "empty.exr"), "");
    EXPECT_NE(exr_error(folder / "absent.exr").find("no such file"), std::string::npos);
    EXPECT_NE(exr_error(folder.path()).find("a folder"), std::string::npos);
}

TEST(Exr, EveryTruncationIsAnError) {
    const TemporaryFolder folder;
    write_exr(noise_image(40, 40, {"R", "G", "B"}), folder / "whole.exr");
    const std::string whole = read_bytes(folder / "whole.exr");
    for (int i = 0; i < 250; ++i) {
        const size_t length = i < 200 ? whole.size() * i / 200 : whole.size() - (i - 199);
        write_bytes(folder / "cut.exr", whole.substr(0, length));
        EXPECT_NE(exr_error(folder / "cut.exr"), "") << length << " of " << whole.size();
    }
    write_bytes(folder / "cut.exr", whole);
    EXPECT_EQ(exr_error(folder / "cut.exr"), "");
}

TEST(Exr, ASmallFileCannotAskForMuchMemory) {
    const TemporaryFolder folder;
    write_exr(Image(4, 4, {"Y"}), folder / "whole.exr");
    const std::string whole = read_bytes(folder / "whole.exr");
    const size_t window = whole.find("box2i") + 6 + 4; // type name, its null, then the length
    ASSERT_LT(window, whole.size());
    for (const int32_t extent : {-1, 1 << 16, 1 << 20, 0x7FFFFFFF}) {
        std::string bytes = whole; // the data window's two corners
        const int32_t corners[4] = {0, 0, extent, extent};
        bytes.replace(window, sizeof corners, reinterpret_cast<const char*>(corners),
                      sizeof corners);
        write_bytes(folder / "huge.exr", bytes);
        EXPECT_NE(exr_error(folder / "huge.exr"), "") << extent;
    }
}

TEST(Exr, FlippedBytesNeverCrash) {
    const TemporaryFolder folder;
    write_exr(noise_image(20, 20, {"R", "G", "B"}), folder / "whole.exr");
    const std::string whole = read_bytes(folder / "whole.exr");
    CounterRng rng(1, Purpose::test, 0, 0);
    int errors = 0;
    for (int i = 0; i < 400; ++i) {
        std::string bytes = whole;
        // Half of the damage in the header, where it is most likely to be believed.
        const size_t range = i % 2 ? bytes.size() : std::min<size_t>(bytes.size(), 400);
        for (int flips = 0; flips < 3; ++flips)
            bytes[rng.bits() % range] = static_cast<char>(rng.bits());
        write_bytes(folder / "x.exr", bytes);
        errors += !exr_error(folder / "x.exr").empty();
    }
    EXPECT_GT(errors, 100);
}

TEST(Exr, WritesOnlyWholeImages) {
    const TemporaryFolder folder;
    EXPECT_THROW(write_exr(Image(), folder / "x.exr"), std::invalid_argument);
    Image image(4, 4, {"R"});
    image.data[0].resize(3);
    EXPECT_THROW(write_exr(image, folder / "x.exr"), std::invalid_argument);
    EXPECT_THROW(write_exr(Image(4, 4, {"R"}), folder / "absent/x.exr"), FileError);
    EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

// IEC 61966-2-1: breakpoint, mid grey, and continuity.
TEST(Png, FollowsTheSrgbCurve) {
    EXPECT_EQ(encode_srgb(0), 0);
    EXPECT_NEAR(encode_srgb(1), 1, 1e-6);
    EXPECT_NEAR(encode_srgb(0.0031308f), 0.04045f, 1e-6);
    EXPECT_NEAR(encode_srgb(0.21404114f), 0.5f, 1e-5);
    EXPECT_NEAR(encode_srgb(0.0031307f), encode_srgb(0.0031309f), 1e-5);

    const TemporaryFolder folder;
    Image image(3, 2, {"R", "G", "B"});
    image.data[0] = {0, 0.21404114f, 1, -1, 2, std::nanf("")};
    image.data[1] = {0, 0.002f, 0.5f, 0, 0, 0};
    image.data[2] = {0, 0, 0, 0.1f, 0.2f, 0.9f};
    write_png(image, folder / "a.png");
    int width = 0, height = 0, channels = 0;
    uint8_t* bytes = stbi_load((folder / "a.png").c_str(), &width, &height, &channels, 0);
    ASSERT_NE(bytes, nullptr);
    ASSERT_EQ(width * 100 + height * 10 + channels, 323);
    const std::vector<int> expected{0, 0, 0,  128, 7, 0,   255, 188, 0,
                                    0, 0, 89, 255, 0, 124, 0,   0,   243};
    EXPECT_EQ(std::vector<int>(bytes, bytes + 18), expected);
    stbi_image_free(bytes);
    EXPECT_THROW(write_png(Image(2, 2, {"R", "G"}), folder / "b.png"), std::invalid_argument);
}
