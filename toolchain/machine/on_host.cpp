// The one place where the compiler accepts a machine's table for the host's board.
#include TAPPET_TABLE_HEADER

#include "toolchain/machine/on_host.hpp"
#include "board/host/board.hpp"
#include "kernel/machine/firmware.hpp"
#include "toolchain/machine/code.hpp"

namespace TAPPET_NAMESPACE {

tappet::AcceptedMachine on_host() { return tappet::Firmware<table, tappet::board::host>::machine(view()); }

} // namespace TAPPET_NAMESPACE
