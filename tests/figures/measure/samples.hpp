// A set of measured values and its summary.
#pragma once

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

namespace tappet::figures {

/// The summary of a row's samples, in the figure's unit.
struct Summary {
    double median = 0, mean = 0, p99 = 0, p999 = 0, max = 0;
    std::size_t count = 0;
};
/// Summary of a value that is known without measuring, or was found once.
constexpr Summary single(double value) { return {value, value, value, value, value, 1}; }

class Samples {
public:
    void reserve(std::size_t count) { values_.reserve(count); }
    void add(double value) {
        values_.push_back(value);
        sorted_ = false;
    }
    void add(const Samples& more) {
        values_.insert(values_.end(), more.values_.begin(), more.values_.end());
        sorted_ = false;
    }
    [[nodiscard]] std::size_t count() const { return values_.size(); }
    [[nodiscard]] bool empty() const { return values_.empty(); }
    /// The order is meaningless after quantile() was called.
    [[nodiscard]] const std::vector<double>& values() const { return values_; }
    /// The smallest value that at least the share `q` of the samples does not exceed; 0 without samples.
    [[nodiscard]] double quantile(double q) const {
        if (values_.empty()) return 0;
        sort();
        const auto last = static_cast<double>(values_.size() - 1);
        return values_[static_cast<std::size_t>(std::clamp(q, 0.0, 1.0) * last + 0.5)];
    }
    [[nodiscard]] double median() const { return quantile(0.5); }
    [[nodiscard]] double mean() const {
        return values_.empty() ? 0
                               : std::accumulate(values_.begin(), values_.end(), 0.0) /
                                     static_cast<double>(values_.size());
    }
    [[nodiscard]] double max() const { return quantile(1); }
    [[nodiscard]] Summary summary() const {
        return {median(), mean(), quantile(0.99), quantile(0.999), max(), count()};
    }

private:
    void sort() const {
        if (sorted_) return;
        std::sort(values_.begin(), values_.end());
        sorted_ = true;
    }
    mutable std::vector<double> values_;
    mutable bool sorted_ = false;
};

} // namespace tappet::figures
