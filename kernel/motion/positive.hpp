// Linear equations with a symmetric positive matrix of fixed size: Cholesky, without Eigen's heap allocation.
#pragma once

#include "kernel/base/realtime.hpp"

#include <Eigen/Core>

#include <cmath>

namespace tappet::motion {

/// Solves A X = B in place of B. Returns false, with B destroyed, when A is not positive definite to working
/// precision. Only the lower triangle of A is read. n3/6 + n2 k steps. Real-time.
template <int n, int k>
[[nodiscard]] bool solve_positive(Eigen::Matrix<double, n, n> a, Eigen::Matrix<double, n, k>& b) noexcept
    TAPPET_REALTIME {
    for (int j = 0; j < n; ++j) {
        double pivot = a(j, j);
        const double before = pivot;
        for (int i = 0; i < j; ++i) pivot -= a(j, i) * a(j, i);
        if (!(pivot > 1e-15 * before)) return false;
        a(j, j) = std::sqrt(pivot);
        for (int row = j + 1; row < n; ++row) {
            double sum = a(row, j);
            for (int i = 0; i < j; ++i) sum -= a(row, i) * a(j, i);
            a(row, j) = sum / a(j, j);
        }
    }
    for (int column = 0; column < k; ++column) {
        for (int row = 0; row < n; ++row) {
            double sum = b(row, column);
            for (int i = 0; i < row; ++i) sum -= a(row, i) * b(i, column);
            b(row, column) = sum / a(row, row);
        }
        for (int row = n - 1; row >= 0; --row) {
            double sum = b(row, column);
            for (int i = row + 1; i < n; ++i) sum -= a(i, row) * b(i, column);
            b(row, column) = sum / a(row, row);
        }
    }
    return true;
}

} // namespace tappet::motion
