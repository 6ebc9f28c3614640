// A step is not declared TAPPET_REALTIME, and its body cannot be seen.
// refused by clang: must not call non-'nonblocking' function 'Hidden::step'
#include "tests/diagnostics/small_machine.hpp"

using namespace small;

struct Hidden {
    void step(const Cycle&) noexcept;
    static constexpr auto interface() { return std::array<Facet, 0>{}; }
};
constexpr auto hidden = component_type<Hidden>;
