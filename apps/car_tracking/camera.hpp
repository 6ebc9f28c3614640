// The steerable camera (thesis 1.4, 5.4): takes images, aims as commanded, and learns the zeros of its axes
// and its lens.
#pragma once

#include "apps/car_tracking/blob.hpp"
#include "apps/car_tracking/camera_device.hpp"
#include "apps/car_tracking/head_axis.hpp"
#include "apps/car_tracking/lens_calibration.hpp"
#include "kernel/component/component.hpp"
#include "kernel/exchange/data_object.hpp"

#include <atomic>

namespace tappet::car_tracking {

/// All real-time, in a periodic activity. Its commands come from one component at a time. It rejects a
/// command that does not fit its current action.
struct Camera {
    static constexpr DeviceKind device_kind{.name = "camera"};

    Output<Image> image;
    Output<Aim> aim;
    Output<Lens> lens;
    Output<double> calibration_error_px;
    Event<> image_ready;
    Property<double> refresh_hz{25.0};
    Property<Duration> exposure{16ms};
    Property<double> nominal_focal_px{150.0};
    Property<double> mark_pan{0.0};
    Property<double> mark_tilt{-27.0};

    // Commands.
    bool switch_on() noexcept TAPPET_REALTIME {
        device_->switch_on(true);
        is_on_ = true;
        return true;
    }
    bool switch_off() noexcept TAPPET_REALTIME {
        device_->turn(0.0, 0.0);
        device_->switch_on(false);
        is_on_ = is_moving_ = is_fetching_ = false;
        phase_ = Phase::idle;
        return true;
    }
    /// Starts a move. Rejected while the camera moves, calibrates or is off, and for an aim out of reach.
    bool begin_move(const Aim& to) noexcept TAPPET_REALTIME {
        if (!is_on_ || is_moving_ || phase_ != Phase::idle || !can_reach(to)) return false;
        go_to(to);
        return true;
    }
    CommandProgress moved() noexcept TAPPET_REALTIME {
        if (is_moving_) return CommandProgress::executing;
        return is_on_ ? CommandProgress::done : CommandProgress::failed;
    }
    /// Starts to take an image. Rejected while an image is being taken, during calibration, and while off.
    bool begin_fetch() noexcept TAPPET_REALTIME {
        if (!is_on_ || is_fetching_ || phase_ != Phase::idle) return false;
        is_fetching_ = true;
        is_exposed_ = false;
        return true;
    }
    CommandProgress fetched() noexcept TAPPET_REALTIME {
        if (is_fetching_) return CommandProgress::executing;
        return is_on_ ? CommandProgress::done : CommandProgress::failed;
    }
    /// Finds the index marks, then the mark under several aims. Fails when the marks cannot be seen.
    bool begin_calibration() noexcept TAPPET_REALTIME {
        if (!is_on_ || is_moving_ || is_fetching_ || phase_ != Phase::idle) return false;
        is_calibrated_.store(false, std::memory_order_relaxed);
        pan_.call_it(0.0);
        tilt_.call_it(0.0);
        swing_ = 0;
        phase_ = Phase::homing;
        go_to(home_swings[0]);
        return true;
    }
    CommandProgress calibrated() noexcept TAPPET_REALTIME {
        if (phase_ != Phase::idle) return CommandProgress::executing;
        return is_calibrated() ? CommandProgress::done : CommandProgress::failed;
    }

    // Methods, safe from any thread.
    /// Returns the aim that the camera believes to have.
    Aim get_position() const noexcept TAPPET_REALTIME {
        Aim now{};
        std::uint64_t generation = 0;
        static_cast<void>(shown_aim_.read(now, generation));
        return now;
    }
    bool is_calibrated() const noexcept TAPPET_REALTIME {
        return is_calibrated_.load(std::memory_order_relaxed);
    }

    Sentence configure(Setup& setup) {
        device_ = setup.device<CameraDevice>();
        return device_ == nullptr ? setup.no_device() : Sentence{};
    }
    /// Keeps an earlier calibration.
    void start(const Cycle&) noexcept TAPPET_REALTIME {
        read_head();
        if (is_calibrated()) return;
        lens.write({nominal_focal_px.get(), 0.0});
        calibration_error_px.write(0.0);
        pan_.call_it(0.0); // until the index marks are known, angles count from the present position
        tilt_.call_it(0.0);
        read_head();
    }
    void step(const Cycle& cycle) noexcept TAPPET_REALTIME {
        read_head();
        if (!is_on_) return;
        if (phase_ == Phase::homing) home();
        steer();
        take_image(cycle.now);
    }
    void stop(const Cycle&) noexcept TAPPET_REALTIME { static_cast<void>(switch_off()); }

    // clang-format off
    static constexpr auto interface() {
        return facets(
            output<&Camera::image>("image", "", "the last image"),
            output<&Camera::aim>("aim", "", "where it looks, as far as it knows"),
            output<&Camera::lens>("lens", "", "nominal until it is calibrated; written on change"),
            output<&Camera::calibration_error_px>("calibration_error_px", "px", "residual error of the last calibration"),
            event<&Camera::image_ready>("image_ready", "a new image is available"),
            command<&Camera::switch_on>("start", "power on"),
            command<&Camera::switch_off>("stop", "motors and sensor off"),
            command<&Camera::begin_move, &Camera::moved>("move_camera", "moves to an aim and stops there"),
            command<&Camera::begin_fetch, &Camera::fetched>("fetch_image", "takes one image"),
            command<&Camera::begin_calibration, &Camera::calibrated>("calibrate", "learns the axes' zero and the lens"),
            method<&Camera::get_position>("get_position", "where it looks, as far as it knows", any_thread),
            method<&Camera::is_calibrated>("is_calibrated", "the last calibration was good", any_thread),
            property<&Camera::refresh_hz>("refresh_hz", "1/s", "images a second at most", range(1, 100)),
            property<&Camera::exposure>("exposure", "s", "of an image", range(0.001, 0.1)),
            property<&Camera::nominal_focal_px>("nominal_focal_px", "px", "focal length by the lens' data sheet", range(50, 500)),
            property<&Camera::mark_pan>("mark_pan", "deg", "where the calibration mark is, roughly", range(-40, 40)),
            property<&Camera::mark_tilt>("mark_tilt", "deg", "where the calibration mark is, roughly", range(-60, 0)));
    }
    // clang-format on

private:
    enum class Phase : std::uint8_t { idle, homing, turning_to_view, taking_view };
    static constexpr std::array<Aim, 2> home_swings{Aim{25.0, 25.0}, Aim{-25.0, -25.0}};
    static constexpr std::array<Aim, 9> views{Aim{0, 0},     Aim{18, 0},   Aim{-18, 0},
                                              Aim{0, 13},    Aim{0, -13},  Aim{17, 12},
                                              Aim{-17, -12}, Aim{17, -12}, Aim{-17, 12}};

    static bool can_reach(const Aim& to) noexcept TAPPET_REALTIME {
        return std::abs(to.pan) <= 80.0 && to.tilt >= -85.0 && to.tilt <= 30.0; // false for not-a-number
    }
    [[nodiscard]] Aim aim_now() const noexcept TAPPET_REALTIME { return {pan_.angle(), tilt_.angle()}; }
    void go_to(const Aim& to) noexcept TAPPET_REALTIME {
        pan_.go_to(to.pan);
        tilt_.go_to(to.tilt);
        is_moving_ = true;
    }

    void read_head() noexcept TAPPET_REALTIME {
        const HeadReading head = device_->head();
        pan_.read(head.pan);
        tilt_.read(head.tilt);
        aim.write(aim_now());
        shown_aim_.write(aim_now());
    }
    void steer() noexcept TAPPET_REALTIME {
        if (!is_moving_) return;
        device_->turn(pan_.speed(), tilt_.speed());
        is_moving_ = !(pan_.arrived() && tilt_.arrived());
        if (is_moving_ || phase_ != Phase::turning_to_view) return;
        phase_ = Phase::taking_view;
        is_fetching_ = true;
        is_exposed_ = false;
    }

    /// Swings both axes to either side until both index marks were passed.
    void home() noexcept TAPPET_REALTIME {
        if (pan_.is_index_seen() && tilt_.is_index_seen()) {
            static_cast<void>(pan_.take_index(index_marks.pan));
            static_cast<void>(tilt_.take_index(index_marks.tilt));
            calibration_.begin();
            view_ = 0;
            phase_ = Phase::turning_to_view;
            go_to(mark() + views[0]);
        } else if (!is_moving_) {
            if (++swing_ == home_swings.size()) {
                phase_ = Phase::idle; // an index mark is missing
                return;
            }
            go_to(home_swings[swing_]);
        }
    }
    [[nodiscard]] Aim mark() const noexcept TAPPET_REALTIME { return {mark_pan.get(), mark_tilt.get()}; }

    void take_image(Time now) noexcept TAPPET_REALTIME {
        if (!is_fetching_) return;
        if (!is_exposed_) {
            if (now - exposed_at_ < Duration{static_cast<std::int64_t>(1e9 / refresh_hz.get())}) return;
            if (!device_->expose(exposure.get())) return;
            is_exposed_ = true;
            exposed_at_ = now;
            aim_then_ = aim_now();
            return;
        }
        Time taken{};
        if (!device_->take(frame_, taken)) return;
        frame_.aim = aim_then_;
        is_fetching_ = false;
        if (phase_ == Phase::taking_view) {
            look_at_mark();
            return;
        }
        image.write(frame_, taken);
        image_ready.emit();
    }

    /// Finds the mark: it is the white spot.
    void look_at_mark() noexcept TAPPET_REALTIME {
        const auto blobs = finder_.find(frame_, [](const Colour& c) noexcept TAPPET_REALTIME {
            const int least =
                std::min({static_cast<int>(c.red), static_cast<int>(c.green), static_cast<int>(c.blue)});
            return std::max(0, least - 176); // brighter than any floor
        });
        const Blob* best = nullptr;
        for (const Blob& blob : blobs)
            if (blob.pixels >= 4 && (best == nullptr || blob.weight > best->weight)) best = &blob;
        if (best != nullptr && !best->touches_border()) calibration_.add({frame_.aim, best->centre()});
        if (++view_ < views.size()) {
            phase_ = Phase::turning_to_view;
            go_to(mark() + views[view_]);
            return;
        }
        phase_ = Phase::idle;
        const auto fit = calibration_.fit({nominal_focal_px.get(), 0.0}, mark());
        if (!fit) return;
        lens.write(fit->lens);
        calibration_error_px.write(fit->error_px);
        is_calibrated_.store(true, std::memory_order_relaxed);
    }

    CameraDevice* device_ = nullptr;
    HeadAxis pan_{}, tilt_{};
    DataObject<Aim> shown_aim_{};
    std::atomic<bool> is_calibrated_{false};
    bool is_on_ = false;
    bool is_moving_ = false;
    bool is_fetching_ = false;
    bool is_exposed_ = false; // the image that is being fetched
    Phase phase_ = Phase::idle;
    std::size_t swing_ = 0;
    std::size_t view_ = 0;
    Time exposed_at_{};
    Aim aim_then_{};
    Image frame_{};
    BlobFinder finder_{};
    LensCalibration calibration_{};
};

} // namespace tappet::car_tracking
