#include "materials/table/export_radiance.h"

#include "materials/table/table_bsdf.h"
#include "materials/table/tensor_tree.h"
#include "renderer/core/atomic_file.h"
#include "renderer/core/parallel.h"
#include "renderer/core/warp.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>

namespace rapport {
namespace {

constexpr int kLevels = 5;
constexpr size_t kSide = size_t{1} << kLevels, kCells = kSide * kSide;
constexpr size_t kSamples =
    2; ///< along both axes of a cell, of the directions that light leaves to
/// Projected solid angle of a cell [sr].
constexpr float kCellSize = static_cast<float>(kPi) / kCells;

// Cubes of cells that differ by less are merged: of their mean, and of f of a white diffuser.
constexpr float kTolerance = 0.05f, kAbsolute = 0.002f / static_cast<float>(kPi);
constexpr float kColourTolerance = 0.005f; ///< of u′ and v′

constexpr size_t kTreeSteps = 200; ///< about as many directions are filled while a tree is written

/// What WINDOW and Radiance call the four blocks; their back is our face.
struct Block {
    float in, out; ///< sign of z
    const char *direction, *type;
};
constexpr Block kBlocks[] = {{1, 1, "Reflection Back", "BRDF"},
                             {1, -1, "Transmission Back", "BTDF"},
                             {-1, 1, "Transmission Front", "BTDF"},
                             {-1, -1, "Reflection Front", "BRDF"}};

/// The unit vector over a place on the square; Radiance counts incidence from the way light goes,
/// so that it is turned by π there.
glm::vec3 direction(const glm::vec2& place, float sign_of_xy, float sign_of_z) {
    const glm::vec2 disk = sign_of_xy * square_to_disk(place);
    return {disk.x, disk.y, sign_of_z * std::max(safe_sqrt(1 - glm::dot(disk, disk)), 1e-4f)};
}
glm::vec2 centre(size_t cell) {
    return (glm::vec2(cell / kSide, cell % kSide) + 0.5f) / static_cast<float>(kSide);
}

/// CIE Y of the two blocks of a side, [block][incident cell][exit cell], with their colours.
struct SideValues {
    std::array<std::vector<float>, 2> y, u, v;
};

class Exporter {
  public:
    Exporter(const BsdfTable& table, const std::string& name, const ProgressSignal& progress)
        : table_(table, name), name_(name),
          steps_(2 * kCells + 3 * std::size(kBlocks) * kTreeSteps, progress) {}

    RadianceLosses write(std::ofstream& out) {
        out << fmt::format(
            "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
            "<WindowElement xmlns=\"http://windows.lbl.gov\" "
            "xmlns:xsi=\"http://www.w3.org/2001/XMLSchema-instance\" "
            "xsi:schemaLocation=\"http://windows.lbl.gov/BSDF-v1.4.xsd\">\n"
            "<WindowElementType>System</WindowElementType>\n<FileType>BSDF</FileType>\n"
            "<Optical>\n<Layer>\n"
            "\t<Material>\n\t\t<Name>{}</Name>\n\t\t<Manufacturer>Rapport {}</Manufacturer>\n"
            "\t\t<DeviceType>Other</DeviceType>\n\t</Material>\n"
            "\t<DataDefinition>\n"
            "\t\t<IncidentDataStructure>TensorTree4</IncidentDataStructure>\n"
            "\t</DataDefinition>\n",
            escaped(name_), RAPPORT_VERSION);
        for (const float in : {1.0f, -1.0f})
            write_side(out, in);
        out << "</Layer>\n</Optical>\n</WindowElement>\n";
        return losses_;
    }

  private:
    static std::string escaped(const std::string& text) {
        std::string result;
        for (const char c : text)
            result += c == '&'   ? "&amp;"
                      : c == '<' ? "&lt;"
                      : c == '>' ? "&gt;"
                                 : std::string(1, c);
        return result;
    }

    void write_side(std::ofstream& out, float in) {
        SideValues values;
        for (auto* of : {&values.y, &values.u, &values.v})
            for (std::vector<float>& block : *of)
                block.resize(kCells * kCells);
        std::vector<float> flux(kCells);
        parallel_for(kCells, [&](size_t i) {
            flux[i] = fill_incidence(i, in, values);
            steps_.add();
        });

        size_t block_number = 0;
        for (const Block& block : kBlocks) {
            if (block.in != in)
                continue;
            write_tree(out, block, "Visible", values.y[block_number], kTolerance, kAbsolute);
            write_tree(out, block, "CIE-u", values.u[block_number], 0, kColourTolerance);
            write_tree(out, block, "CIE-v", values.v[block_number], 0, kColourTolerance);
            ++block_number;
        }
        for (size_t i = 0; i < kCells; ++i) {
            double sum = 0;
            for (const std::vector<float>& block : values.y)
                for (size_t o = 0; o < kCells; ++o)
                    sum += block[i * kCells + o] * kCellSize;
            losses_.largest_flux_error =
                std::max(losses_.largest_flux_error, std::abs(sum - flux[i]));
        }
    }

    /// Fills the cells of one direction of incidence; returns all that leaves for it, in CIE Y.
    float fill_incidence(size_t i, float in, SideValues& values) const {
        const glm::vec3 eye = direction(centre(i), -1, in);
        const Rgb unscattered = table_.unscattered(eye);
        std::array<std::vector<glm::vec3>, 2> xyz;
        float sum = 0;
        size_t block_number = 0;
        for (const Block& block : kBlocks) {
            if (block.in != in)
                continue;
            std::vector<glm::vec3>& cells = xyz[block_number++];
            for (size_t o = 0; o < kCells; ++o) {
                cells.push_back(relative_xyz(mean_over_cell(eye, o, block.out)));
                sum += cells.back().y * kCellSize;
            }
        }
        const float scattered = relative_xyz(table_.albedo(eye)).y;
        const float scale = sum > 0 ? scattered / sum : 1;
        const size_t through = in > 0 ? 1 : 0; // of the side's two blocks, that of transmission
        for (size_t b = 0; b < 2; ++b)
            for (size_t o = 0; o < kCells; ++o) {
                glm::vec3 colour = scale * xyz[b][o];
                if (b == through && o == i) // straight on: the same place on the square
                    colour += relative_xyz(unscattered) / kCellSize;
                set(values, b, i * kCells + o, colour);
            }
        return scattered + relative_xyz(unscattered).y;
    }

    /// f over an exit cell: the mean of I/cosθ by projected solid angle.
    Rgb mean_over_cell(const glm::vec3& eye, size_t cell, float sign_of_z) const {
        Rgb sum(0);
        for (size_t k = 0; k < kSamples * kSamples; ++k) {
            const glm::vec2 within =
                (glm::vec2(k / kSamples, k % kSamples) + 0.5f) / static_cast<float>(kSamples) -
                0.5f;
            const glm::vec3 light =
                direction(centre(cell) + within / static_cast<float>(kSide), 1, sign_of_z);
            sum += table_.eval(eye, light) / std::abs(light.z);
        }
        return sum / static_cast<float>(kSamples * kSamples);
    }

    static void set(SideValues& values, size_t block, size_t i, const glm::vec3& xyz) {
        const glm::vec3 colour = xyz.y > 0 ? xyz : glm::vec3(1);
        const float sum = colour.x + 15 * colour.y + 3 * colour.z; // CIE 1976
        values.y[block][i] = std::max(xyz.y, 0.0f);
        values.u[block][i] = 4 * colour.x / sum;
        values.v[block][i] = 9 * colour.y / sum;
    }

    void write_tree(std::ofstream& out, const Block& block, const char* wavelength,
                    std::vector<float>& values, float tolerance, float absolute) {
        size_t numbers = 0;
        const std::string tree = tensor_tree(values, kLevels, tolerance, absolute, numbers);
        losses_.values += numbers;
        out << fmt::format("\t<WavelengthData>\n\t\t<LayerNumber>System</LayerNumber>\n"
                           "\t\t<Wavelength unit=\"Integral\">{}</Wavelength>\n"
                           "\t\t<SourceSpectrum>CIE Illuminant E</SourceSpectrum>\n"
                           "\t\t<DetectorSpectrum>ASTM E308 1931 Y.dsp</DetectorSpectrum>\n"
                           "\t\t<WavelengthDataBlock>\n"
                           "\t\t\t<WavelengthDataDirection>{}</WavelengthDataDirection>\n"
                           "\t\t\t<AngleBasis>LBNL/Shirley-Chiu</AngleBasis>\n"
                           "\t\t\t<ScatteringDataType>{}</ScatteringDataType>\n"
                           "\t\t\t<ScatteringData>\n",
                           wavelength, block.direction, block.type)
            << tree
            << "\n\t\t\t</ScatteringData>\n\t\t</WavelengthDataBlock>\n\t</WavelengthData>\n";
        steps_.add(kTreeSteps);
    }

    TableBsdf table_;
    std::string name_;
    StepCount steps_; ///< a direction of incidence each
    RadianceLosses losses_;
};

} // namespace

RadianceLosses export_radiance(const BsdfTable& table, const std::string& name,
                               const std::filesystem::path& path, const ProgressSignal& progress) {
    Exporter exporter(table, name, progress);
    RadianceLosses losses;
    write_stream_atomically(path, [&](std::ofstream& out) { losses = exporter.write(out); });
    return losses;
}

} // namespace rapport
