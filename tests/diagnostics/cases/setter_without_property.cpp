// A setter of a property that the interface does not have: nothing would say its range.
// refused by name: a setter names a property that stands in its component's interface()
#include "kernel/component/component.hpp"

using namespace tappet;

struct Pump {
    Property<double> limit{4.0};
    static constexpr auto interface() { return facets(setter<&Pump::limit>("set_limit", "by a peer")); }
};
bool set(std::byte* values, GatedComponent& pump) noexcept TAPPET_REALTIME {
    return component_type<Pump>.facets[0].command->begin(pump, values);
}
