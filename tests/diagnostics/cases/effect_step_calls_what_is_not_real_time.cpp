// A step calls a function that is not declared real-time.
// refused by clang: must not call non-'nonblocking' function 'read_configuration_file'
#include "tests/diagnostics/small_machine.hpp"

using namespace small;

double read_configuration_file();

struct Reader {
    double value = 0;
    void step(const Cycle&) noexcept TAPPET_REALTIME { value = read_configuration_file(); }
    static constexpr auto interface() { return std::array<Facet, 0>{}; }
};
constexpr auto reader = component_type<Reader>;
