// Any bytes as lines that somebody types: an observer's lines change nothing; an engineer's lines are refused
// with a sentence or end, and the machine keeps running.
#include "tests/kernel/services/interpreter/line_machine.hpp"

#include "tests/fuzz/browsed_press.hpp"

#include <unistd.h>

namespace {

using namespace tappet;

using fuzz::demand;

struct Rig : press::BrowsedPress<press::line_table> {
    using BrowsedPress::BrowsedPress;

    /// Returns whether execution began.
    bool execute(std::string_view line, Role role) {
        auto& interpreter = *instance.find<CommandInterpreter>("interpreter");
        const LineFunctions& functions = CommandInterpreter::line_functions;
        LineRefusal refusal{};
        const Sentence fault = functions.begin(&interpreter, line, {role, Origin::local}, refusal);
        demand(fault.empty() == (refusal == LineRefusal::none));
        if (!fault.empty()) return false;
        for (int i = 0; i < 10 && functions.end(&interpreter) == nullptr; ++i) run(20ms);
        if (const LineEnd* const end = functions.end(&interpreter); end != nullptr)
            demand(end->why.empty() == (end->state == CommandState::done));
        functions.let_go(&interpreter);
        run(20ms); // serves posted requests
        return true;
    }
};

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const std::string directory = "/tmp/tappet-line-fuzz-" + std::to_string(getpid());
    static std::optional<Rig> rig;
    rig.emplace(directory);
    rig->run(50ms);
    const std::string_view line{reinterpret_cast<const char*>(data), size};
    const auto& gauge = *rig->instance.find<press::Gauge>("gauge");
    const auto& ram = *rig->instance.find<press::Ram>("ram");
    static_cast<void>(rig->execute(line, Role::observer));
    demand(gauge.zeroed == 0 && gauge.target.get() == 10 && gauge.steps.get() == 7);
    demand(ram.let_goes == 0 && ram.target == 0 && ram.strokes == 0 && ram.speed.get() == 1);
    static_cast<void>(rig->execute(line, Role::engineer));
    demand(ram.speed.get() * ram.force.get() <= 100 && gauge.target.get() >= 0 && gauge.target.get() <= 50);
    demand(rig->execute("gauge.force * 2", Role::observer));
    rig.reset();
    return 0;
}
