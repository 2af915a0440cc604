#include "renderer/core/bands.h"
#include "renderer/core/math.h"
#include "renderer/core/rng.h"

#include <algorithm>
#include <array>
#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <memory>
#include <numeric>
#include <vector>

// Time of one look-up by each way to table exits that charts/parameterisation.py compares, which
// draws it:
//     parameterisation_bench --benchmark_repetitions=31 --benchmark_enable_random_interleaving=true
//         --benchmark_format=json > lookup.json
// All are written alike, plainly and with the C library's functions, around the same search of the
// grid of incidence and the same blend of four nodes' planes, 8 bytes each, over directions from
// the whole sphere: the ways differ by their angles, and by how much of the table stays in the
// cache. What has been chosen is written faster in materials/table/packed_table.cpp (table_bench).

namespace rapport {
namespace {

constexpr float kHalfPi = static_cast<float>(kPi / 2), kWhole = static_cast<float>(2 * kPi);
constexpr size_t kThetas = 10, kPhis = 24, kNodes = kThetas * kPhis;

struct Bin {
    uint16_t root[3];
    int8_t slope_a, slope_b;
};
/// A bin, the place in it from −1 to 1 along either coordinate, and area of the chart per solid
/// angle.
struct Place {
    size_t bin;
    float a, b, density;
};

Place on_grid(float a, float b, int columns, int rows, float density) {
    const float x = a * static_cast<float>(columns), y = b * static_cast<float>(rows);
    const int i = std::clamp(static_cast<int>(x), 0, columns - 1);
    const int j = std::clamp(static_cast<int>(y), 0, rows - 1);
    return {static_cast<size_t>(i * rows + j), 2 * (x - static_cast<float>(i)) - 1,
            2 * (y - static_cast<float>(j)) - 1, density};
}

// Ways of a hemisphere: `bins()`, and where a light is for an eye.

class Rings {
  public:
    Rings(bool finer_towards_grazing, std::vector<int> counts)
        : finer_(finer_towards_grazing), counts_(std::move(counts)), first_(counts_.size()) {
        std::exclusive_scan(counts_.begin(), counts_.end(), first_.begin(), 0);
    }
    size_t bins() const { return static_cast<size_t>(first_.back() + counts_.back()); }
    Place place(const glm::vec3&, const glm::vec3& w) const {
        float from_pole = std::acos(std::min(std::abs(w.z), 1.0f)) / kHalfPi;
        if (finer_) // solved for s, 1 − θ/90° = s/4 + s²·3/4
            from_pole = 1 - (std::sqrt(0.0625f + 3 * (1 - from_pole)) - 0.25f) / 1.5f;
        const float at = from_pole * static_cast<float>(counts_.size());
        const auto ring = std::min(static_cast<size_t>(std::max(at, 0.0f)), counts_.size() - 1);
        const float phi = std::atan2(w.y, w.x) / kWhole;
        const auto count = static_cast<float>(counts_[ring]);
        const float along = (phi < 0 ? phi + 1 : phi) * count;
        const int number = std::min(static_cast<int>(along), counts_[ring] - 1);
        return {static_cast<size_t>(first_[ring] + number), 2 * (at - static_cast<float>(ring)) - 1,
                2 * (along - static_cast<float>(number)) - 1, 1};
    }

  private:
    bool finer_;
    std::vector<int> counts_, first_;
};

Rings near_equal_rings(int rings) {
    std::vector<int> counts;
    for (int i = 0; i < rings; ++i)
        counts.push_back(
            static_cast<int>(std::lround(4 * rings * std::sin((i + 0.5) / rings * kPi / 2))));
    return {false, counts};
}

/// Shirley and Chiu's concentric map.
struct EqualAreaDisc {
    int side;
    size_t bins() const { return static_cast<size_t>(side) * side; }
    Place place(const glm::vec3&, const glm::vec3& w) const {
        const float r = std::sqrt(1 - std::abs(w.z));
        float phi = std::atan2(w.y, w.x);
        if (phi < -kHalfPi / 2)
            phi += kWhole;
        const int quarter = static_cast<int>((phi + kHalfPi / 2) / kHalfPi) & 3;
        const float along = r * (phi - static_cast<float>(quarter) * kHalfPi) * (2 / kHalfPi);
        const std::array<float, 4> x{r, -along, -r, along}, y{along, r, -along, -r};
        return on_grid(0.5f * (x[quarter] + 1), 0.5f * (y[quarter] + 1), side, side, 1 / kWhole);
    }
};

struct Slid {
    float to, per_solid_angle;
};
Slid slide(float x, float origin) {
    const float clamped = std::clamp(origin, -0.97f, 0.97f);
    const float length = 1 + (x < clamped ? clamped : -clamped);
    return {(x - clamped) / length, 1 / length};
}
Slid spaced(float x, float finest) {
    const float step =
        (std::sqrt(finest * finest / 4 + (1 - finest) * std::abs(x)) - finest / 2) / (1 - finest);
    return {0.5f + std::copysign(0.5f * step, x), 1 / (2 * (finest + 2 * (1 - finest) * step))};
}

struct AboutTheMirror {
    int columns, rows;
    size_t bins() const { return static_cast<size_t>(columns) * rows; }
    Place place(const glm::vec3& eye, const glm::vec3& w) const {
        const Slid u = slide(w.y, -eye.y), v = slide(std::atan2(w.x, std::abs(w.z)) / kHalfPi,
                                                     -std::atan2(eye.x, std::abs(eye.z)) / kHalfPi);
        const Slid a = spaced(u.to, 0.15f), b = spaced(v.to, 0.25f);
        return on_grid(a.to, b.to, columns, rows,
                       u.per_solid_angle * v.per_solid_angle * a.per_solid_angle *
                           b.per_solid_angle / kHalfPi);
    }
};

struct Cone {
    int along; ///< the coordinate along the yarns
    int columns, rows;
    size_t bins() const { return static_cast<size_t>(columns) * rows; }
    Place place(const glm::vec3& eye, const glm::vec3& w) const {
        const Slid u = slide(w[along], -eye[along]), a = spaced(u.to, 0.15f);
        const float b = std::atan2(w[1 - along], std::abs(w.z)) / (2 * kHalfPi) + 0.5f;
        return on_grid(a.to, b, columns, rows,
                       u.per_solid_angle * a.per_solid_angle / (2 * kHalfPi));
    }
};

/// The bins of both sides and hemispheres, those of one number of all nodes together.
template <class Way> class Table {
  public:
    explicit Table(Way way) : way_(std::move(way)), bins_(2 * way_.bins() * 2 * kNodes) {
        CounterRng rng(2, Purpose::test, 0, 0);
        const auto number = [&](float most) {
            return static_cast<int>(std::lround(most * rng.uniform_float()));
        };
        for (Bin& bin : bins_) {
            for (uint16_t& root : bin.root)
                root = static_cast<uint16_t>(number(65535));
            bin.slope_a = static_cast<int8_t>(number(126) - 63);
            bin.slope_b = static_cast<int8_t>(number(126) - 63);
        }
    }

    size_t bins() const { return way_.bins(); }
    Rgb eval(const glm::vec3& eye, const glm::vec3& light) const {
        const float theta = std::acos(std::min(std::abs(eye.z), 1.0f)) / kHalfPi * 9;
        const float turn = std::atan2(eye.y, eye.x) / kWhole;
        const float phi = (turn < 0 ? turn + 1 : turn) * kPhis;
        const auto t = std::min(static_cast<size_t>(theta), kThetas - 2);
        const auto p = std::min(static_cast<size_t>(phi), kPhis - 1);
        const float s = theta - static_cast<float>(t), r = phi - static_cast<float>(p);
        const Place at = way_.place(eye, light);
        const size_t block = (light.z > 0) == (eye.z > 0) ? 0 : 1;
        const Bin* const bin =
            &bins_[(block * way_.bins() + at.bin) * 2 * kNodes + (eye.z > 0 ? 0 : kNodes) + t];
        const Bin* const before = bin + p * kThetas;
        const Bin* const after = bin + (p + 1 == kPhis ? 0 : p + 1) * kThetas;
        return at.density * ((1 - r) * ((1 - s) * plane(before[0], at) + s * plane(before[1], at)) +
                             r * ((1 - s) * plane(after[0], at) + s * plane(after[1], at)));
    }

  private:
    static Rgb plane(const Bin& bin, const Place& at) {
        const Rgb root(bin.root[0], bin.root[1], bin.root[2]);
        return (1 + at.a * bin.slope_a / 127.0f + at.b * bin.slope_b / 127.0f) * root * root;
    }

    Way way_;
    std::vector<Bin> bins_;
};

struct Query {
    glm::vec3 eye, light;
};
const std::vector<Query>& queries() {
    static const std::vector<Query> all = [] {
        CounterRng rng(1, Purpose::test, 0, 0);
        const auto uniform_direction = [&] {
            return spherical_direction(std::acos(1 - 2 * rng.uniform_float()),
                                       static_cast<float>(2 * kPi) * rng.uniform_float());
        };
        std::vector<Query> made(1 << 14);
        for (Query& query : made)
            query = {uniform_direction(), uniform_direction()};
        return made;
    }();
    return all;
}

template <class Way> void add(const std::string& name, Way way) {
    const auto table = std::make_shared<const Table<Way>>(std::move(way));
    benchmark::RegisterBenchmark(
        fmt::format("{}/{}", name, table->bins()).c_str(), [table](benchmark::State& state) {
            const std::vector<Query>& all = queries();
            size_t i = 0;
            for (auto _ : state) {
                benchmark::DoNotOptimize(table->eval(all[i].eye, all[i].light));
                i = (i + 1) % all.size();
            }
        });
}

void add_all() {
    for (const int rings : {9, 18}) {
        const std::vector<int> counts(rings, 4 * rings);
        add("uniform θ × φ", Rings(false, counts));
        add("θ finer towards grazing", Rings(true, counts));
    }
    for (const int rings : {9, 12, 18})
        add("rings of near-equal solid angle", near_equal_rings(rings));
    for (const int side : {14, 20, 36})
        add("equal-area disc (Shirley–Chiu)", EqualAreaDisc{side});
    for (const auto& [columns, rows] : {std::pair(16, 12), {24, 16}, {32, 16}})
        add("about the mirror direction", AboutTheMirror{columns, rows});
    for (const auto& [columns, rows] : {std::pair(16, 12), {24, 12}, {24, 16}, {32, 16}}) {
        add("cone of the warp", Cone{1, columns, rows});
        add("cone of the weft", Cone{0, columns, rows});
    }
}

} // namespace
} // namespace rapport

int main(int count, char** arguments) {
    benchmark::Initialize(&count, arguments);
    rapport::add_all();
    benchmark::RunSpecifiedBenchmarks();
}
