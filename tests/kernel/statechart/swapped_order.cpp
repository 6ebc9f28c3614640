// One transition, compiled and loaded: prints whether both execute their steps in the given order, as
// "program exit entry". It is built a second time with two steps of kernel/statechart/resolve.hpp exchanged:
// the order is defined only there, so both forms then use the other order (and order_test would detect it).
#include "kernel/statechart/native.hpp"

#include <iostream>
#include <string>

namespace tappet {
namespace {

struct Walker {
    std::string told;
    void tell(std::string_view what) {
        if (!told.empty()) told += ' ';
        told += what;
    }
    void program() noexcept TAPPET_REALTIME { TAPPET_ESCAPE("a test's notes are text", tell("program")); }
    void leave() noexcept TAPPET_REALTIME { TAPPET_ESCAPE("a test's notes are text", tell("exit")); }
    void enter() noexcept TAPPET_REALTIME { TAPPET_ESCAPE("a test's notes are text", tell("entry")); }
};
constexpr auto walk = state_machine<Walker>(
    "walk",
    states(state("a", initial, exit<&Walker::leave>), state("b", entry<&Walker::enter>), state("z", final)),
    transitions(transition("a", "b", on("go"), then<&Walker::program>), transition("b", "z", on("end"))));

std::string order_of(const StateMachineFast& fast) {
    Walker walker;
    StateMachineExecution machine;
    StateMachineBinding binding;
    binding.machine = resolved<walk>.view();
    binding.component = &walker;
    binding.fast = fast;
    if (!machine.bind(binding)) return "not bound";
    static_cast<void>(machine.activate({}));
    static_cast<void>(machine.dispatch(0, {}));
    return walker.told;
}

} // namespace
} // namespace tappet

int main(int count, char** arguments) {
    const std::string wanted = count == 2 ? arguments[1] : "";
    const std::string compiled = tappet::order_of(tappet::native_machine<tappet::walk>),
                      loaded = tappet::order_of({});
    std::cout << "compiled: " << compiled << "; loaded: " << loaded << '\n';
    return compiled == wanted && loaded == wanted ? 0 : 1;
}
