// The one place where the compiler accepts the loom's table for the host's board.
#include "apps/carpet_loom/host/loom_on_host.hpp"

#include "apps/carpet_loom/machine.hpp"
#include "board/host/board.hpp"

namespace tappet::carpet {

AcceptedMachine loom_on_host() { return Firmware<carpet_loom, board::host>::machine(); }

} // namespace tappet::carpet
