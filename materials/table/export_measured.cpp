#include "materials/table/export_measured.h"

#include "materials/table/measured_brdf.h"
#include "materials/table/table_bsdf.h"
#include "renderer/core/parallel.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>

namespace rapport {
namespace {

// How finely the file samples the table: 76 MB. For a streak as narrow as the table's bins (the one
// of tests/unit/export_measured_test.cpp) the RMS difference is then 0.022 of the mean, and the
// albedo within 0.013. Without the shorter steps of θ towards the horizon they are 0.023 and 0.014
// in 63 MB; with as short ones everywhere 0.021 and 0.010 in 120 MB; with a side of 32 0.030 and
// 0.014 in 40 MB; with half as many φ, a side of 64 and no node at the horizon 0.030 and 0.057 in
// 61 MB.
constexpr size_t kPhiSteps = 72;            ///< of incidence, round the circle
constexpr size_t kThetaSteps = 2;           ///< between the table's directions of incidence
constexpr size_t kRows = 49, kColumns = 33; ///< of the warp: φ and √θ of the half vector
constexpr size_t kSide = 48;                ///< nodes a side of the warped square

/// From here on half as long a step of θ: the exits of the table move fastest.
constexpr double kGrazing = 70 * kPi / 180;
/// The table keeps its exits in place beyond its last θ; without a node at the horizon the file's
/// would sink below it with the highlight.
constexpr double kLastTheta = 89.99 * kPi / 180;

/// Dominant wavelengths of the sRGB primaries under an equal-energy white [nm].
constexpr float kPrimaries[] = {464, 549, 611};

/// Least share of the mean intensity that a direction is sampled with; keeps the warp invertible
/// where the table has nothing.
constexpr float kLeastShare = 1e-3f;

/// How far within the warped square its outermost nodes are evaluated: beyond the last direction
/// of some density the warp is not unique.
constexpr float kEdge = 1e-4f;

using Intensity = std::function<glm::vec3(const glm::vec3& eye, const glm::vec3& light)>;

/// Three bands of the table as if they were red, green and blue; beyond the last, the last again.
BsdfTable three_bands(const BsdfTable& table, size_t first) {
    BsdfTable three = table;
    three.bands = Bands{};
    three.colourways.clear();
    const size_t bands = table.bands.count();
    const auto pick = [&](const std::vector<float>& of) {
        std::vector<float> picked;
        picked.reserve(of.size() / bands * 3);
        for (size_t i = 0; i < of.size(); i += bands)
            for (size_t band = first; band < first + 3; ++band)
                picked.push_back(of[i + std::min(band, bands - 1)]);
        return picked;
    };
    for (auto field : {&BsdfTable::intensity, &BsdfTable::unscattered, &BsdfTable::absorbed,
                       &BsdfTable::capped, &BsdfTable::lost})
        three.*field = pick(table.*field);
    return three;
}

/// The node `i` of `count` on [0, 1].
float node(size_t i, size_t count) { return static_cast<float>(i) / static_cast<float>(count - 1); }

/// Directions below the horizon are taken to it.
glm::vec3 above_horizon(const glm::vec3& light) {
    constexpr float kLowest = 1e-4f;
    return light.z > kLowest ? light : glm::normalize(glm::vec3(light.x, light.y, kLowest));
}

glm::vec3 mirrored(const glm::vec3& eye, const glm::vec3& m) {
    return glm::normalize(2 * glm::dot(m, eye) * m - eye);
}

class Exporter {
  public:
    Exporter(const BsdfTable& table, const std::string& name)
        : table_(table), name_(name), rgb_(table, name) {}

    MeasuredFields fields(MeasuredColours colours, const ProgressSignal& progress) {
        lay_out();
        StepCount steps(3 * eyes_.size(), progress);
        add_densities(steps);
        find_lights(steps);
        if (colours == MeasuredColours::rgb)
            fields_.rgb = sampled({[&](const glm::vec3& eye, const glm::vec3& light) {
                                      return rgb_.eval(eye, light);
                                  }},
                                  3, steps);
        else
            add_spectra(steps);
        return std::move(fields_);
    }

  private:
    static constexpr size_t kSlice = kSide * kSide;

    void lay_out() {
        fields_.description = "Rapport: reflection of the face of " + name_;
        for (size_t i = 0; i <= kPhiSteps; ++i)
            fields_.phi.push_back(static_cast<float>((2.0 * double(i) / kPhiSteps - 1) * kPi));
        const std::vector<double>& theta = table_.grid_theta;
        for (size_t i = 0; i + 1 < theta.size(); ++i) {
            const size_t steps = theta[i + 1] > kGrazing ? 2 * kThetaSteps : kThetaSteps;
            for (size_t step = 0; step < steps; ++step)
                fields_.theta.push_back(static_cast<float>(
                    std::lerp(theta[i], theta[i + 1], double(step) / double(steps))));
        }
        fields_.theta.push_back(static_cast<float>(theta.back()));
        if (theta.back() < kLastTheta)
            fields_.theta.push_back(static_cast<float>(kLastTheta));
        for (const float phi : fields_.phi)
            for (const float theta_i : fields_.theta)
                eyes_.push_back(spherical_direction(theta_i, phi));
        fields_.ndf = {2, 2, std::vector<float>(4, 1.0f)};
        fields_.sigma = {2, 2, std::vector<float>(4, 0.25f)};
        fields_.luminance = {kSide, kSide, std::vector<float>(eyes_.size() * kSlice, 1.0f)};
    }

    /// Nodes next to one above the horizon get what there is at the horizon: the density must not
    /// fall to 0 before the intensity does, or rare samples would weigh without bound.
    void add_densities(StepCount& steps) {
        constexpr size_t kNodes = kRows * kColumns;
        fields_.vndf = {kRows, kColumns, std::vector<float>(eyes_.size() * kNodes)};
        parallel_for(eyes_.size(), [&](size_t incidence) {
            const glm::vec3& eye = eyes_[incidence];
            const float albedo = luminance(rgb_.albedo(eye));
            const float least = albedo > 0 ? kLeastShare * albedo / static_cast<float>(2 * kPi) : 1;
            std::vector<glm::vec3> normals, lights;
            for (size_t i = 0; i < kNodes; ++i) {
                normals.push_back(
                    measured_direction({node(i % kColumns, kColumns), node(i / kColumns, kRows)}));
                lights.push_back(mirrored(eye, normals.back()));
            }
            const auto beside_the_sky = [&](size_t i) {
                const size_t row = i / kColumns, column = i % kColumns;
                for (const size_t r : {row, (row + 1) % kRows, (row + kRows - 1) % kRows})
                    for (const size_t c : {column, column + 1, column - 1})
                        if (c < kColumns && lights[r * kColumns + c].z > 0)
                            return true;
                return false;
            };
            for (size_t i = 0; i < kNodes; ++i)
                if (beside_the_sky(i))
                    fields_.vndf.values[incidence * kNodes + i] =
                        std::max(luminance(rgb_.eval(eye, above_horizon(lights[i]))), least) *
                        measured_jacobian(eye, normals[i]);
            steps.add();
        });
    }

    /// The directions that the nodes of the warped square stand for.
    void find_lights(StepCount& steps) {
        const MarginalWarp warp(fields_.vndf.values, kRows, kColumns);
        lights_.resize(eyes_.size() * kSlice);
        parallel_for(eyes_.size(), [&](size_t incidence) {
            for (size_t i = 0; i < kSlice; ++i) {
                const glm::vec2 s = glm::clamp(
                    glm::vec2(node(i % kSide, kSide), node(i / kSide, kSide)), kEdge, 1 - kEdge);
                const glm::vec2 place = warp.sample({{incidence}, {1}}, s).position;
                const glm::vec3& eye = eyes_[incidence];
                lights_[incidence * kSlice + i] =
                    above_horizon(mirrored(eye, measured_direction(place)));
            }
            steps.add();
        });
    }

    /// `channels` values at every node, three from each function.
    MeasuredGrid sampled(const std::vector<Intensity>& functions, size_t channels,
                         StepCount& steps) const {
        MeasuredGrid grid{kSide, kSide, std::vector<float>(lights_.size() * channels)};
        parallel_for(eyes_.size(), [&](size_t incidence) {
            for (size_t i = 0; i < kSlice; ++i)
                for (size_t f = 0; f < functions.size(); ++f) {
                    const glm::vec3 value =
                        functions[f](eyes_[incidence], lights_[incidence * kSlice + i]);
                    for (size_t c = 3 * f; c < std::min(3 * f + 3, channels); ++c)
                        grid.values[(incidence * channels + c) * kSlice + i] =
                            value[static_cast<int>(c - 3 * f)];
                }
            steps.add();
        });
        return grid;
    }

    void add_spectra(StepCount& steps) {
        if (table_.bands.is_rgb()) {
            fields_.wavelengths.assign(std::begin(kPrimaries), std::end(kPrimaries));
            const std::vector<Rgb> rgb = rgb_of_samples(fields_.wavelengths);
            const glm::mat3 spectrum_of = glm::inverse(glm::mat3(rgb[0], rgb[1], rgb[2]));
            fields_.spectra =
                sampled({[&](const glm::vec3& eye, const glm::vec3& light) {
                            return glm::max(spectrum_of * rgb_.eval(eye, light), glm::vec3(0));
                        }},
                        3, steps);
            return;
        }
        const std::vector<double>& edges = table_.bands.edges_nm;
        std::vector<Intensity> functions;
        for (size_t band = 0; band < table_.bands.count(); ++band) {
            fields_.wavelengths.push_back(
                static_cast<float>(0.5 * (edges[band] + edges[band + 1])));
            if (band % 3 == 0)
                functions.emplace_back(
                    [bands = std::make_shared<const TableBsdf>(three_bands(table_, band), name_)](
                        const glm::vec3& eye, const glm::vec3& light) {
                        return bands->eval(eye, light);
                    });
        }
        fields_.spectra = sampled(functions, table_.bands.count(), steps);
    }

    const BsdfTable& table_;
    std::string name_;
    TableBsdf rgb_;
    MeasuredFields fields_;
    std::vector<glm::vec3> eyes_;   ///< [φ, θ] of incidence
    std::vector<glm::vec3> lights_; ///< [φ, θ, rows, columns of the warped square]
};

/// Mean over an evenly bright sky on one side of a share per incident direction and band.
template <class Share> double mean_over_sky(const BsdfTable& table, Side side, const Share& share) {
    double sum = 0, weights = 0;
    const size_t phis = table.grid_phi.size(), thetas = table.grid_theta.size();
    for (size_t i = 0; i < thetas; ++i) {
        const double low = i == 0 ? 0 : 0.5 * (table.grid_theta[i - 1] + table.grid_theta[i]);
        const double high =
            i + 1 == thetas ? kPi / 2 : 0.5 * (table.grid_theta[i] + table.grid_theta[i + 1]);
        const double weight = square(std::sin(high)) - square(std::sin(low));
        for (size_t p = 0; p < phis; ++p) {
            const size_t direction =
                table.grid_index[(static_cast<size_t>(side) * thetas + i) * phis + p];
            for (size_t band = 0; band < table.bands.count(); ++band) {
                sum += weight * share(direction, band);
                weights += weight;
            }
        }
    }
    return sum / weights;
}

/// Directions that are even over the hemisphere (equal areas of cosθ and φ), on no grid.
glm::vec3 even_direction(size_t i, size_t count) {
    constexpr double kGolden = 0.6180339887498949;
    const double cosine = (static_cast<double>(i) + 0.5) / static_cast<double>(count);
    return glm::vec3(spherical_direction(std::acos(cosine), 2 * kPi * kGolden * double(i)));
}

void compare(const TableBsdf& table, const MeasuredBrdf& file, MeasuredLosses& losses,
             const ProgressSignal& progress) {
    constexpr size_t kEyes = 200, kLights = 2000;
    StepCount steps(kEyes, progress);
    double squares = 0, mean = 0;
    for (size_t e = 0; e < kEyes; ++e) {
        const glm::vec3 eye = even_direction(e, kEyes);
        double albedo_table = 0, albedo_file = 0;
        for (size_t l = 0; l < kLights; ++l) {
            const glm::vec3 light = even_direction(l, kLights);
            const double expected = luminance(table.eval(eye, light));
            const double found = luminance(file.eval_and_pdf(eye, light).value);
            squares += square(found - expected);
            mean += expected;
            albedo_table += expected;
            albedo_file += found;
        }
        if (albedo_table > 0)
            losses.largest_albedo_error =
                std::max(losses.largest_albedo_error, std::abs(albedo_file / albedo_table - 1));
        steps.add();
    }
    if (mean > 0)
        losses.resolution = std::sqrt(squares * kEyes * kLights) / mean;
}

} // namespace

MeasuredFields measured_fields(const BsdfTable& table, const std::string& name,
                               MeasuredColours colours, const ProgressSignal& progress) {
    return Exporter(table, name).fields(colours, progress);
}

MeasuredLosses export_measured(const BsdfTable& table, const std::string& name,
                               MeasuredColours colours, const std::filesystem::path& path,
                               const ProgressSignal& progress) {
    // The comparison takes about as long as all before it.
    const auto half = [&](double start) -> ProgressSignal {
        return [&progress, start](double fraction) {
            if (progress)
                progress(start + 0.5 * fraction);
        };
    };
    const MeasuredFields fields = measured_fields(table, name, colours, half(0));
    write_measured(fields, path);

    MeasuredLosses losses;
    const auto reflected = [&](size_t d, size_t band) { return table.reflectance(d)[band]; };
    const auto transmitted = [&](size_t d, size_t band) { return table.transmittance(d)[band]; };
    const auto unscattered = [&](size_t d, size_t band) {
        return table.unscattered[d * table.bands.count() + band];
    };
    losses.kept = mean_over_sky(table, Side::front, reflected);
    losses.transmitted = mean_over_sky(table, Side::front, transmitted);
    losses.unscattered = mean_over_sky(table, Side::front, unscattered);
    losses.back_reflected = mean_over_sky(table, Side::back, reflected);
    losses.back_transmitted = mean_over_sky(table, Side::back, transmitted);
    compare(TableBsdf(table, name), MeasuredBrdf(fields), losses, half(0.5));
    return losses;
}

} // namespace rapport
