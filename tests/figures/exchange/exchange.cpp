// The cost of data flow between components (thesis 4.4.4), beside copies, bare loops, locks and the peers.
#include "tests/figures/exchange/exchange.hpp"
#include "tests/figures/exchange/iceoryx.hpp"

int main(int argc, char** argv) {
    using namespace tappet::figures;
    const Options options = read_options(argc, argv);
    Result result{.program = "exchange"};
    start_machine();
    // Only one RouDi may run on a host: a counting child leaves it to its parent, which measures.
    const std::string no_iceoryx = counting() ? "callgrind does not count it" : start_iceoryx();
    const bool with_iceoryx = no_iceoryx.empty();
    if (!with_iceoryx) result.notes.push_back("iceoryx was not measured: " + no_iceoryx);
    run_candidates(options, argv, one_core_groups(with_iceoryx), result);
    measure_two_cores(options, with_iceoryx, result);
    if (with_iceoryx) stop_iceoryx();
    return finish(options, result);
}
