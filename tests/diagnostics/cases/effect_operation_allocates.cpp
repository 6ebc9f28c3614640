// An operation allocates.
// refused by clang: void note_stop() noexcept
#include "tests/diagnostics/small_machine.hpp"

using namespace small;

struct Journal {
    double* entry = nullptr;
    void note_stop() noexcept TAPPET_REALTIME { entry = new double{1.0}; }
    static constexpr auto interface() {
        return facets(operation<&Journal::note_stop>("note_stop", "writes it down"));
    }
};
constexpr auto journal = component_type<Journal>;
