// main of every machine's plant on the bench, as tappet_machine() of CMake named table, plant and binding.
#include TAPPET_TABLE_HEADER
#include TAPPET_PLANT_HEADER
#include TAPPET_BOARD_HEADER
#include TAPPET_BINDINGS_HEADER

#include "toolchain/machine/bench/plant_program.hpp"

int main(int count, char** words) {
    return tappet::run_plant(
        TAPPET_NAMESPACE::table.view(), tappet::board::TAPPET_BOARD, TAPPET_NAMESPACE::bindings::TAPPET_BOARD,
        [](std::uint64_t seed) -> std::unique_ptr<tappet::Plant> {
            return std::make_unique<TAPPET_NAMESPACE::Plant>(seed);
        },
        count, words);
}
