// A machine of two components that call and send to each other. Each fault in a use replaces its rows.
#pragma once

#include "tests/diagnostics/small_machine.hpp"

namespace small {

struct Press {
    bool close(double, int&) noexcept TAPPET_REALTIME { return true; }
    CommandProgress closed(double, int&) noexcept TAPPET_REALTIME { return CommandProgress::done; }
    bool open(int) noexcept TAPPET_REALTIME { return true; }
    double force(int) noexcept TAPPET_REALTIME { return 0.0; }
    int strokes(int) noexcept TAPPET_REALTIME { return 0; }
    void oil() noexcept TAPPET_REALTIME {}
    double weigh(int) noexcept { return 0.0; }
    static constexpr auto interface() {
        return facets(
            command<&Press::close, &Press::closed>("close", "with a force, in strokes"),
            command<&Press::open>("open", "so wide"),
            method<&Press::force>("force", "at a place", any_thread),
            method<&Press::strokes>("strokes", "of a tool"), operation<&Press::oil>("oil", "a drop"),
            method<&Press::weigh>("weigh", "on its scales, which answer late", any_thread, may_block));
    }
};

struct Desk {
    CommandCall<double, int&> close;
    MethodCall<double(int)> force;
    Event<> tired;
    static constexpr auto interface() {
        return facets(sends<&Desk::close>("close", "the press"), calls<&Desk::force>("force", "of the press"),
                      event<&Desk::tired>("tired", "of it"));
    }
};

template <std::size_t R>
constexpr auto pressing(const Section<ReactionRow, R>& rows) {
    return machine("mill",
                   components(component<Press>("press"), component<Desk>("desk"), component<Desk>("spare")),
                   activities(activity("motion", every(1ms), budget(100us), runs("press")),
                              activity("desk", every(10ms), budget(100us), runs("desk", "spare"))),
                   connections(), rows, behaviours());
}

inline constexpr Board mill_board{
    .name = "bench", .world = "bench", .memory_budget_bytes = 1'000'000, .processors = 1};

inline constexpr ReactionRow spare_close = uses("spare.close", "press.close");
inline constexpr ReactionRow spare_force = uses("spare.force", "press.force");
inline constexpr ReactionRow desk_close = uses("desk.close", "press.close");
inline constexpr ReactionRow desk_force = uses("desk.force", "press.force");

} // namespace small
