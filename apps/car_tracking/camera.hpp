// The steerable camera (thesis 1.4, 5.4): takes images, aims as commanded, and learns the zeros of its axes
// and its lens. Its sensor and its head are devices of their own.
#pragma once

#include "apps/car_tracking/blob.hpp"
#include "apps/car_tracking/head_axis.hpp"
#include "apps/car_tracking/lens_calibration.hpp"
#include "kernel/component/component.hpp"
#include "kernel/exchange/data_object.hpp"

#include <atomic>

namespace tappet::car_tracking {

/// All real-time, in a periodic activity. Its commands come from one component at a time. It rejects a
/// command that does not fit its current action. While the head or the sensor is silent, nothing moves and
/// commands fail.
struct Camera {
    Input<Picture> picture;
    Input<bool> sensor_faulted;
    Input<std::int64_t> pan_counts, pan_index, pan_index_seen, tilt_counts, tilt_index, tilt_index_seen;
    Output<std::int64_t> drives_on;
    Output<double> pan_speed, tilt_speed;
    Output<Image> image;
    Output<Aim> aim;
    Output<Lens> lens;
    Output<double> calibration_error_px;
    Event<> image_ready;
    Property<Duration> exposure{16ms};
    Property<double> nominal_focal_px{150.0};
    Property<double> mark_pan{0.0};
    Property<double> mark_tilt{-27.0};

    // Commands.
    bool switch_on() noexcept TAPPET_REALTIME {
        is_on_ = true;
        return true;
    }
    bool switch_off() noexcept TAPPET_REALTIME {
        is_on_ = is_moving_ = is_fetching_ = false;
        phase_ = Phase::idle;
        return true;
    }
    /// Starts a move. Rejected while the camera moves, calibrates or is off, and for an aim out of reach.
    bool begin_move(const Aim& to) noexcept TAPPET_REALTIME {
        if (!is_free() || is_moving_ || !can_reach(to)) return false;
        go_to(to);
        return true;
    }
    CommandProgress moved() noexcept TAPPET_REALTIME {
        if (is_moving_) return CommandProgress::executing;
        return is_fit() ? CommandProgress::done : CommandProgress::failed;
    }
    /// Starts to take an image. Rejected while an image is being taken, during calibration, and while off.
    bool begin_fetch() noexcept TAPPET_REALTIME {
        if (!is_free() || is_fetching_) return false;
        await_image();
        return true;
    }
    CommandProgress fetched() noexcept TAPPET_REALTIME {
        if (is_fetching_) return CommandProgress::executing;
        return is_fit() ? CommandProgress::done : CommandProgress::failed;
    }
    /// Finds the index marks, then the mark under several aims. Fails when the marks cannot be seen.
    bool begin_calibration() noexcept TAPPET_REALTIME {
        if (!is_free() || is_moving_ || is_fetching_) return false;
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

    /// Keeps an earlier calibration.
    void start(const Cycle&) noexcept TAPPET_REALTIME {
        knows_head_ = false;
        steer();
        if (is_calibrated()) return;
        lens.write({nominal_focal_px.get(), 0.0});
        calibration_error_px.write(0.0);
    }
    void step(const Cycle& cycle) noexcept TAPPET_REALTIME {
        read_head(cycle.now);
        if (is_on_ && !is_fit()) give_up();
        if (is_on_ && phase_ == Phase::homing) home();
        steer();
        if (is_fetching_) take_image(cycle.now);
    }
    void stop(const Cycle&) noexcept TAPPET_REALTIME {
        static_cast<void>(switch_off());
        steer();
    }

    // clang-format off
    static constexpr auto interface() {
        return facets(
            input<&Camera::picture>("picture", "", "of the sensor, at the middle of its exposure"),
            input<&Camera::sensor_faulted>("sensor_faulted", "", "the sensor sends nothing"),
            input<&Camera::pan_counts>("pan_counts", "", "of the encoder"),
            input<&Camera::pan_index>("pan_index", "", "count of the index mark"),
            input<&Camera::pan_index_seen>("pan_index_seen", "", "1: the mark was passed since power-on"),
            input<&Camera::tilt_counts>("tilt_counts", "", "of the encoder"),
            input<&Camera::tilt_index>("tilt_index", "", "count of the index mark"),
            input<&Camera::tilt_index_seen>("tilt_index_seen", "", "1: the mark was passed since power-on"),
            output<&Camera::drives_on>("drives_on", "", "1: the motors turn, 0: they hold"),
            output<&Camera::pan_speed>("pan_speed", "deg/s", "wanted"),
            output<&Camera::tilt_speed>("tilt_speed", "deg/s", "wanted"),
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
            property<&Camera::exposure>("exposure", "s", "of an image: one that began before it was asked for is not taken", range(0.001, 0.1)),
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

    [[nodiscard]] bool is_fit() const noexcept TAPPET_REALTIME { return is_on_ && knows_head_ && sees_; }
    [[nodiscard]] bool is_free() const noexcept TAPPET_REALTIME { return is_fit() && phase_ == Phase::idle; }
    /// The current command fails.
    void give_up() noexcept TAPPET_REALTIME {
        is_moving_ = is_fetching_ = false;
        phase_ = Phase::idle;
    }
    void await_image() noexcept TAPPET_REALTIME {
        is_fetching_ = true;
        asked_at_ = never;
    }

    static bool read(HeadAxis& axis, Input<std::int64_t>& counts, Input<std::int64_t>& index,
                     Input<std::int64_t>& index_seen) noexcept TAPPET_REALTIME {
        axis.read({counts.get(), index_seen.get() != 0, index.get()});
        return counts.good() && index.good() && index_seen.good();
    }
    void read_head(Time now) noexcept TAPPET_REALTIME {
        const bool knew_head = knows_head_;
        knows_head_ = read(pan_, pan_counts, pan_index, pan_index_seen);
        knows_head_ = read(tilt_, tilt_counts, tilt_index, tilt_index_seen) && knows_head_;
        sees_ = !sensor_faulted.get();
        if (!knows_head_) return;
        if (!knew_head && !is_calibrated()) { // until the index marks are known, angles count from here
            pan_.call_it(0.0);
            tilt_.call_it(0.0);
        }
        const Aim here = aim_now();
        aim.write(here);
        shown_aim_.write(here);
        path_[steps_++ % path_.size()] = {now, here};
    }
    /// Returns where it looked at that time, as far back as images can be old.
    [[nodiscard]] Aim aim_at(Time time) const noexcept TAPPET_REALTIME {
        const Passed* nearest = &path_[0];
        for (const Passed& each : path_)
            if (std::chrono::abs(each.at - time) < std::chrono::abs(nearest->at - time)) nearest = &each;
        return nearest->aim;
    }
    /// Writes the speeds in each step: the head stops when they grow stale.
    void steer() noexcept TAPPET_REALTIME {
        const bool moves = is_on_ && is_moving_;
        drives_on.write(is_on_ ? 1 : 0);
        pan_speed.write(moves ? pan_.speed() : 0.0);
        tilt_speed.write(moves ? tilt_.speed() : 0.0);
        if (!moves) return;
        is_moving_ = !(pan_.arrived() && tilt_.arrived());
        if (is_moving_ || phase_ != Phase::turning_to_view) return;
        phase_ = Phase::taking_view;
        await_image();
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
        if (asked_at_ == never) asked_at_ = now;
        if (picture.read(frame_) != Flow::fresh) return;
        const Time taken = picture.stamp();
        if (taken - exposure.get() / 2 < asked_at_) return;
        frame_.aim = aim_at(taken);
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

    struct Passed {
        Time at{};
        Aim aim{};
    };

    HeadAxis pan_{}, tilt_{};
    DataObject<Aim> shown_aim_{};
    std::atomic<bool> is_calibrated_{false};
    bool is_on_ = false;
    bool is_moving_ = false;
    bool is_fetching_ = false;
    bool knows_head_ = false;
    bool sees_ = false;
    Phase phase_ = Phase::idle;
    std::size_t swing_ = 0;
    std::size_t view_ = 0;
    Time asked_at_{};               // since when an image is awaited; never: not yet noted
    std::array<Passed, 32> path_{}; // the last steps
    std::size_t steps_ = 0;
    Image frame_{};
    BlobFinder finder_{};
    LensCalibration calibration_{};
};

} // namespace tappet::car_tracking
