#include "materials/table/bsdf_table.h"

#include "materials/table/export_csv.h"
#include "renderer/core/error.h"
#include "renderer/core/rng.h"
#include "renderer/core/tensor_file.h"
#include "renderer/core/text_hash.h"
#include "tests/support/refusal.h"
#include "tests/support/synthetic_tables.h"

#include <Imath/half.h>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <limits>
#include <unistd.h>

namespace rapport {
namespace {

using tests::satin_intensity;
using tests::small_synthetic_table;

class BsdfFile : public testing::Test {
  protected:
    void SetUp() override {
        folder_ = std::filesystem::temp_directory_path() /
                  ("rapport_bsdf_table_test_" + std::to_string(getpid()));
        std::filesystem::create_directories(folder_);
        path_ = folder_ / "cloth.bsdf";
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }

    std::string bytes() const {
        std::ifstream in(path_, std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }
    void set_bytes(const std::string& bytes) const {
        std::ofstream(path_, std::ios::binary | std::ios::trunc) << bytes;
    }

    /// Writes a sound file after `change` to its fields; returns the error of reading it back.
    FileError error_after(const std::function<void(TensorFile&)>& change) const {
        write_table(small_synthetic_table(satin_intensity), path_);
        TensorFile fields = read_tensor_file(path_);
        change(fields);
        write_tensor_file(fields, path_);
        try {
            read_table(path_);
        } catch (const FileError& error) {
            return error;
        }
        return {"", "", "an error", "none"};
    }
    template <class T>
    FileError error_after_setting(const std::string& name, size_t index, T value) const {
        return error_after([&](TensorFile& fields) {
            auto values = fields.at(name).values<T>();
            values.at(index) = value;
            fields[name] = TensorField::of<T>(fields.at(name).shape, values);
        });
    }

    std::filesystem::path folder_, path_;
};

std::vector<float> in_half_precision(const std::vector<float>& values) {
    const std::vector<Imath::half> halves(values.begin(), values.end());
    return {halves.begin(), halves.end()};
}

/// Of what was written and what is read.
void expect_equal(const BsdfTable& a, const BsdfTable& b) {
    EXPECT_EQ(a.bands, b.bands);
    EXPECT_EQ(a.exits, b.exits);
    ASSERT_EQ(a.directions(), b.directions());
    for (size_t d = 0; d < a.directions(); ++d) {
        EXPECT_EQ(a.incident[d].side, b.incident[d].side);
        EXPECT_EQ(a.incident[d].theta, b.incident[d].theta);
        EXPECT_EQ(a.incident[d].phi, b.incident[d].phi);
    }
    EXPECT_EQ(a.grid_theta, b.grid_theta);
    EXPECT_EQ(a.grid_phi, b.grid_phi);
    EXPECT_EQ(a.grid_index, b.grid_index);
    EXPECT_EQ(a.exit_axis, b.exit_axis);
    EXPECT_EQ(in_half_precision(a.intensity), b.intensity);
    EXPECT_EQ(a.unscattered, b.unscattered);
    EXPECT_EQ(a.absorbed, b.absorbed);
    EXPECT_EQ(a.capped, b.capped);
    EXPECT_EQ(a.lost, b.lost);
    EXPECT_EQ(a.accuracy, b.accuracy);
    EXPECT_EQ(a.bin_error, b.bin_error);
    EXPECT_EQ(a.realisation_error, b.realisation_error);
    EXPECT_EQ(a.paths, b.paths);
    EXPECT_EQ(a.metadata, b.metadata);
}

TEST(BsdfTable, FullGridSharesNormalIncidence) {
    const BsdfTable table = make_full_table(Bands{}, true, true);
    const size_t thetas = table.grid_theta.size(), phis = table.grid_phi.size();
    EXPECT_EQ(table.directions(), 2 * (1 + (thetas - 1) * phis));
    EXPECT_EQ(table.intensity.size(), table.directions() * 2 * table.exits.bins() * 3);
    EXPECT_FALSE(table.partial());
    for (size_t side = 0; side < 2; ++side)
        for (size_t t = 0; t < thetas; ++t)
            for (size_t p = 0; p < phis; ++p) {
                const IncidentDirection& d =
                    table.incident.at(table.grid_index[(side * thetas + t) * phis + p]);
                EXPECT_EQ(d.side, static_cast<Side>(side));
                EXPECT_EQ(d.theta, table.grid_theta[t]);
                EXPECT_EQ(d.phi, t == 0 ? 0 : table.grid_phi[p]);
            }
}

TEST(BsdfTable, OneSideLeavesTheOtherAbsent) {
    const BsdfTable table = make_full_table(Bands{}, false, true);
    const size_t side_size = table.grid_theta.size() * table.grid_phi.size();
    for (size_t i = 0; i < 2 * side_size; ++i)
        EXPECT_EQ(table.grid_index[i] == BsdfTable::kAbsent, i < side_size);
    EXPECT_THROW(make_full_table(Bands{}, false, false), std::invalid_argument);
}

TEST(BsdfTable, SharesAreIntegralsOfIntensity) {
    // Reflects 0.3 evenly, transmits 0.1 evenly.
    BsdfTable table = make_partial_table(Bands{}, {{Side::front, 0.3, 1}, {Side::back, 0.3, 1}});
    tests::fill_table(table, [](const IncidentDirection& from, const glm::dvec3& out, size_t) {
        const bool reflected = (out.z > 0) == (from.side == Side::front);
        return (reflected ? 0.3 : 0.1) / (2 * kPi);
    });
    EXPECT_TRUE(table.partial());
    for (size_t d = 0; d < 2; ++d) {
        EXPECT_NEAR(table.reflectance(d)[1], 0.3, 1e-6);
        EXPECT_NEAR(table.transmittance(d)[1], 0.1, 1e-6);
    }
}

TEST_F(BsdfFile, RoundTripKeepsEveryBit) {
    BsdfTable table = small_synthetic_table(satin_intensity, 0.04);
    table.metadata["quoted"] = "a \"b\"\n\\ θ";
    write_table(table, path_);
    const std::string first = bytes();
    const BsdfTable again = read_table(path_);
    expect_equal(table, again);
    write_table(again, path_);
    EXPECT_EQ(bytes(), first);
}

TEST_F(BsdfFile, PartialAndOneSidedAndSpectralTablesRoundTrip) {
    BsdfTable partial = make_partial_table(Bands::from_edges({400, 450, 500, 600, 700}),
                                           {{Side::back, 0.123456789, -0.7}});
    tests::fill_table(partial, [](const IncidentDirection&, const glm::dvec3&, size_t band) {
        return 0.01 * static_cast<double>(band);
    });
    write_table(partial, path_);
    expect_equal(partial, read_table(path_));

    BsdfTable front = make_full_table(Bands{}, true, false);
    tests::fill_table(front, satin_intensity);
    write_table(front, path_);
    expect_equal(front, read_table(path_));
}

BsdfTable with_colourways() {
    const auto dyed = [](double share) {
        return small_synthetic_table(
            [share](const auto& from, const glm::dvec3& out, size_t band) {
                return share * satin_intensity(from, out, band);
            },
            0.05);
    };
    BsdfTable table = dyed(0.8);
    const BsdfTable dark = dyed(0.1);
    table.colourways["a / black"] = dark;
    table.colourways["b"] = table;
    table.accuracy.assign(table.directions(), 0.1f);
    table.colourways["b"].accuracy.assign(table.directions(), 0.3f);
    return table;
}

TEST_F(BsdfFile, ColourwaysRoundTrip) {
    const BsdfTable table = with_colourways();
    write_table(table, path_);
    const BsdfTable read = read_table(path_);
    ASSERT_EQ(read.colourways.size(), 2u);
    for (const char* name : {"", "a / black", "b"})
        expect_equal(table.in_colourway(name, ""), read.in_colourway(name, ""));
    EXPECT_LT(read.in_colourway("a / black", "").reflectance(0)[0], table.reflectance(0)[0]);
    EXPECT_EQ(read.largest_accuracy(), 0.3f);
    EXPECT_EQ(read.in_colourway("", "").largest_accuracy(), 0.1f);
    EXPECT_TRUE(read.in_colourway("b", "").colourways.empty());
}

TEST_F(BsdfFile, UnknownColourwaysListTheKnown) {
    try {
        with_colourways().in_colourway("red", "x.bsdf");
        FAIL();
    } catch (const FileError& error) {
        EXPECT_EQ(error.path, "x.bsdf");
        EXPECT_NE(error.expected.find("a / black, b"), std::string::npos);
        EXPECT_NE(error.found.find("red"), std::string::npos);
    }
    EXPECT_THROW(small_synthetic_table(satin_intensity).in_colourway("red", ""), FileError);
}

TEST_F(BsdfFile, DamagedColourwaysAreRefused) {
    const auto error_of = [&](const std::function<void(TensorFile&)>& change) {
        return error_after([&](TensorFile& fields) {
            write_table(with_colourways(), path_);
            fields = read_tensor_file(path_);
            change(fields);
        });
    };
    EXPECT_EQ(error_of([](TensorFile& f) { f.erase("colourway_1_lost"); }).place,
              "colourway_1_lost");
    EXPECT_EQ(error_of([](TensorFile& f) { f["colourways"] = TensorField::text("{}"); }).place,
              "colourways");
    EXPECT_NE(error_of([](TensorFile& f) {
                  f["colourways"] = TensorField::text("[\"a\", \"a\"]");
              }).found.find("twice"),
              std::string::npos);
    EXPECT_EQ(error_of([](TensorFile& f) {
                  f["colourway_0_absorbed"] = f["colourway_1_absorbed"];
              }).place,
              "colourway_0_intensity[0]");
}

TEST_F(BsdfFile, HasTheAgreedArrays) {
    const BsdfTable table = small_synthetic_table(satin_intensity);
    write_table(table, path_);
    const TensorFile fields = read_tensor_file(path_);
    const uint64_t d = table.directions(), b = table.exits.bins();
    using Shape = std::vector<uint64_t>;
    EXPECT_EQ(fields.at("intensity").shape, (Shape{d, 2, b, 3}));
    EXPECT_EQ((fields.at("exit_u").shape[0] - 1) * (fields.at("exit_v").shape[0] - 1), b);
    EXPECT_EQ(fields.at("unscattered").shape, (Shape{d, 3}));
    EXPECT_EQ(fields.at("absorbed").shape, (Shape{d, 3}));
    EXPECT_EQ(fields.at("capped").shape, (Shape{d, 3}));
    EXPECT_EQ(fields.at("accuracy").shape, (Shape{d}));
    EXPECT_EQ(fields.at("paths").type, TensorField::Type::u64);
    EXPECT_EQ(fields.at("incident_side").type, TensorField::Type::u8);
    EXPECT_EQ(fields.at("incident_theta").type, TensorField::Type::f64);
    EXPECT_EQ(fields.at("incident_phi").shape, (Shape{d}));
    EXPECT_EQ(fields.at("description").text().find('\n'), std::string::npos);
}

TEST_F(BsdfFile, IntensityTooLargeForHalfPrecisionIsKeptInSingle) {
    BsdfTable table = small_synthetic_table(satin_intensity);
    table.exits = DirectionMesh(512, 256); // of bins so small that one of them can shine so bright
    table.intensity.assign(table.directions() * 2 * table.exits.bins() * 3, 0);
    for (size_t d = 0; d < table.directions(); ++d)
        for (size_t band = 0; band < 3; ++band) {
            const size_t bin = table.exits.bins() / 2;
            table.at(d, 0, bin, band) =
                static_cast<float>(0.75 / table.exits_of(d).solid_angle(bin));
            table.unscattered[d * 3 + band] = 0.25;
            table.absorbed[d * 3 + band] = 0;
        }
    EXPECT_GT(std::ranges::max(table.intensity), 65504);
    write_table(table, path_);
    EXPECT_EQ(read_tensor_file(path_).at("intensity").type, TensorField::Type::f32);
    EXPECT_EQ(read_table(path_).intensity, table.intensity);
}

TEST_F(BsdfFile, IgnoresFieldsOfOthers) {
    const FileError error = error_after(
        [](TensorFile& fields) { fields["ndf"] = TensorField::of<float>({1}, {1.0f}); });
    EXPECT_EQ(error.found, "none");
}

TEST_F(BsdfFile, OtherFormatsAreToBeMeasuredAgain) {
    const FileError older = error_after([](TensorFile& fields) {
        fields.erase("format");
        fields.erase("solid_angle");
    });
    EXPECT_EQ(older.place, "format");
    EXPECT_EQ(older.found, "no such field: measured by an older Rapport; measure it again");
    EXPECT_EQ(error_after_setting<uint32_t>("format", 0, 0).found,
              "0: measured by an older Rapport; measure it again");
    EXPECT_EQ(error_after_setting<uint32_t>("format", 0, 1000).found,
              "1000: measured by a newer Rapport; measure it again");
}

TEST_F(BsdfFile, SolidAnglesTurnIntensityIntoFlux) {
    // As a reader would have it that knows nothing of the chart.
    const BsdfTable table = small_synthetic_table(satin_intensity);
    write_table(table, path_);
    const TensorFile fields = read_tensor_file(path_);
    const auto angles = fields.at("solid_angle").values<float>();
    const auto intensity = fields.at("intensity").values<Imath::half>();
    const size_t bins = table.exits.bins(), columns = fields.at("solid_angle").shape[1];
    for (size_t d = 0; d < table.directions(); ++d) {
        double flux = 0;
        for (size_t bin = 0; bin < bins; ++bin)
            flux +=
                intensity[(d * 2 * bins + bin) * 3] * angles[d * columns + bin / (bins / columns)];
        EXPECT_NEAR(flux, table.reflectance(d)[0], 1e-4);
    }
}

TEST_F(BsdfFile, TheNormalAloneIsOneNode) {
    // Of two directions, 100,000 nodes.
    const FileError error = error_after([](TensorFile& fields) {
        constexpr size_t kPhis = 100000;
        std::vector<double> phi(kPhis);
        std::vector<uint32_t> index(2 * kPhis);
        const auto front = fields.at("grid_index").values<uint32_t>();
        for (size_t i = 0; i < kPhis; ++i) {
            phi[i] = 2 * kPi * static_cast<double>(i) / kPhis;
            index[i] = front.front();
            index[kPhis + i] = front[front.size() / 2];
        }
        fields["grid_theta"] = TensorField::of<double>({1}, {0});
        fields["grid_phi"] = TensorField::of<double>({kPhis}, phi);
        fields["grid_index"] = TensorField::of<uint32_t>({2, 1, kPhis}, index);
    });
    EXPECT_EQ(error.place, "grid_phi");
    EXPECT_EQ(error.found, "100000");
}

TEST_F(BsdfFile, NamesTheMissingField) {
    write_table(small_synthetic_table(satin_intensity), path_);
    for (const auto& [name, field] : read_tensor_file(path_)) {
        const FileError error =
            error_after([&name = name](TensorFile& fields) { fields.erase(name); });
        EXPECT_EQ(error.place, name);
        EXPECT_TRUE(error.found.starts_with("no such field")) << name;
    }
}

TEST_F(BsdfFile, NamesTheFieldOfWrongTypeOrShape) {
    write_table(small_synthetic_table(satin_intensity), path_);
    for (const auto& [name, field] : read_tensor_file(path_)) {
        EXPECT_EQ(error_after([&name = name](TensorFile& fields) {
                      fields[name] = TensorField::of<int32_t>({2, 1}, {1, 2});
                  }).place,
                  name);
    }
}

TEST_F(BsdfFile, NamesTheBadValue) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(error_after_setting<Imath::half>("intensity", 7, Imath::half(nan)).place,
              "intensity[7]");
    EXPECT_EQ(error_after_setting<Imath::half>("intensity", 7, Imath::half(-0.1f)).place,
              "intensity[7]");
    EXPECT_EQ(error_after_setting<float>("absorbed", 3, 0.9f).place, "intensity[1]"); // sum ≠ 1
    EXPECT_EQ(error_after_setting<float>("accuracy", 0, nan).place, "accuracy[0]");
    EXPECT_EQ(error_after_setting<double>("exit_u", 2, 0.2).place, "exit_u[2]");
    EXPECT_EQ(error_after_setting<double>("exit_v", 0, nan).place, "exit_v[0]");
    EXPECT_EQ(error_after_setting<uint8_t>("exit_axis", 1, 2).place, "exit_axis[1]");
    for (const auto& [name, edges] :
         {std::pair("exit_v", 1u), {"exit_v", 1001u}, {"exit_u", 2u}, {"exit_u", 1001u}})
        EXPECT_EQ(error_after([&, name = name, edges = edges](TensorFile& fields) {
                      fields[name] = TensorField::of<double>({edges}, std::vector<double>(edges));
                  }).place,
                  name);
    EXPECT_EQ(error_after_setting<double>("incident_theta", 1, 1.6).place, "incident_theta[1]");
    EXPECT_EQ(error_after_setting<double>("incident_phi", 1, HUGE_VAL).place, "incident_phi[1]");
    EXPECT_EQ(error_after_setting<uint8_t>("incident_side", 1, 2).place, "incident_side[1]");
    EXPECT_EQ(error_after_setting<double>("grid_theta", 2, 0.5).place, "grid_theta[2]");
    EXPECT_EQ(error_after_setting<double>("grid_phi", 0, 0.5).place, "grid_phi[0]");
    EXPECT_EQ(error_after_setting<uint32_t>("grid_index", 5, 999).place, "grid_index[5]");
    EXPECT_EQ(error_after_setting<uint32_t>("grid_index", 5, 3).place, "grid_index[5]");
    EXPECT_EQ(error_after_setting<uint32_t>("grid_index", 5, BsdfTable::kAbsent).place,
              "grid_index[5]");
    for (const char* bad : {"[]", "{}", "[1, 2, 3]", "[\"R\", \"G\"]", "[\"R\""})
        EXPECT_EQ(error_after([&](TensorFile& fields) {
                      fields["band_names"] = TensorField::text(bad);
                  }).place,
                  "band_names");
    for (const char* name : {"unscattered", "absorbed", "capped", "lost", "accuracy", "bin_error"})
        for (const float bad : {nan, -1e-6f, HUGE_VALF})
            EXPECT_EQ(error_after_setting<float>(name, 2, bad).place, std::string(name) + "[2]");
    EXPECT_EQ(error_after([&](TensorFile& fields) {
                  fields["realisation_error"] = fields.at("accuracy");
                  fields["realisation_error"].shape = {1, fields.at("accuracy").count()};
              }).place,
              "realisation_error");
    const auto with_hash = [](const std::string& hash) {
        return [hash](TensorFile& fields) {
            fields["metadata"] =
                TensorField::text(R"({"cloth": "satin", "cloth_hash": ")" + hash + "\"}");
        };
    };
    EXPECT_EQ(error_after(with_hash("fnv1a64:0123456789abcdef")).place, "metadata.cloth_hash");
    EXPECT_EQ(error_after(with_hash(text_hash("satin"))).place, "checksum");
    EXPECT_EQ(error_after_setting<float>("solid_angle", 3, 0.1f).place, "solid_angle[3]");
    EXPECT_EQ(error_after_setting<float>("solid_angle", 0, nan).place, "solid_angle[0]");
    EXPECT_EQ(error_after([](TensorFile& fields) {
                  fields["band_edges_nm"] = TensorField::of<double>({4}, {400, 500, 450, 700});
              }).place,
              "band_edges_nm[2]");
    EXPECT_EQ(error_after([](TensorFile& fields) {
                  fields["metadata"] = TensorField::text("{\"seed\": 1}");
              }).place,
              "metadata.seed");
}

TEST_F(BsdfFile, MutatedFilesAreRefusedOrSound) {
    const BsdfTable written = small_synthetic_table(satin_intensity);
    write_table(written, path_);
    const std::string sound = bytes();
    CounterRng rng(1, Purpose::test, 0, 0);
    // Half of the places in the head, where the sizes and offsets are.
    int refused = 0;
    for (int i = 0; i < 400; ++i) {
        std::string damaged = sound;
        const size_t range = i % 2 ? sound.size() : std::min<size_t>(sound.size(), 1024);
        const size_t place = rng.bits() % range;
        if (i % 10 == 0)
            damaged.resize(place);
        else if (i % 10 == 1)
            damaged[place] = static_cast<char>(0xff);
        else
            damaged[place] = static_cast<char>(damaged[place] ^ (1 << rng.bits() % 8));
        set_bytes(damaged);
        try {
            const BsdfTable table = read_table(path_);
            expect_equal(written, table); // changed between the fields, where nothing is
        } catch (const FileError& error) {
            ++refused;
            EXPECT_FALSE(error.expected.empty());
        }
    }
    EXPECT_GT(refused, 100);
}

TEST_F(BsdfFile, ATableThatCouldNotBeReadIsNotWritten) {
    const BsdfTable sound = with_colourways();
    write_table(sound, path_);
    const std::string before = bytes();
    const auto place_of = [&](const std::function<void(BsdfTable&)>& change) {
        BsdfTable table = sound;
        change(table);
        const FileError error = tests::refusal_of([&] { write_table(table, path_); });
        EXPECT_EQ(error.path, path_.string());
        return error.place;
    };
    EXPECT_EQ(place_of([](BsdfTable& t) { t.intensity[7] = std::nanf(""); }), "intensity[7]");
    EXPECT_EQ(place_of([](BsdfTable& t) { t.absorbed[3] = -0.1f; }), "absorbed[3]");
    EXPECT_EQ(place_of([](BsdfTable& t) { t.absorbed[3] += 0.1f; }), "intensity[1]");
    EXPECT_EQ(place_of([](BsdfTable& t) { t.incident[2].theta = 2; }), "incident_theta[2]");
    EXPECT_EQ(place_of([](BsdfTable& t) { std::swap(t.grid_theta[0], t.grid_theta[1]); }),
              "grid_theta[1]");
    EXPECT_EQ(place_of([](BsdfTable& t) {
                  t.metadata = {{"cloth", "x"}, {"cloth_hash", "y"}};
              }),
              "metadata.cloth_hash");
    EXPECT_EQ(place_of([](BsdfTable& t) { t.colourways["b"].capped[0] = HUGE_VALF; }),
              "colourway_1_capped[0]");
    EXPECT_EQ(bytes(), before);
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_), {}), 1);
}

TEST_F(BsdfFile, MissingFileIsAFileError) {
    EXPECT_THROW(read_table(folder_ / "absent.bsdf"), FileError);
}

TEST_F(BsdfFile, CsvHasOneLinePerBinAndBand) {
    BsdfTable table = make_partial_table(
        Bands{}, {{Side::front, radians(30.0), radians(45.0)}, {Side::back, 0, 0}});
    tests::fill_table(table, satin_intensity);
    const std::filesystem::path csv = folder_ / "cloth.csv";
    export_csv(table, csv);
    std::ifstream in(csv);
    std::string line;
    std::getline(in, line);
    EXPECT_EQ(line, "side,theta_i,phi_i,theta_o,phi_o,solid_angle,band,intensity");
    std::map<std::string, std::array<double, 2>> flux; // by side: reflected, transmitted in R
    size_t lines = 0;
    while (std::getline(in, line)) {
        std::vector<std::string> cells;
        std::stringstream cut(line);
        for (std::string cell; std::getline(cut, cell, ',');)
            cells.push_back(cell);
        ASSERT_EQ(cells.size(), 8u);
        ++lines;
        if (cells[6] == "R")
            flux[cells[0]][std::stod(cells[3]) > 90] += std::stod(cells[5]) * std::stod(cells[7]);
        EXPECT_EQ(cells[1], cells[0] == "front" ? "30" : "0");
        EXPECT_EQ(cells[2], cells[0] == "front" ? "45" : "0");
    }
    EXPECT_EQ(lines, table.intensity.size());
    const std::array<std::string, 2> sides = {"front", "back"};
    for (size_t d = 0; d < 2; ++d) {
        EXPECT_NEAR(flux[sides[d]][0], table.reflectance(d)[0], 1e-5);
        EXPECT_NEAR(flux[sides[d]][1], table.transmittance(d)[0], 1e-5);
    }
    EXPECT_THROW(export_csv(table, folder_ / "no such folder" / "cloth.csv"), FileError);
}

} // namespace
} // namespace rapport
