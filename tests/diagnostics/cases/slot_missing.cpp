// A component that needs room for a loaded behaviour has none.
// refused: loom: component "weft": no slot is reserved for it; add behaviour("weft", slot(...)) to behaviours(...)
#include "tests/diagnostics/small_machine.hpp"

using namespace small;

struct Loaded {
    static constexpr bool slot_required = true;
    static constexpr auto interface() { return facets(); }
};
constexpr auto table = machine("loom", components(component<Loaded>("weft")),
                               activities(activity("all", every(1ms), budget(1us), runs("weft"))),
                               connections(), reactions(), behaviours());
template struct tappet::Firmware<table, good_board>;
