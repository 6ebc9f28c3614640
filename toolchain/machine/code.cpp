// The one object file that has the code of a machine's components: its table's rows lead to it.
#include TAPPET_TABLE_HEADER

#include "toolchain/machine/code.hpp"

namespace TAPPET_NAMESPACE {

tappet::MachineView view() { return table.view(); }

} // namespace TAPPET_NAMESPACE
