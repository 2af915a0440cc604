#include "renderer/core/tensor_file.h"

#include "renderer/core/error.h"
#include "renderer/core/rng.h"
#include "tests/support/file_bytes.h"
#include "tests/support/temporary_folder.h"

#include <cstring>
#include <gtest/gtest.h>
#include <limits>

using namespace rapport;
using namespace rapport::tests;

namespace {

TensorFile example() {
    TensorFile fields;
    fields["f32"] = TensorField::of<float>({2, 3}, {0, -1.5f, 1e-40f, 1e38f, 0.1f, -0.0f});
    fields["f64"] = TensorField::of<double>({1, 1, 2}, {1e-310, 0.1});
    fields["u64"] = TensorField::of<uint64_t>({1}, {std::numeric_limits<uint64_t>::max()});
    fields["i8"] = TensorField::of<int8_t>({3}, {-128, 0, 127});
    fields["empty"] = TensorField::of<float>({0, 7}, {});
    fields["scalar"] = TensorField::of<int32_t>({}, {-7});
    fields["description"] = TensorField::text("warp and weft: Ω");
    return fields;
}

template <class T> std::string raw(T value) {
    std::string bytes(sizeof value, '\0');
    std::memcpy(bytes.data(), &value, sizeof value);
    return bytes;
}

/// A file written by hand, field by field, so that each part can be damaged.
struct HandMade {
    std::string magic{"tensor_file\0\1\0", 14};
    uint32_t count = 2;
    std::string name[2]{"a", "b"};
    uint8_t type[2]{10, 1};
    uint64_t offset[2]{80, 88};
    uint64_t extent[2]{2, 5};

    std::string bytes() const {
        std::string bytes = magic + raw(count);
        for (int i = 0; i < 2; ++i)
            bytes += raw(static_cast<uint16_t>(name[i].size())) + name[i] + raw(uint16_t{1}) +
                     raw(type[i]) + raw(offset[i]) + raw(extent[i]);
        bytes.resize(80);
        return bytes + raw(1.5f) + raw(2.5f) + "hello";
    }
};

std::string error_of(const std::string& bytes) {
    static const TemporaryFolder folder;
    write_bytes(folder / "x.bsdf", bytes);
    try {
        read_tensor_file(folder / "x.bsdf");
    } catch (const FileError& error) {
        EXPECT_NE(std::string(error.what()).find("x.bsdf"), std::string::npos);
        return error.what();
    }
    return "";
}

} // namespace

TEST(TensorFile, RoundTripIsExact) {
    const TemporaryFolder folder;
    const TensorFile fields = example();
    write_tensor_file(fields, folder / "a.bsdf");
    const TensorFile again = read_tensor_file(folder / "a.bsdf");
    ASSERT_EQ(again.size(), fields.size());
    for (const auto& [name, field] : fields) {
        EXPECT_EQ(again.at(name).type, field.type) << name;
        EXPECT_EQ(again.at(name).shape, field.shape) << name;
        EXPECT_EQ(again.at(name).bytes, field.bytes) << name;
    }
    EXPECT_EQ(again.at("description").text(), "warp and weft: Ω");
    EXPECT_EQ(again.at("i8").values<int8_t>(), (std::vector<int8_t>{-128, 0, 127}));
    EXPECT_THROW(again.at("i8").values<float>(), std::invalid_argument);
    EXPECT_THROW(TensorField::of<float>({2}, {1.0f}), std::invalid_argument);

    write_tensor_file(again, folder / "b.bsdf");
    EXPECT_EQ(read_bytes(folder / "a.bsdf"), read_bytes(folder / "b.bsdf"));
}

// The layout is that of other programs: every byte of a small file, written down here.
TEST(TensorFile, LayoutIsThePublishedOne) {
    const TemporaryFolder folder;
    TensorFile fields;
    fields["a"] = TensorField::of<float>({2}, {1.5f, 2.5f});
    fields["b"] = TensorField::text("hello");
    write_tensor_file(fields, folder / "a.bsdf");
    HandMade expected;
    expected.offset[0] = 64; // 18 + 2 · 22 bytes of header, aligned to 8
    expected.offset[1] = 72;
    std::string bytes = expected.bytes();
    bytes.erase(64, 16);
    EXPECT_EQ(read_bytes(folder / "a.bsdf"), bytes);
}

TEST(TensorFile, ReadsDataInAnyOrderAndUnaligned) {
    const TemporaryFolder folder;
    HandMade file;
    file.offset[0] = 85; // floats inside what follows, off the grid
    file.offset[1] = 80;
    write_bytes(folder / "x", file.bytes());
    const TensorFile fields = read_tensor_file(folder / "x");
    EXPECT_EQ(fields.at("a").values<float>().size(), 2u);
    EXPECT_EQ(fields.at("b").bytes.size(), 5u);
}

TEST(TensorFile, EveryTruncationIsAnError) {
    const TemporaryFolder folder;
    TensorFile fields = example();
    fields["z"] = TensorField::of<float>({40}, std::vector<float>(40, 1.0f));
    write_tensor_file(fields, folder / "whole");
    const std::string whole = read_bytes(folder / "whole");
    ASSERT_GT(whole.size(), 200u);
    for (size_t length = 0; length < whole.size(); ++length)
        EXPECT_NE(error_of(whole.substr(0, length)), "") << length;
    EXPECT_EQ(error_of(whole), "");
}

TEST(TensorFile, TellsWhatIsDamaged) {
    EXPECT_EQ(error_of(HandMade{}.bytes()), "");
    const auto damaged = [](auto&& damage) {
        HandMade file;
        damage(file);
        return error_of(file.bytes());
    };
    using F = HandMade&;
    EXPECT_NE(damaged([](F f) { f.magic[0] = 'T'; }).find("a tensor file"), std::string::npos);
    EXPECT_NE(damaged([](F f) { f.magic[12] = 2; }).find("found 2.0"), std::string::npos);
    EXPECT_NE(damaged([](F f) { f.type[0] = 0; }).find("found 0"), std::string::npos);
    EXPECT_NE(damaged([](F f) { f.type[0] = 12; }).find("found 12"), std::string::npos);
    EXPECT_NE(damaged([](F f) { f.name[1] = "a"; }).find("\"a\" twice"), std::string::npos);
    EXPECT_NE(damaged([](F f) { f.offset[1] = 87; }).find("overlap"), std::string::npos);
    EXPECT_NE(damaged([](F f) { f.offset[0] = 10; }).find("overlap"), std::string::npos);
    EXPECT_NE(damaged([](F f) { f.count = 3; }), "");
    EXPECT_NE(damaged([](F f) { f.count = 0xFFFFFFFF; }), "");
    for (const uint64_t huge : {uint64_t{6}, uint64_t{1} << 32, uint64_t{1} << 62,
                                (uint64_t{1} << 62) + 1, ~uint64_t{0}}) {
        EXPECT_NE(damaged([&](F f) { f.extent[1] = huge; }).find("within"), std::string::npos);
        EXPECT_NE(damaged([&](F f) { f.offset[1] = huge + 90; }), "");
        EXPECT_NE(damaged([&](F f) { f.extent[0] = huge; }), "");
    }
}

// Whatever the bytes, reading ends in a value or a FileError.
TEST(TensorFile, FlippedBytesNeverCrash) {
    const TemporaryFolder folder;
    write_tensor_file(example(), folder / "whole");
    const std::string whole = read_bytes(folder / "whole");
    CounterRng rng(1, Purpose::test, 0, 0);
    int errors = 0;
    for (int i = 0; i < 2000; ++i) {
        std::string bytes = whole;
        for (int flips = 0; flips < 3; ++flips)
            bytes[rng.bits() % bytes.size()] = static_cast<char>(rng.bits());
        errors += !error_of(bytes).empty();
    }
    EXPECT_GT(errors, 500);
}

TEST(TensorFile, PlacesThatCannotBeReadOrWritten) {
    const TemporaryFolder folder;
    EXPECT_THROW(read_tensor_file(folder / "none"), FileError);
    EXPECT_THROW(read_tensor_file(folder.path()), FileError);
    EXPECT_THROW(read_tensor_file("/dev/zero"), FileError);
    EXPECT_THROW(write_tensor_file(example(), folder / "no/such/folder"), FileError);
    EXPECT_THROW(write_tensor_file(example(), folder.path()), FileError);
    TensorFile wrong = example();
    wrong["f32"].shape = {7};
    EXPECT_THROW(write_tensor_file(wrong, folder / "x"), std::invalid_argument);
    EXPECT_FALSE(std::filesystem::exists(folder / "x"));
}
