#include "materials/table/packed_table.h"

#include "materials/table/bin_reconstruction.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace rapport {
namespace {

constexpr float kLargestRoot = 65535, kSteepest = 127;
/// Of a bin's width: fast_angles' 2e-6 over a row's 0.125, and six times that.
constexpr float kInside = 1e-4f;
/// Of an axis of incidence, to an interval.
constexpr size_t kGuideSteps = 16;

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

/// What each channel of a node is multiplied by, so that no more of it leaves than came in: a
/// bright saturated spectrum can be brighter than white in a channel (1.14 in red, of all but
/// 500–520 nm). To take that channel down alone is the nearest colour; to mix with grey would make
/// a pale one of a bright orange, and to darken all channels would cost the others.
Rgb within_one(const glm::dvec3& leaving) { return Rgb(1.0 / glm::max(leaving, 1.0)); }

/// Partial sums of `shares` over their sum, filled up with infinity to whole lines; the sum.
double accumulate_shares(std::span<const double> shares, Line* cumulative) {
    double total = 0, sum = 0;
    for (const double share : shares)
        total += share;
    for (size_t i = 0; i < 16 * Line::lines(shares.size()); ++i)
        cumulative[i / 16].numbers[i % 16] = i >= shares.size() ? HUGE_VALF
                                             : total > 0
                                                 ? static_cast<float>((sum += shares[i]) / total)
                                                 : 0;
    return total;
}

std::vector<double> closed_circle(std::vector<double> phi) {
    phi.push_back(2 * kPi);
    return phi;
}

Float4 rgb0(const Rgb& c) { return Float4{c.r, c.g, c.b, 0}; }

} // namespace

PackedTable::Axis::Axis(const std::vector<double>& axis) {
    if (axis.size() == 1)
        intervals.push_back({static_cast<float>(axis.front()), 0, HUGE_VALF});
    for (size_t i = 0; i + 1 < axis.size(); ++i)
        intervals.push_back({static_cast<float>(axis[i]),
                             static_cast<float>(1 / (axis[i + 1] - axis[i])),
                             i + 2 < axis.size() ? static_cast<float>(axis[i + 1]) : HUGE_VALF});
    const size_t count = kGuideSteps * intervals.size();
    const double range = axis.back() - axis.front();
    steps = range > 0 ? static_cast<float>(count / range) : 0;
    for (size_t i = 0, interval = 0; i < count; ++i) {
        while (intervals[interval].end <= axis.front() + range * i / count)
            ++interval;
        guide.push_back(static_cast<uint32_t>(interval));
    }
}

inline size_t PackedTable::Axis::interval(uint32_t step, float x) const {
    size_t i = guide[step];
    while (intervals[i].end <= x)
        ++i;
    return i;
}

PackedTable::PackedTable(const BsdfTable& table, const StopSignal& stopped)
    : exits_(table.exits), mesh_(table.exits), theta_(table.grid_theta),
      phi_(closed_circle(table.grid_phi)), starts_{theta_.intervals[0].start,
                                                   phi_.intervals[0].start, 0, 0},
      steps_{theta_.steps, phi_.steps, 0, 0}, last_{theta_.guide.size() - 0.5f,
                                                    phi_.guide.size() - 0.5f, 0, 0},
      least_cosine_(static_cast<float>(std::cos(table.grid_theta.back()))),
      exit_axis_(table.exit_axis), thetas_(table.grid_theta.size()), phis_(table.grid_phi.size()),
      side_nodes_(thetas_ * phis_), nodes_(2 * side_nodes_), rows_(exits_.rows()),
      block_bins_(exits_.bins()), bins_(2 * exits_.bins() * nodes_ + 1), scale_(nodes_ + 1),
      reflected_(nodes_ + 1), transmitted_(nodes_ + 1), shares_(nodes_),
      column_lines_(Line::lines(exits_.columns())), row_lines_(Line::lines(exits_.rows())),
      cumulative_lines_(column_lines_ + exits_.columns() * row_lines_),
      cumulative_(2 * nodes_ * cumulative_lines_) {
    const std::vector<Rgb> band_rgb = table.bands.to_rgb();
    for (const size_t side : {0, 1})
        for (size_t theta = 0; theta < thetas_; ++theta)
            for (size_t phi = 0; phi < phis_; ++phi) {
                throw_if(stopped);
                add_node(table, side, theta, phi, band_rgb);
            }
}

void PackedTable::add_node(const BsdfTable& table, size_t side, size_t theta, size_t phi,
                           const std::vector<Rgb>& band_rgb) {
    const size_t direction = table.grid_index[side * side_nodes_ + theta * phis_ + phi];
    const size_t at = side * side_nodes_ + phi * thetas_ + theta;
    const size_t bins = exits_.bins(), rows = exits_.rows();
    const ExitBins exits = table.exits_of(direction);

    std::vector<Rgb> means(2 * bins);
    std::vector<double> area(bins), jacobian(bins); // of the chart; solid angle over it
    for (size_t i = 0; i < bins; ++i) {
        const DirectionMesh::Bounds b = exits_.bounds(i);
        area[i] = (b.u_high - b.u_low) * (b.v_high - b.v_low);
        jacobian[i] = exits.solid_angle(i) / area[i];
    }
    Rgb unscattered = to_rgb(&table.unscattered[direction * band_rgb.size()], band_rgb);
    glm::dvec3 leaving(unscattered);
    for (size_t i = 0; i < means.size(); ++i) {
        means[i] =
            to_rgb(&table.intensity[(direction * means.size() + i) * band_rgb.size()], band_rgb);
        leaving += glm::dvec3(means[i]) * exits.solid_angle(i % bins);
    }
    const Rgb within = within_one(leaving);
    unscattered *= within;
    float largest = 0;
    for (size_t i = 0; i < means.size(); ++i) {
        means[i] *= within;
        largest = std::max({largest, means[i].r * static_cast<float>(jacobian[i % bins]),
                            means[i].g * static_cast<float>(jacobian[i % bins]),
                            means[i].b * static_cast<float>(jacobian[i % bins])});
    }
    scale_[at] = largest / square(kLargestRoot);

    glm::dvec3 flux(0);
    for (size_t block = 0; block < 2; ++block) {
        const std::vector<BinPlane> planes =
            reconstruct(exits_, exits, std::span(means).subspan(block * bins, bins));
        std::vector<double> shares(bins);
        for (size_t i = 0; i < bins; ++i) {
            Bin& bin = bins_[(block * bins + i) * nodes_ + at];
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
        Line* const of_columns = &cumulative_[(at * 2 + block) * cumulative_lines_];
        Line* const of_rows = of_columns + column_lines_;
        std::vector<double> columns(exits_.columns());
        for (size_t column = 0; column < columns.size(); ++column)
            columns[column] = accumulate_shares(std::span(shares).subspan(column * rows, rows),
                                                of_rows + column * row_lines_);
        const auto share = static_cast<float>(accumulate_shares(columns, of_columns));
        (block == 0 ? reflected_ : transmitted_)[at] = share;
    }
    shares_[at] = {rgb0(unscattered), rgb0(Rgb(flux))};
}

// Looking up: hardly a branch, four numbers at a time.

inline PackedTable::EyeAndLight PackedTable::prepare(const glm::vec3& eye,
                                                     const glm::vec3& light) const {
    Float4 e = load_xyz(&eye.x);
    e = max4(e, e * Float4{1, 1, -1, 1});
    if (e[2] < least_cosine_) {
        // Beyond the last θ the chart stays where it is: to follow the highlight down to the
        // horizon would heap up the light before it.
        e *= sqrt4(four((1 - square(least_cosine_)) / ((1 - e[2]) * (1 + e[2]))));
        e[2] = least_cosine_;
    }
    const size_t side = eye.z > 0 ? 0 : 1;
    const FastChart chart(e, exit_axis_[side]);
    const Float4 l = load_xyz(&light.x);
    const Float4 angles = fast_angles_of(e, chart.across(l), light.z);
    const Float4 steps = max4(min4((angles - starts_) * steps_, last_), Float4{});
    const Int4 step = __builtin_convertvector(steps, Int4);
    const size_t t = theta_.interval(step[0], angles[0]), p = phi_.interval(step[1], angles[1]);
    const Float4 intervals = load_pairs(&theta_.intervals[t].start, &phi_.intervals[p].start);
    const Float4 starts = __builtin_shufflevector(intervals, intervals, 0, 2, 0, 2);
    const Float4 per_length = __builtin_shufflevector(intervals, intervals, 1, 3, 1, 3);
    const Float4 after = clamp4((angles - starts) * per_length, 0, 1), before = 1 - after;
    const size_t next = p + 1 == phis_ ? 0 : p + 1;
    const size_t at = side * side_nodes_ + t;
    return {{at + p * thetas_, at + next * thetas_,
             __builtin_shufflevector(before, after, 0, 4, 0, 4) *
                 __builtin_shufflevector(before, after, 1, 1, 5, 5),
             chart},
            chart.point(l, angles[2])};
}

/// Of the mean albedo, that of each node.
inline Float4 PackedTable::albedo_parts(const Eye& eye) const {
    return eye.weight * (load_pairs(&reflected_[eye.first], &reflected_[eye.second]) +
                         load_pairs(&transmitted_[eye.first], &transmitted_[eye.second]));
}

inline float PackedTable::mean_albedo(const Eye& eye) const {
    const Float4 parts = albedo_parts(eye);
    return ((parts[0] + parts[1]) + parts[2]) + parts[3];
}

inline Float4 PackedTable::intensity(const Eye& eye, size_t block, const FastMesh::Place& place,
                                     float density) const {
    const Bin* const bin = nodes_of_bin(block, place.bin);
    Word8 first, second;
    std::memcpy(&first, bin + eye.first, sizeof first);
    std::memcpy(&second, bin + eye.second, sizeof second);
    const Int4 slopes = std::bit_cast<Int4>(__builtin_shufflevector(
        std::bit_cast<Float4>(first), std::bit_cast<Float4>(second), 1, 3, 5, 7));
    const Float4 xi = __builtin_convertvector((slopes << 8) >> 24, Float4);
    const Float4 eta = __builtin_convertvector(slopes >> 24, Float4);
    const Float4 across = place.across * (1 / kSteepest);
    const Float4 factor = eye.weight * load_pairs(&scale_[eye.first], &scale_[eye.second]) *
                          density * (1 + xi * across[0] + eta * across[1]);
    const Float4 roots[] = {low_words(first), high_words(first), low_words(second),
                            high_words(second)};
    return (factor[0] * (roots[0] * roots[0]) + factor[1] * (roots[1] * roots[1])) +
           (factor[2] * (roots[2] * roots[2]) + factor[3] * (roots[3] * roots[3]));
}

namespace {

float sum3(Float4 c) { return (c[0] + c[1]) + c[2]; }

/// Where `u` in [0, 1) falls in a distribution cumulated to 1, and what is left of it, uniform
/// again. Parts without a share are never found.
struct Part {
    size_t index;
    float left; ///< [0, 1]
};
Part find_part(const Line* cumulative, size_t lines, float u) {
    const size_t i = count_up_to(cumulative, lines, u);
    const float* const up_to = cumulative->numbers + i;
    const float below = i > 0 ? up_to[-1] : 0;
    return {i, (u - below) / (*up_to - below)};
}

} // namespace

PackedTable::Value PackedTable::eval_and_pdf(const glm::vec3& eye, const glm::vec3& light) const {
    const EyeAndLight prepared = prepare(eye, light);
    const float albedo = mean_albedo(prepared.eye);
    const size_t block = (light.z > 0) == (eye.z > 0) ? 0 : 1;
    const Float4 c =
        intensity(prepared.eye, block, mesh_.place(prepared.light.uv), prepared.light.density);
    return {{c[0], c[1], c[2]}, albedo > 0 ? sum3(c) / (3 * albedo) : 0};
}

std::optional<PackedTable::Sample> PackedTable::sample(const glm::vec3& eye, float choice,
                                                       const glm::vec2& u) const {
    const Eye prepared = prepare(eye, eye).eye;
    // The four nodes' parts of the albedo one after the other, in each what is reflected first.
    const Float4 whole = albedo_parts(prepared);
    const float up_to[] = {0, whole[0], whole[0] + whole[1], (whole[0] + whole[1]) + whole[2]};
    const float albedo = up_to[3] + whole[3];
    if (!(albedo > 0))
        return std::nullopt;
    const float chosen = choice * albedo;
    const size_t k = size_t{chosen >= up_to[1]} + (chosen >= up_to[2]) + (chosen >= up_to[3]);
    const size_t node = prepared.node(k);
    const Float4 past = four(chosen - up_to[k]);
    const Float4 reflected = four(prepared.weight[k] * reflected_[node]);
    const Float4 transmitted = four(prepared.weight[k] * transmitted_[node]);
    const Int4 through = (past >= reflected) & (transmitted > 0);
    const size_t block = through[0] & 1;
    const Float4 turn =
        (past - keep_where(through, reflected)) / (through ? transmitted : reflected);

    const Line* const columns = &cumulative_[(node * 2 + block) * cumulative_lines_];
    const Part column = find_part(columns, column_lines_, u.x);
    const Part row =
        find_part(columns + column_lines_ + column.index * row_lines_, row_lines_, u.y);
    const size_t index = column.index * rows_ + row.index;
    const Bin& bin = nodes_of_bin(block, index)[node];
    const Float4 slope = Float4{float(bin.slope_xi), float(bin.slope_eta), 0, 0} * (1 / kSteepest);
    // No nearer to an edge than where rounding would carry the direction over it, to a bin that may
    // be empty.
    const Float4 share = clamp4(sample_plane(slope, Float4{column.left, row.left, 0, 0}, turn),
                                kInside, 1 - kInside);
    const Float4 uv = mesh_.point(column.index, row.index, share);
    const Float4 c = intensity(prepared, block, {index, 2 * share - 1}, prepared.chart.density(uv));
    const float sum = sum3(c);
    if (!(sum > 0))
        return std::nullopt;
    const Float4 w = c * (3 * albedo / sum);
    glm::vec3 light = prepared.chart.direction(uv);
    // On the horizon it would lose its side.
    light.z = std::max(light.z, 1e-7f);
    light.z = std::copysign(light.z, (block == 0) == (eye.z > 0) ? 1.0f : -1.0f);
    return Sample{light, {w[0], w[1], w[2]}, sum / (3 * albedo)};
}

PackedTable::Shares PackedTable::shares(const glm::vec3& eye) const {
    const Eye prepared = prepare(eye, eye).eye;
    Float4 u{}, s{};
    for (size_t k = 0; k < 4; ++k) {
        const NodeShares& node = shares_[prepared.node(k)];
        u += prepared.weight[k] * node.unscattered;
        s += prepared.weight[k] * node.scattered;
    }
    return {{u[0], u[1], u[2]}, {s[0], s[1], s[2]}};
}

} // namespace rapport
