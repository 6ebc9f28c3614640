// The component that tracks the car (thesis 5.4). Its behaviour is the script tracking.osd; this file holds
// the operations that the script calls.
#pragma once

#include "apps/car_tracking/geometry.hpp"
#include "kernel/component/component.hpp"
#include "kernel/component/operation_interface.hpp"

namespace tappet::car_tracking {

/// All real-time.
struct Tracking {
    static constexpr bool behaviour_required = true;

    Output<std::int64_t> misses;

    /// Returns the aim for the nth attempt to find a lost car: it scans the whole field, repeatedly.
    Aim search_place(std::int64_t attempt) noexcept TAPPET_REALTIME {
        const auto count = static_cast<std::int64_t>(places.size());
        return places[static_cast<std::size_t>(((attempt % count) + count) % count)];
    }

    void start(const Cycle&) noexcept TAPPET_REALTIME { misses.write(0); }

    static constexpr auto interface() {
        return facets(output<&Tracking::misses>("misses", "", "images in a row without the car"),
                      method<&Tracking::search_place>("search_place", "where to look for a lost car"));
    }

private:
    static constexpr std::array<Aim, 6> places{Aim{-30, -42}, Aim{0, -42}, Aim{30, -42},
                                               Aim{25, -30},  Aim{0, -30}, Aim{-25, -30}};
};

} // namespace tappet::car_tracking
