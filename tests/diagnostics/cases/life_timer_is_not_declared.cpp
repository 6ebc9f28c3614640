// The function that a timer runs may throw.
// refused by name: a timer runs a member function void f(const Cycle&), declared noexcept TAPPET_REALTIME
#include "tests/diagnostics/small_machine.hpp"

using namespace small;

struct Clock {
    Timer hour;
    void strike(const Cycle&) {}
    static constexpr auto interface() {
        return facets(timer<&Clock::hour, &Clock::strike>("hour", "the next stroke"));
    }
};
constexpr auto clock_type = component_type<Clock>;
