// The one object file with the code of a machine's components: its table's rows refer to it.
#include TAPPET_TABLE_HEADER

#include "toolchain/machine/code.hpp"

namespace TAPPET_NAMESPACE {

tappet::MachineView view() {
    tappet::MachineView machine = table.view();
#ifdef TAPPET_EFFECTS_CHECKED
    machine.effects_checked = true;
#endif
    return machine;
}

} // namespace TAPPET_NAMESPACE
