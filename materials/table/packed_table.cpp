#include "materials/table/packed_table.h"

#include "materials/table/bin_reconstruction.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace rapport {
namespace {

constexpr float kOneMinusEpsilon = 0x1.fffffep-1f;
constexpr float kLargestRoot = 65535, kSteepest = 127;

/// Saturated bands lie outside sRGB and have a negative channel: mixed with the grey of the same
/// luminance until there is none. Keeps the luminance, and densities positive.
Rgb into_gamut(const Rgb& c) {
    const float lowest = std::min({c.r, c.g, c.b});
    if (lowest >= 0)
        return c;
    const float grey = std::max(luminance(c), 0.0f);
    return glm::max(grey + (c - grey) * (grey / (grey - lowest)), Rgb(0));
}

Rgb to_rgb(const float* values, const std::vector<Rgb>& band_rgb) {
    Rgb sum(0);
    for (size_t band = 0; band < band_rgb.size(); ++band)
        sum += values[band] * band_rgb[band];
    return into_gamut(sum);
}

/// Where `u` in [0, 1) falls in a distribution cumulated to 1, and what is left of it, uniform
/// again. Parts without a share are never found.
struct Part {
    size_t index;
    float left;
};
Part find_part(std::span<const Float4> cumulative, float u) {
    const size_t i = count_up_to(cumulative, u);
    const float above = cumulative[i / 4][i % 4];
    const float below = i > 0 ? cumulative[(i - 1) / 4][(i - 1) % 4] : 0;
    return {i, std::clamp((u - below) / (above - below), 0.0f, kOneMinusEpsilon)};
}

/// Partial sums of `shares` over their sum, in fours; the sum.
double accumulate_shares(std::span<const double> shares, Float4* cumulative) {
    double total = 0, sum = 0;
    for (const double share : shares)
        total += share;
    std::vector<float> partial;
    for (const double share : shares)
        partial.push_back(total > 0 ? static_cast<float>((sum += share) / total) : 0);
    std::ranges::copy(in_fours(partial), cumulative);
    return total;
}

std::vector<double> closed_circle(std::vector<double> phi) {
    phi.push_back(2 * kPi);
    return phi;
}

Float4 four(const Rgb& c) { return Float4{c.r, c.g, c.b, 0}; }

} // namespace

PackedTable::Axis::Axis(const std::vector<double>& axis) : values(axis.begin(), axis.end()) {
    const size_t intervals = axis.size() - 1;
    const double range = axis.back() - axis.front();
    steps = intervals > 0 ? static_cast<float>(intervals / range) : 0;
    for (size_t i = 0; i < intervals; ++i) {
        per_step.push_back(static_cast<float>(1 / (axis[i + 1] - axis[i])));
        const double start = axis.front() + range * i / intervals;
        const auto after = std::upper_bound(axis.begin(), axis.end(), start) - axis.begin();
        guide.push_back(static_cast<uint32_t>(std::max<std::ptrdiff_t>(after, 1) - 1));
    }
}

PackedTable::Axis::Place PackedTable::Axis::place(float x) const {
    if (guide.empty())
        return {0, 0};
    const float step = std::clamp((x - values[0]) * steps, 0.0f, guide.size() - 0.5f);
    size_t i = guide[static_cast<size_t>(step)];
    while (i + 1 < guide.size() && values[i + 1] <= x)
        ++i;
    return {i, std::clamp((x - values[i]) * per_step[i], 0.0f, 1.0f)};
}

PackedTable::PackedTable(const BsdfTable& table)
    : mesh_(table.exits), theta_(table.grid_theta), phi_(closed_circle(table.grid_phi)),
      least_cosine_(static_cast<float>(std::cos(table.grid_theta.back()))),
      phis_(table.grid_phi.size()), nodes_(table.grid_theta.size() * phis_),
      bins_(4 * mesh_.bins() * nodes_), scale_(2 * nodes_), albedo_(2 * nodes_),
      unscattered_(2 * nodes_), share_(4 * nodes_), column_fours_((mesh_.columns() + 3) / 4),
      row_fours_((mesh_.rows() + 3) / 4),
      cumulative_size_(column_fours_ + mesh_.columns() * row_fours_),
      cumulative_(4 * nodes_ * cumulative_size_) {
    const std::vector<Rgb> band_rgb = table.bands.to_rgb();
    for (const size_t side : {0, 1})
        for (size_t node = 0; node < nodes_; ++node)
            add_node(table, side, node, band_rgb);
}

void PackedTable::add_node(const BsdfTable& table, size_t side, size_t node,
                           const std::vector<Rgb>& band_rgb) {
    const size_t direction = table.grid_index[side * nodes_ + node], at = side * nodes_ + node;
    const size_t bins = mesh_.bins(), rows = mesh_.rows();
    const ExitBins exits = table.exits_of(direction);

    std::vector<Rgb> means(2 * bins);
    std::vector<double> area(bins), jacobian(bins); // of the chart; solid angle over it
    for (size_t i = 0; i < bins; ++i) {
        const DirectionMesh::Bounds b = mesh_.bounds(i);
        area[i] = (b.u_high - b.u_low) * (b.v_high - b.v_low);
        jacobian[i] = exits.solid_angle(i) / area[i];
    }
    float largest = 0;
    for (size_t i = 0; i < means.size(); ++i) {
        means[i] =
            to_rgb(&table.intensity[(direction * means.size() + i) * band_rgb.size()], band_rgb);
        largest = std::max({largest, means[i].r * static_cast<float>(jacobian[i % bins]),
                            means[i].g * static_cast<float>(jacobian[i % bins]),
                            means[i].b * static_cast<float>(jacobian[i % bins])});
    }
    scale_[at] = largest / square(kLargestRoot);

    glm::dvec3 flux(0);
    for (size_t block = 0; block < 2; ++block) {
        const std::vector<BinPlane> planes =
            reconstruct(mesh_, exits, std::span(means).subspan(block * bins, bins));
        std::vector<double> shares(bins);
        for (size_t i = 0; i < bins; ++i) {
            Bin& bin = bins_[((side * 2 + block) * bins + i) * nodes_ + node];
            for (int c = 0; c < 3; ++c) {
                const float density = planes[i].mean[c] * static_cast<float>(jacobian[i]);
                bin.root[c] = static_cast<uint16_t>(
                    largest > 0 ? std::lround(std::sqrt(density / largest) * kLargestRoot) : 0);
                const double kept = scale_[at] * square(static_cast<double>(bin.root[c])) * area[i];
                flux[c] += kept;
                shares[i] += kept / 3;
            }
            bin.slope_xi = static_cast<int8_t>(planes[i].slope_xi * kSteepest);
            bin.slope_eta = static_cast<int8_t>(planes[i].slope_eta * kSteepest);
        }
        Float4* const of_columns = &cumulative_[(at * 2 + block) * cumulative_size_];
        Float4* const of_rows = of_columns + column_fours_;
        std::vector<double> columns(mesh_.columns());
        for (size_t column = 0; column < columns.size(); ++column)
            columns[column] = accumulate_shares(std::span(shares).subspan(column * rows, rows),
                                                of_rows + column * row_fours_);
        share_[at * 2 + block] = static_cast<float>(accumulate_shares(columns, of_columns));
    }
    albedo_[at] = four(Rgb(flux));
    unscattered_[at] = four(to_rgb(&table.unscattered[direction * band_rgb.size()], band_rgb));
}

PackedTable::Blend PackedTable::blend(const glm::vec3& eye) const {
    const Axis::Place t = theta_.place(fast_acos(std::min(std::abs(eye.z), 1.0f)));
    const Axis::Place p = phi_.place(fast_azimuth(eye.x, eye.y));
    const size_t next = p.interval + 1 == phis_ ? 0 : p.interval + 1;
    const size_t inner = t.interval * phis_, outer = theta_.guide.empty() ? inner : inner + phis_;
    const auto node = [](size_t n) { return static_cast<uint32_t>(n); };
    return {eye.z > 0 ? 0u : 1u,
            {node(inner + p.interval), node(inner + next), node(outer + p.interval),
             node(outer + next)},
            {(1 - t.share) * (1 - p.share), (1 - t.share) * p.share, t.share * (1 - p.share),
             t.share * p.share}};
}

ExitChart<float> PackedTable::chart(const glm::vec3& eye) const {
    const float cosine = std::abs(eye.z);
    if (cosine >= least_cosine_)
        return ExitChart<float>(eye);
    const float scale = std::sqrt((1 - square(least_cosine_)) / ((1 - cosine) * (1 + cosine)));
    return ExitChart<float>({eye.x * scale, eye.y * scale, least_cosine_});
}

Rgb PackedTable::blended(const Blend& blend, const std::vector<Float4>& values) const {
    const Float4* const side = &values[blend.side * nodes_];
    Float4 sum{};
    for (int k = 0; k < 4; ++k)
        sum += blend.weight[k] * side[blend.node[k]];
    return {sum[0], sum[1], sum[2]};
}

Rgb PackedTable::intensity(const Blend& blend, const ExitChart<float>& chart,
                           const glm::vec3& light) const {
    const ChartPoint<float> point = chart.point(light);
    const auto place = mesh_.place(point);
    const size_t block = (light.z > 0) == (blend.side == 0) ? 0 : 1;
    const Bin* const nodes = &bins_[((blend.side * 2 + block) * mesh_.bins() + place.bin) * nodes_];
    const float* const scale = &scale_[blend.side * nodes_];
    const float xi = place.xi * (1 / kSteepest), eta = place.eta * (1 / kSteepest);
    Float4 sum{};
    for (int k = 0; k < 4; ++k) {
        const Bin& bin = nodes[blend.node[k]];
        const Float4 root = load_uint16(&bin);
        sum += (blend.weight[k] * scale[blend.node[k]] *
                (1 + bin.slope_xi * xi + bin.slope_eta * eta)) *
               (root * root);
    }
    sum *= chart.density(point);
    return {sum[0], sum[1], sum[2]};
}

PackedTable::Exit PackedTable::sample(const Blend& blend, float choice, const glm::vec2& u) const {
    const float* const share = &share_[blend.side * nodes_ * 2];
    Float4 cumulative[2];
    float sum = 0;
    for (int k = 0; k < 4; ++k)
        for (int block = 0; block < 2; ++block)
            cumulative[k / 2][2 * (k % 2) + block] = sum +=
                blend.weight[k] * share[2 * blend.node[k] + block];
    const size_t picked = count_up_to(cumulative, choice * sum);
    const uint32_t node = blend.node[picked / 2];
    const size_t block = picked % 2;

    const Float4* const columns =
        &cumulative_[((blend.side * nodes_ + node) * 2 + block) * cumulative_size_];
    const Part column = find_part({columns, column_fours_}, u.x);
    const Part row =
        find_part({columns + column_fours_ + column.index * row_fours_, row_fours_}, u.y);
    const size_t i = column.index * mesh_.rows() + row.index;
    const Bin& bin = bins_[((blend.side * 2 + block) * mesh_.bins() + i) * nodes_ + node];
    const glm::vec2 place = sample_plane(bin.slope_xi * (1 / kSteepest),
                                         bin.slope_eta * (1 / kSteepest), {column.left, row.left});
    return {block == 1, mesh_.point<float>({i, place.x, place.y})};
}

} // namespace rapport
