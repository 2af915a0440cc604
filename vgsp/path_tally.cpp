#include "vgsp/path_tally.h"

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>
#include <stdexcept>

namespace rapport {

GoniophotometerCounts& operator+=(GoniophotometerCounts& a, const GoniophotometerCounts& b) {
    a.paths += b.paths;
    a.events += b.events;
    a.overlaps += b.overlaps;
    a.capped += b.capped;
    a.lost += b.lost;
    return a;
}

double variance_between(std::span<const double> sums, double squares,
                        std::span<const double> paths) {
    const double r = static_cast<double>(sums.size());
    double mean = 0, mean2 = 0, explained = 0, inverse_paths = 0, n = 0;
    for (size_t i = 0; i < sums.size(); ++i) {
        const double of_one = sums[i] / paths[i];
        mean += of_one / r;
        mean2 += square(of_one);
        explained += paths[i] * square(of_one);
        inverse_paths += 1 / paths[i] / r;
        n += paths[i];
    }
    // One-way analysis of variance: between the realisations' means, less what the paths within a
    // realisation scatter them by.
    const double between = (mean2 - r * square(mean)) / (r - 1);
    const double within = (squares - explained) / (n - r);
    return between - within * inverse_paths;
}

PathTally::PathTally(const BsdfTable& table, size_t direction, size_t realisations, size_t groups)
    : bands_(table.bands.count()), groups_(groups), realisation_paths_(realisations) {
    const size_t bins = table.exits.bins();
    const ExitBins exits = table.exits_of(direction);
    solid_angle_.resize(2 * bins);
    for (size_t bin = 0; bin < 2 * bins; ++bin)
        solid_angle_[bin] = exits.solid_angle(bin % bins);
    sum_.assign(2 * bins * bands_, 0.0);
    sum_mean2_.assign(2 * bins, 0.0);
    quarter_.assign(2 * bins * 4, 0.0);
    if (realisations > 1)
        realisation_.assign(2 * bins * realisations, 0.0);
    unscattered_.assign(bands_, 0.0);
    capped_.assign(bands_, 0.0);
    lost_.assign(bands_, 0.0);
}

void PathTally::add(const PathBatch& batch, size_t dyes) {
    const size_t group_bands = bands_ / groups_, first_band = batch.group * group_bands;
    const size_t channels = batch.unscattered.size(), first_channel = dyes * group_bands;
    const size_t realisations = realisation_paths_.size();
    const float* weight = batch.weights.data() + first_channel;
    const uint32_t* quarter = batch.quarters.data();
    for (size_t realisation = 0; realisation < realisations; ++realisation) {
        realisation_paths_[realisation] += batch.paths[realisation];
        for (const uint32_t* end = quarter + batch.deposits[realisation]; quarter != end;
             ++quarter, weight += channels) {
            const size_t bin = *quarter / 4;
            double mean = 0;
            for (size_t band = 0; band < group_bands; ++band) {
                sum_[bin * bands_ + first_band + band] += weight[band];
                mean += weight[band];
            }
            mean /= static_cast<double>(bands_);
            sum_mean2_[bin] += square(mean);
            quarter_[*quarter] += mean;
            if (realisations > 1)
                realisation_[bin * realisations + realisation] += mean;
        }
    }
    for (size_t band = 0; band < group_bands; ++band) {
        unscattered_[first_band + band] += batch.unscattered[first_channel + band];
        capped_[first_band + band] += batch.capped[first_channel + band];
        lost_[first_band + band] += batch.lost[first_channel + band];
    }
    counts_ += batch.counts;
}

double PathTally::total() const {
    const double sum = std::accumulate(sum_.begin(), sum_.end(), 0.0);
    return sum / static_cast<double>(bands_ * paths());
}

double PathTally::scale() const {
    const double mean = total();
    return mean > 0 ? 4 * kPi / square(mean) : 0.0;
}

double PathTally::error_of_one_path() const {
    const double n = static_cast<double>(paths());
    if (n < 2)
        return 0;
    const size_t group_bands = bands_ / groups_;
    double variance = 0;
    for (size_t bin = 0; bin < solid_angle_.size(); ++bin) {
        // Groups of bands are traced apart, so that their variances add.
        double squared_means = 0;
        for (size_t group = 0; group < groups_; ++group) {
            const double* sums = &sum_[bin * bands_ + group * group_bands];
            const double sum = std::accumulate(sums, sums + group_bands, 0.0);
            squared_means += square(sum / (static_cast<double>(bands_) * n));
        }
        variance += (sum_mean2_[bin] / n - squared_means) * n / (n - 1) / solid_angle_[bin];
    }
    return scale() * std::max(variance, 0.0);
}

double PathTally::accuracy() const {
    return std::sqrt(error_of_one_path() / static_cast<double>(paths()));
}

double PathTally::bin_error() const {
    const double n = static_cast<double>(paths());
    if (n < 2)
        return 0;
    double change = 0;
    for (size_t bin = 0; bin < solid_angle_.size(); ++bin) {
        // Ω/4·Σ_q (Φ_q/(Ω/4) − Φ/Ω)² = (4·Σ_q Φ_q² − Φ²)/Ω. Of estimated fluxes its mean is larger
        // by (3·E[w²] − itself)/n, a path falling into one quarter alone.
        double flux = 0, squares = 0;
        for (size_t quarter = 4 * bin; quarter < 4 * bin + 4; ++quarter) {
            flux += quarter_[quarter] / n;
            squares += square(quarter_[quarter] / n);
        }
        change += (n * (4 * squares - square(flux)) - 3 * sum_mean2_[bin] / n) / (n - 1) /
                  solid_angle_[bin];
    }
    return std::sqrt(scale() * std::max(change, 0.0));
}

double PathTally::realisation_error() const {
    const size_t realisations = realisation_paths_.size();
    const double n = static_cast<double>(paths()), r = static_cast<double>(realisations);
    if (realisations < 2)
        return std::numeric_limits<double>::quiet_NaN();
    if (n < 2 * r)
        return 0;
    std::vector<double> paths_of(realisations);
    for (size_t i = 0; i < realisations; ++i)
        paths_of[i] = static_cast<double>(realisation_paths_[i]) / static_cast<double>(groups_);
    double spread = 0;
    for (size_t bin = 0; bin < solid_angle_.size(); ++bin)
        spread +=
            variance_between(std::span(realisation_).subspan(bin * realisations, realisations),
                             sum_mean2_[bin], paths_of) /
            solid_angle_[bin];
    return std::sqrt(scale() * std::max(spread, 0.0) / r);
}

void PathTally::write(Scattering& scattering, size_t direction) const {
    const double n = static_cast<double>(paths());
    const size_t bins = solid_angle_.size();
    std::vector<double> scattered(bands_, 0.0);
    for (size_t bin = 0; bin < bins; ++bin)
        for (size_t band = 0; band < bands_; ++band) {
            const double flux = sum_[bin * bands_ + band] / n;
            scattered[band] += flux;
            scattering.intensity[(direction * bins + bin) * bands_ + band] =
                static_cast<float>(flux / solid_angle_[bin]);
        }
    for (size_t band = 0; band < bands_; ++band) {
        const size_t i = direction * bands_ + band;
        const double unscattered = unscattered_[band] / n, capped = capped_[band] / n;
        scattering.unscattered[i] = static_cast<float>(unscattered);
        scattering.capped[i] = static_cast<float>(capped);
        scattering.lost[i] = static_cast<float>(lost_[band] / n);
        scattering.absorbed[i] =
            static_cast<float>(std::max(0.0, 1 - scattered[band] - unscattered - capped));
    }
    scattering.accuracy[direction] = static_cast<float>(accuracy());
    scattering.bin_error[direction] = static_cast<float>(bin_error());
    if (!scattering.realisation_error.empty())
        scattering.realisation_error[direction] = static_cast<float>(realisation_error());
}

namespace {

/// Lists of numbers, const or not, to be gone through one after the other.
template <class... Lists> auto lists_of(Lists&... lists) { return std::array{std::span(lists)...}; }

} // namespace

std::vector<double> PathTally::sums() const {
    std::vector<double> all;
    for (const auto list :
         lists_of(sum_, sum_mean2_, quarter_, realisation_, unscattered_, capped_, lost_))
        all.insert(all.end(), list.begin(), list.end());
    return all;
}

std::vector<uint64_t> PathTally::path_counts() const {
    std::vector<uint64_t> all{counts_.paths, counts_.events, counts_.overlaps, counts_.capped,
                              counts_.lost};
    all.insert(all.end(), realisation_paths_.begin(), realisation_paths_.end());
    return all;
}

void PathTally::restore(std::span<const double> sums, std::span<const uint64_t> path_counts) {
    if (sums.size() != this->sums().size() || path_counts.size() != this->path_counts().size())
        throw std::invalid_argument("a tally's sums are of another run");
    for (const auto list :
         lists_of(sum_, sum_mean2_, quarter_, realisation_, unscattered_, capped_, lost_)) {
        std::copy_n(sums.begin(), list.size(), list.begin());
        sums = sums.subspan(list.size());
    }
    counts_ = {path_counts[0], path_counts[1], path_counts[2], path_counts[3], path_counts[4]};
    std::copy(path_counts.begin() + 5, path_counts.end(), realisation_paths_.begin());
}

} // namespace rapport
