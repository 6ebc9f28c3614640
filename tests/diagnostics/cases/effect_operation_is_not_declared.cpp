// An operation is not declared TAPPET_REALTIME.
// refused by clang: OperationCall<&Valve::open_valve
#include "tests/diagnostics/small_machine.hpp"

using namespace small;

struct Valve {
    void open_valve() noexcept {}
    static constexpr auto interface() { return facets(operation<&Valve::open_valve>("open", "opens it")); }
};
constexpr auto valve = component_type<Valve>;
