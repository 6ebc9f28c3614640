// The component that tracks the car (thesis 5.4): what its state machine asks of the camera and of the
// recognition, and what it must know to decide.
#pragma once

#include "apps/car_tracking/geometry.hpp"
#include "kernel/component/component.hpp"
#include "kernel/component/operation_interface.hpp"

namespace tappet::car_tracking {

/// All real-time. Its states are in tracking_cycle.hpp.
struct Tracking {
    static constexpr bool behaviour_required = true;

    CommandCall<> start_camera, stop_camera, start_recognition, stop_recognition;
    CommandCall<> calibrate, fetch_image, process_image;
    CommandCall<Aim> move_camera;
    MethodCall<Aim()> get_position;
    MethodCall<bool()> is_calibrated;
    MethodCall<bool()> car_located;
    MethodCall<Aim()> car_location;
    Event<> wanted_elsewhere;
    Output<std::int64_t> misses;

    void on_move_camera(Aim to) noexcept TAPPET_REALTIME {
        position_ = to;
        wanted_elsewhere.emit();
    }

    // Guards.
    [[nodiscard]] bool moved() noexcept TAPPET_REALTIME { return !in_flight(move_camera.state()); }
    [[nodiscard]] bool calibration_ended() noexcept TAPPET_REALTIME { return !in_flight(calibrate.state()); }
    [[nodiscard]] bool calibrated() noexcept TAPPET_REALTIME {
        return calibration_ended() && is_calibrated();
    }
    [[nodiscard]] bool fetched() noexcept TAPPET_REALTIME { return !in_flight(fetch_image.state()); }
    [[nodiscard]] bool processed() noexcept TAPPET_REALTIME { return !in_flight(process_image.state()); }
    [[nodiscard]] bool processed_without_car() noexcept TAPPET_REALTIME {
        return processed() && !car_located() && misses.last() < patience;
    }
    [[nodiscard]] bool stops_after_move() noexcept TAPPET_REALTIME { return moved() && stop_program_; }
    [[nodiscard]] bool stops() noexcept TAPPET_REALTIME { return stop_program_; }

    // Programs.
    void switch_on() noexcept TAPPET_REALTIME {
        static_cast<void>(start_camera.send());
        static_cast<void>(start_recognition.send());
    }
    void switch_off() noexcept TAPPET_REALTIME {
        static_cast<void>(stop_camera.send());
        static_cast<void>(stop_recognition.send());
    }
    void go_there() noexcept TAPPET_REALTIME { static_cast<void>(move_camera.send(position_)); }
    void begin_calibration() noexcept TAPPET_REALTIME { static_cast<void>(calibrate.send()); }
    void begin_localising() noexcept TAPPET_REALTIME {
        stop_program_ = false;
        misses.write(0);
    }
    void ask_to_stop() noexcept TAPPET_REALTIME { stop_program_ = true; }
    void fetch() noexcept TAPPET_REALTIME { static_cast<void>(fetch_image.send()); }
    void process() noexcept TAPPET_REALTIME { static_cast<void>(process_image.send()); }
    void count_miss() noexcept TAPPET_REALTIME { misses.write(misses.last() + 1); }
    void follow() noexcept TAPPET_REALTIME {
        if (car_located()) {
            misses.write(0);
            position_ = get_position() + car_location();
        } else {
            misses.write(misses.last() + 1);
            position_ = search_place(static_cast<int>(misses.last()));
        }
        go_there();
    }

    /// Where to look in the nth attempt to find a car that was lost: over the whole field, again and again.
    Aim search_place(int attempt) noexcept TAPPET_REALTIME {
        const auto count = static_cast<int>(places.size());
        return places[static_cast<std::size_t>(((attempt % count) + count) % count)];
    }

    void start(const Cycle&) noexcept TAPPET_REALTIME { misses.write(0); }

    // clang-format off
    static constexpr auto interface() {
        return facets(
            sends<&Tracking::start_camera>("start_camera", "camera on"),
            sends<&Tracking::stop_camera>("stop_camera", "camera off"),
            sends<&Tracking::start_recognition>("start_recognition", "recognition on"),
            sends<&Tracking::stop_recognition>("stop_recognition", "recognition off"),
            sends<&Tracking::calibrate>("calibrate", "learn axes and lens"),
            sends<&Tracking::fetch_image>("fetch_image", "take an image"),
            sends<&Tracking::process_image>("process_image", "look for the car in it"),
            sends<&Tracking::move_camera>("move_camera", "aim the camera"),
            calls<&Tracking::get_position>("get_position", "where the camera looks"),
            calls<&Tracking::is_calibrated>("is_calibrated", "axes and lens are known"),
            calls<&Tracking::car_located>("car_located", "the car is in the image"),
            calls<&Tracking::car_location>("car_location", "from where the camera looks to the car"),
            event<&Tracking::wanted_elsewhere>("wanted_elsewhere", "the camera is to be aimed by hand"),
            operation<&Tracking::on_move_camera>("on_move_camera", "where the camera is to be aimed"),
            output<&Tracking::misses>("misses", "", "images in a row without the car"),
            method<&Tracking::search_place>("search_place", "where to look for a lost car"));
    }
    // clang-format on

private:
    static constexpr std::int64_t patience = 3;
    static constexpr std::array<Aim, 6> places{Aim{-30, -42}, Aim{0, -42}, Aim{30, -42},
                                               Aim{25, -30},  Aim{0, -30}, Aim{-25, -30}};

    Aim position_{};
    bool stop_program_ = false;
};

} // namespace tappet::car_tracking
