// main of every machine's swarm: one table with its plant, and its own rules if it has some, as named by
// tappet_machine() of CMake.
#ifdef TAPPET_SWARM_HEADER
#include TAPPET_PLANT_HEADER
#include TAPPET_SWARM_HEADER
#endif

#include "toolchain/machine/on_host.hpp"
#include "toolchain/machine/swarm.hpp"

int main(int count, char** words) {
    namespace machine = TAPPET_NAMESPACE;
    tappet::SwarmOf of{machine::on_host(), &machine::make_plant, {}};
#ifdef TAPPET_SWARM_HEADER
    of.rules = [](tappet::MachineInstance& instance, tappet::Plant& plant,
                  const tappet::Struck& struck) -> std::unique_ptr<tappet::SwarmRules> {
        return std::make_unique<machine::Swarm>(instance, static_cast<machine::Plant&>(plant), struck);
    };
#endif
    return tappet::run_swarm(of, count, words);
}
