// A check of properties that could change its component.
// refused: loom: component "horn": Horn::accepts looks like a life-cycle function but would never run; declare it public as "Sentence accepts(const Proposal&) const noexcept TAPPET_REALTIME", or rename it
#include "tests/diagnostics/small_machine.hpp"

using namespace small;

struct Horn {
    Sentence accepts(const Proposal&) noexcept TAPPET_REALTIME { return {}; }
    static constexpr auto interface() { return std::array<Facet, 0>{}; }
};

constexpr auto table =
    loom_with(component<Horn>("horn"), activity("noise", every(10ms), budget(10us), runs("horn")));
template struct tappet::Firmware<table, good_board, good_binding>;
