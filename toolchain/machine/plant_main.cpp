// main of every machine's plant on the bench: the other end of the wires to which its table is bound there.
#include TAPPET_BOARD_HEADER
#ifdef TAPPET_BINDINGS_HEADER
#include TAPPET_BINDINGS_HEADER
#endif

#include "toolchain/machine/bench/plant_program.hpp"
#include "toolchain/machine/code.hpp"
#include "toolchain/machine/on_host.hpp"

int main(int count, char** words) {
    namespace machine = TAPPET_NAMESPACE;
#ifdef TAPPET_BINDINGS_HEADER
    constexpr const tappet::Binding& binding = machine::bindings::TAPPET_BOARD;
#else
    constexpr const tappet::Binding& binding = tappet::unbound;
#endif
    return tappet::run_plant(machine::view(), tappet::board::TAPPET_BOARD, binding, &machine::make_plant,
                             count, words);
}
