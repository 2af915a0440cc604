#pragma once

#include <algorithm>
#include <functional>
#include <initializer_list>
#include <vector>

namespace rapport {

/// A number for each band, or one for all of them.
class PerBand {
  public:
    PerBand(double value) : values_{value} {}
    PerBand(std::vector<double> values) : values_(std::move(values)) {}
    PerBand(std::initializer_list<double> values) : values_(values) {}

    double operator[](size_t band) const { return values_[values_.size() == 1 ? 0 : band]; }
    /// One, or as many as there are bands.
    const std::vector<double>& values() const { return values_; }
    bool differs() const {
        return std::ranges::adjacent_find(values_, std::not_equal_to()) != values_.end();
    }

    bool operator==(const PerBand&) const = default;

  private:
    std::vector<double> values_;
};

} // namespace rapport
