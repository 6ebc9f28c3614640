// main of every machine's plant on the bench: at the other end of what its table is bound to there.
#include "toolchain/machine/on_board.hpp"

#include TAPPET_PLANT_HEADER

#include "toolchain/machine/bench/plant_program.hpp"

// Its ends are opened where the binding says: so it must fit here, too.
static_assert(TAPPET_NAMESPACE::OnBoard::accepted);

int main(int count, char** words) {
    return tappet::run_plant(
        TAPPET_NAMESPACE::view(), tappet::board::TAPPET_BOARD, TAPPET_BINDING,
        [](std::uint64_t seed) -> std::unique_ptr<tappet::Plant> {
            return std::make_unique<TAPPET_NAMESPACE::Plant>(seed);
        },
        count, words);
}
