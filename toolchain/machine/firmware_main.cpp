// main of every firmware: one table on one board, as tappet_machine() of CMake named them.
#include TAPPET_TABLE_HEADER
#include TAPPET_BOARD_HEADER
#ifdef TAPPET_BINDINGS_HEADER
#include TAPPET_BINDINGS_HEADER
#endif
#ifdef TAPPET_HOOKS_HEADER
#include TAPPET_HOOKS_HEADER
#endif

#include "drivers/hardware/hardware.hpp"
#include "kernel/os/heap.hpp"
#include "toolchain/machine/firmware.hpp"

TAPPET_HEAP_ARENA(tappet::board::TAPPET_BOARD.heap_bytes)

int main(int count, char** words) {
    static tappet::Hardware<TAPPET_NAMESPACE::table> hardware;
#ifdef TAPPET_HOOKS_HEADER
    constexpr tappet::FirmwareHooks hooks = TAPPET_NAMESPACE::firmware_hooks;
#else
    constexpr tappet::FirmwareHooks hooks;
#endif
    using Machine = tappet::Firmware<TAPPET_NAMESPACE::table, tappet::board::TAPPET_BOARD
#ifdef TAPPET_BINDINGS_HEADER
                                     ,
                                     TAPPET_NAMESPACE::bindings::TAPPET_BOARD
#endif
                                     >;
    return static_cast<int>(tappet::run_firmware(Machine::machine(), hardware, count, words, hooks));
}
