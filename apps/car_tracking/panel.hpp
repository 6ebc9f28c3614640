// The operator's panel: its buttons, pressed by a fixed plan.
#pragma once

#include "apps/car_tracking/geometry.hpp"
#include "kernel/component/component.hpp"

#include <array>

namespace tappet::car_tracking {

/// One press. Times count from the start.
struct Press {
    enum class Button : std::uint8_t {
        move_camera,
        start_calibration,
        start_localisation,
        stop_localisation
    };
    Duration at{};
    Button button = Button::move_camera;
    Aim aim{}; ///< of move_camera
};

/// Manual move, a start that is too early, calibration, tracking, a pause, tracking again.
inline constexpr std::array<Press, 7> day{{
    {1s, Press::Button::move_camera, {8.0, -4.0}},
    {2s, Press::Button::start_localisation, {}}, // too early: ignored before the calibration
    {3s, Press::Button::start_calibration, {}},
    {11s, Press::Button::start_localisation, {}},
    {40s, Press::Button::stop_localisation, {}},
    {43s, Press::Button::start_localisation, {}},
    {58s, Press::Button::stop_localisation, {}},
}};

/// Not real-time.
struct Panel {
    Event<Aim> move_camera;
    Event<> start_calibration, start_localisation, stop_localisation;

    void start(const Cycle& cycle) noexcept TAPPET_REALTIME {
        began_ = cycle.now;
        next_ = 0;
    }
    void work(const Cycle& cycle) {
        for (; next_ < day.size() && cycle.now - began_ >= day[next_].at; ++next_) press(day[next_]);
    }

    static constexpr auto interface() {
        return facets(event<&Panel::move_camera>("move_camera", "aim the camera by hand"),
                      event<&Panel::start_calibration>("start_calibration", "learn axes and lens"),
                      event<&Panel::start_localisation>("start_localisation", "follow the car"),
                      event<&Panel::stop_localisation>("stop_localisation", "stops following the car"));
    }

private:
    void press(const Press& press) {
        switch (press.button) {
        case Press::Button::move_camera: move_camera.emit(press.aim); break;
        case Press::Button::start_calibration: start_calibration.emit(); break;
        case Press::Button::start_localisation: start_localisation.emit(); break;
        case Press::Button::stop_localisation: stop_localisation.emit(); break;
        }
    }

    Time began_{};
    std::size_t next_ = 0;
};

} // namespace tappet::car_tracking
