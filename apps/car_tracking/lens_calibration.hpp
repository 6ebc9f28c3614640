// Learns a lens from images of one mark under several aims: Gauss-Newton over the mark's direction, the focal
// length and the distortion.
#pragma once

#include "apps/car_tracking/geometry.hpp"
#include "kernel/base/bounded.hpp"

namespace tappet::car_tracking {

struct MarkView {
    Aim aim{};
    Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
};

struct LensFit {
    Lens lens{};
    Aim mark{};
    double error_px = 0.0; ///< root mean square of the residuals of the fit, per coordinate
};

/// All real-time, bounded.
class LensCalibration {
public:
    static constexpr std::size_t most_views = 16;
    static constexpr std::size_t least_views = 6;

    void begin() noexcept TAPPET_REALTIME { views_.clear(); }
    void add(const MarkView& view) noexcept TAPPET_REALTIME { static_cast<void>(views_.push(view)); }

    /// Fits the lens from `guess`, wrong by 15 % at most, and from `mark`, wrong by 5 degrees at most.
    /// Returns nothing when there are too few views, or when they do not determine the lens.
    [[nodiscard]] std::optional<LensFit> fit(const Lens& guess, const Aim& mark) const noexcept
        TAPPET_REALTIME {
        if (views_.size() < least_views) return std::nullopt;
        Parameters at{mark.pan, mark.tilt, guess.focal_px, guess.k1};
        for (int i = 0; i < iterations; ++i) {
            Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
            Parameters slope = Parameters::Zero();
            for (const MarkView& view : views_)
                if (!add_view(view, at, normal, slope)) return std::nullopt;
            const double determinant = normal.determinant();
            if (!(std::abs(determinant) > 1e-9)) return std::nullopt;
            at -= normal.inverse() * slope;
        }
        double squares = 0.0;
        for (const MarkView& view : views_) {
            const auto left = residual(view, at);
            if (!left) return std::nullopt;
            squares += left->squaredNorm();
        }
        const double error = std::sqrt(squares / (2.0 * static_cast<double>(views_.size())));
        if (!(error < worst_error_px)) return std::nullopt;
        return LensFit{{at[2], at[3]}, {at[0], at[1]}, error};
    }

private:
    using Parameters = Eigen::Vector4d; // pan and tilt of the mark, focal length, k1
    static constexpr int iterations = 8;
    static constexpr double worst_error_px = 1.0;

    [[nodiscard]] static std::optional<Eigen::Vector2d> residual(const MarkView& view,
                                                                 const Parameters& at) noexcept
        TAPPET_REALTIME {
        const Eigen::Vector3d direction = axes_at({at[0], at[1]}).col(2);
        const Eigen::Vector3d ray = axes_at(view.aim).transpose() * direction;
        const auto pixel = pixel_of(ray, {at[2], at[3]});
        if (!pixel) return std::nullopt;
        return Eigen::Vector2d{*pixel - view.pixel};
    }
    /// Adds one view's part of the normal equations; the Jacobian is computed by finite differences.
    [[nodiscard]] static bool add_view(const MarkView& view, const Parameters& at, Eigen::Matrix4d& normal,
                                       Parameters& slope) noexcept TAPPET_REALTIME {
        const auto left = residual(view, at);
        if (!left) return false;
        Eigen::Matrix<double, 2, 4> slopes;
        for (int i = 0; i < 4; ++i) {
            Parameters beside = at;
            const double step = i < 2 ? 1e-3 : i == 2 ? 1e-2 : 1e-4;
            beside[i] += step;
            const auto there = residual(view, beside);
            if (!there) return false;
            slopes.col(i) = (*there - *left) / step;
        }
        normal += slopes.transpose() * slopes;
        slope += slopes.transpose() * *left;
        return true;
    }

    Bounded<MarkView, most_views> views_{};
};

} // namespace tappet::car_tracking
