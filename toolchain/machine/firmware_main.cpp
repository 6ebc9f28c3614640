// main of every firmware: one table on one board.
#include "toolchain/machine/on_board.hpp"
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
    return tappet::run_firmware(TAPPET_NAMESPACE::OnBoard::machine(TAPPET_NAMESPACE::view()), hardware, count,
                                words, hooks);
}
