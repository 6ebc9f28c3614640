// main of every machine's plant on the bench, as tappet_machine() of CMake named table, plant and binding.
#include TAPPET_TABLE_HEADER
#include TAPPET_PLANT_HEADER
#include TAPPET_BOARD_HEADER
#ifdef TAPPET_BINDINGS_HEADER
#include TAPPET_BINDINGS_HEADER
#define TAPPET_BINDING TAPPET_NAMESPACE::bindings::TAPPET_BOARD
#else
#define TAPPET_BINDING tappet::unbound
#endif

#include "kernel/machine/firmware.hpp"
#include "toolchain/machine/bench/plant_program.hpp"

// Its ends are opened where the binding says: so it must fit here, too.
static_assert(
    tappet::Firmware<TAPPET_NAMESPACE::table, tappet::board::TAPPET_BOARD, TAPPET_BINDING>::accepted);

int main(int count, char** words) {
    return tappet::run_plant(
        TAPPET_NAMESPACE::table.view(), tappet::board::TAPPET_BOARD, TAPPET_BINDING,
        [](std::uint64_t seed) -> std::unique_ptr<tappet::Plant> {
            return std::make_unique<TAPPET_NAMESPACE::Plant>(seed);
        },
        count, words);
}
