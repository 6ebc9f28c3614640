// A method is run on a component itself: nobody would ask whether the component runs.
// refused by name: GatedComponent
#include "tests/diagnostics/small_machine.hpp"

#include "kernel/component/operation_interface.hpp"

using namespace small;

struct Valve {
    bool open() noexcept TAPPET_REALTIME { return true; }
    static constexpr auto interface() { return facets(method<&Valve::open>("open", "opens it")); }
};
bool open(Valve& valve) noexcept {
    return component_type<Valve>.facets[0].method->call_packed(valve, Entry::at_once, nullptr, nullptr);
}
