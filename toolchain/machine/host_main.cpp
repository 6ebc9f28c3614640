// main of every machine's program on the host: one table with its plant, as named by tappet_machine() of
// CMake.
#include "toolchain/machine/host.hpp"
#include "toolchain/machine/on_host.hpp"

int main(int count, char** words) {
    namespace machine = TAPPET_NAMESPACE;
    return tappet::run_host(machine::on_host(), &machine::make_plant, count, words, machine::hooks_on_host());
}
