#include "materials/table/export_radiance.h"

#include "materials/table/table_bsdf.h"
#include "materials/table/tensor_tree.h"
#include "renderer/core/error.h"
#include "tests/support/file_bytes.h"
#include "tests/support/radiance_file.h"
#include "tests/support/synthetic_tables.h"
#include "tests/support/temporary_folder.h"

#include <atomic>
#include <cstdlib>
#include <fmt/format.h>
#include <gtest/gtest.h>

namespace rapport {
namespace {

using tests::RadianceTree;

constexpr double kUnscattered = 0.07;

struct Exported {
    BsdfTable table = tests::synthetic_table(tests::slanted_intensity, kUnscattered);
    TableBsdf bsdf{table, ""};
    RadianceLosses losses;
    std::atomic<double> progress = 0; ///< the last that was told
    std::string text;
    tests::RadianceBlocks blocks;

    Exported() {
        const tests::TemporaryFolder folder;
        losses = export_radiance(table, "<slanted> & co", folder / "a.xml",
                                 [&](double fraction) { progress = fraction; });
        text = tests::read_bytes(folder / "a.xml");
        blocks = tests::read_radiance(text);
    }
};
const Exported& exported() {
    static const Exported made;
    return made;
}

/// A point of the unit disk on the square, by Shirley & Chiu's inverse map.
std::array<double, 2> disk_to_square(double x, double y) {
    const double r = std::hypot(x, y);
    double phi = std::atan2(y, x), a = 0, b = 0;
    if (phi < -kPi / 4)
        phi += 2 * kPi;
    if (phi < kPi / 4) {
        a = r;
        b = phi * a / (kPi / 4);
    } else if (phi < 3 * kPi / 4) {
        b = r;
        a = -(phi - kPi / 2) * b / (kPi / 4);
    } else if (phi < 5 * kPi / 4) {
        a = -r;
        b = (phi - kPi) * a / (kPi / 4);
    } else {
        b = -r;
        a = -(phi - 3 * kPi / 2) * b / (kPi / 4);
    }
    return {std::min((a + 1) / 2, 0.999999), std::min((b + 1) / 2, 0.999999)};
}

/// As Radiance looks it up, for unit vectors that both point away from the surface.
std::array<double, 4> place(const glm::vec3& in, const glm::vec3& out) {
    const auto i = disk_to_square(-in.x, -in.y), o = disk_to_square(out.x, out.y);
    return {i[0], i[1], o[0], o[1]};
}

const char* block_of(const glm::vec3& in, const glm::vec3& out) {
    return in.z > 0 ? (out.z > 0 ? "Reflection Back" : "Transmission Back")
                    : (out.z > 0 ? "Transmission Front" : "Reflection Front");
}
const RadianceTree& tree(const std::string& wavelength, const glm::vec3& in, const glm::vec3& out) {
    return exported().blocks.at(wavelength + ' ' + block_of(in, out));
}

std::vector<glm::vec3> directions(int count, double lowest_cosine) {
    std::vector<glm::vec3> all;
    for (int i = 0; i < count; ++i) {
        double cosine = 2 * (i + 0.5) / count - 1;
        if (std::abs(cosine) > lowest_cosine)
            all.emplace_back(spherical_direction(std::acos(cosine), 2.4 * i));
    }
    return all;
}

TEST(ExportRadiance, HasTheAgreedLayout) {
    const std::string& text = exported().text;
    EXPECT_EQ(text.rfind("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<WindowElement ", 0), 0u);
    EXPECT_NE(text.find("<Name>&lt;slanted&gt; &amp; co</Name>"), std::string::npos);
    EXPECT_NE(text.find("<Wavelength unit=\"Integral\">Visible</Wavelength>"), std::string::npos);
    EXPECT_EQ(exported().blocks.size(), 12u); // 4 blocks of Y, u′ and v′

    // Every element is closed in its turn.
    std::vector<std::string> open;
    for (size_t at = text.find('<'); at != std::string::npos; at = text.find('<', at + 1)) {
        const size_t end = text.find_first_of(" >", at);
        const std::string tag = text.substr(at + 1, end - at - 1);
        if (tag[0] == '?')
            continue;
        if (tag[0] != '/') {
            open.push_back(tag);
            continue;
        }
        ASSERT_FALSE(open.empty());
        EXPECT_EQ(tag.substr(1), open.back());
        open.pop_back();
    }
    EXPECT_TRUE(open.empty());
}

/// RMS difference between the file's Y and the table's f over the mean of that, all blocks; of the
/// cloth mirrored in x if wanted.
double difference(bool mirrored) {
    const glm::vec3 mirror(mirrored ? -1 : 1, 1, 1);
    double squares = 0, sum = 0;
    int count = 0;
    for (const glm::vec3& in : directions(60, 0.15))
        for (const glm::vec3& out : directions(300, 0.15)) {
            if (glm::distance(out, -in) < 0.2f)
                continue; // where the unscattered beam is
            const double expected =
                luminance(exported().bsdf.eval(mirror * in, mirror * out)) / std::abs(out.z);
            squares += square(tree("Visible", in, out).at(place(in, out)) - expected);
            sum += expected;
            ++count;
        }
    return std::sqrt(squares * count) / sum;
}

TEST(ExportRadiance, TellsWhenAllIsDone) { EXPECT_EQ(exported().progress, 1); }

TEST(ExportRadiance, IsTheBsdfInAllFourBlocks) {
    EXPECT_LT(difference(false), 0.1); // cells are 5° wide, and merged within 5 %
    EXPECT_GT(difference(true), 0.25);
}

TEST(ExportRadiance, KeepsReflectanceAndTransmittance) {
    EXPECT_LT(exported().losses.largest_flux_error, 0.01);
    const BsdfTable& table = exported().table;
    constexpr int kSide = 32;
    for (size_t d = 0; d < table.directions(); d += 11) {
        const IncidentDirection& from = table.incident[d];
        if (from.theta > radians(85.0))
            continue; // in the cells at the edge of the disk θ runs over 20°
        const double side = from.side == Side::front ? 1 : -1;
        glm::vec3 in(spherical_direction(from.theta, from.phi));
        in.z *= static_cast<float>(side);
        const auto y = [](const std::vector<double>& rgb) {
            return relative_xyz(Rgb(rgb[0], rgb[1], rgb[2])).y;
        };
        for (const double z : {1.0, -1.0}) {
            const glm::vec3 out(0, 0, static_cast<float>(z));
            double sum = 0;
            for (int i = 0; i < kSide * kSide; ++i) {
                std::array<double, 4> at = place(in, out);
                at[2] = (i / kSide + 0.5) / kSide;
                at[3] = (i % kSide + 0.5) / kSide;
                sum += tree("Visible", in, out).at(at) * kPi / (kSide * kSide);
            }
            const double expected =
                z == side ? y(table.reflectance(d)) : y(table.transmittance(d)) + kUnscattered;
            // The cell of incidence is 5° wide too.
            EXPECT_NEAR(sum, expected, 0.02 * expected + 0.002) << from.theta << ' ' << z;
        }
    }
}

TEST(ExportRadiance, ColoursAreChromaticitiesAgainstWhite) {
    const glm::vec3 in(spherical_direction(0.6, 0.3)), out(spherical_direction(0.5, 1.9));
    const double u = tree("CIE-u", in, out).at(place(in, out));
    const double v = tree("CIE-v", in, out).at(place(in, out));
    const glm::vec3 xyz = relative_xyz(exported().bsdf.eval(in, out));
    const double sum = xyz.x + 15 * xyz.y + 3 * xyz.z;
    EXPECT_NEAR(u, 4 * xyz.x / sum, 0.006);
    EXPECT_NEAR(v, 9 * xyz.y / sum, 0.006);
    const glm::vec3 white = relative_xyz(Rgb(1));
    EXPECT_NEAR(glm::distance(white, glm::vec3(1)), 0, 1e-5);
}

TEST(TensorTree, KeepsEveryValueThatIsNotMerged) {
    std::vector<float> values(4 * 4 * 4 * 4);
    for (size_t i = 0; i < values.size(); ++i)
        values[i] = i < 128 ? 1 : static_cast<float>(i); // constant where the first place is < 1/2
    size_t numbers = 0;
    const std::vector<float> before = values;
    const RadianceTree tree = RadianceTree::parse(tensor_tree(values, 2, 0, 0, numbers));
    EXPECT_EQ(numbers, 8u + 128u);
    EXPECT_EQ(values, before);
    for (size_t i = 0; i < values.size(); ++i) {
        std::array<double, 4> at{};
        for (size_t d = 0; d < 4; ++d)
            at[d] = (double(i >> 2 * (3 - d) & 3) + 0.5) / 4;
        EXPECT_EQ(tree.at(at), before[i]) << i;
    }
    tensor_tree(values, 2, 1000, 0, numbers);
    EXPECT_EQ(numbers, 1u);
    EXPECT_NEAR(values[0], values.back(), 1e-3);
}

TEST(ExportRadiance, RefusesAPartialTable) {
    const tests::TemporaryFolder folder;
    EXPECT_THROW(export_radiance(make_partial_table(Bands{}, {{}}), "x", folder / "x.xml"),
                 FileError);
    EXPECT_FALSE(std::filesystem::exists(folder / "x.xml"));
}

} // namespace
} // namespace rapport
