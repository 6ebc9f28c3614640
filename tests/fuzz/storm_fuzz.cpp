// Any bytes as simultaneous requests of three browsers to a machine with behaviours, a slot and lines: a
// line's first character selects the browser, the rest is its request, and an empty line lets time pass. Each
// answer is one object, each property stays within the limits of its component, the count of forced ports is
// right, and in the end a single request is served.
#include "tests/fuzz/browsed_press.hpp"

#include "kernel/services/interpreter/command_interpreter.hpp"

#include <unistd.h>

namespace {

using namespace tappet;
using press::Browser, press::demand;

struct RamCycle {
    static constexpr auto machine() {
        return state_machine<press::Ram>(
            "cycle", states(state("up", initial), state("down"), state("held"), state("safe", final)),
            transitions(transition("up", "down", on("arrived")), transition("down", "up", on("arrived")),
                        transition("down", "held", guard<&press::Ram::may_hold>),
                        transition("held", "up", on("arrived"))));
    }
};
constexpr auto cycle = RamCycle::machine();

// clang-format off
constexpr auto table = machine("press",
    components(component<press::Ram>("ram"), component<press::Table>("table"),
               component<BrowserService>("browser", set("log", false)), component<CommandInterpreter>("interpreter")),
    activities(
        activity("motion",  every(1ms), budget(50us), runs("ram")),
        activity("slow",    every(10ms), budget(50us), runs("table")),
        activity("browser", every(20ms), not_real_time, stack(256 * 1024), runs("browser", "interpreter"))),
    connections(data("table.height", "ram.limit", stale_after(1s), hold)),
    reactions(),
    behaviours(behaviour("ram", cycle),
               behaviour("ram", slot(nodes(60), data_bytes(512), depth(3), command_slots(1), timers(4), trial(1)))));
// clang-format on

using Rig = press::BrowsedPress<table>;

/// Commands and lines may take any time; the machine gets that many cycles to answer afterwards.
constexpr int patience = 400;

void demand_to_be_served(Rig& rig, const std::string& path) {
    Browser one;
    for (int tries = 0; tries < patience; ++tries) {
        if (!one.connection) one.connect(path);
        if (one.connection) static_cast<void>(one.connection->send("1 get table.height"));
        rig.run(50ms);
        one.hear();
        if (one.last.find("\"value\"") != std::string::npos) return;
    }
    demand(false);
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const std::string directory = "/tmp/tappet-storm-fuzz-" + std::to_string(getpid());
    static const std::string path = directory + "/press.socket";
    static std::optional<Rig> rig;
    rig.emplace(directory);
    {
        std::array<Browser, 3> browsers;
        for (Browser& each : browsers) each.connect(path);
        std::string_view rest{reinterpret_cast<const char*>(data), size};
        for (int lines = 0; !rest.empty() && lines < 200; ++lines) {
            const std::string_view line = press::next_line(rest);
            if (line.size() < 2) {
                rig->run(20ms);
                for (Browser& each : browsers) each.hear();
                rig->check();
                continue;
            }
            Browser& by = browsers[static_cast<unsigned char>(line.front()) % browsers.size()];
            if (!by.connection) by.connect(path);
            if (by.connection) static_cast<void>(by.connection->send(line.substr(1)));
        }
        rig->run(1s);
        for (Browser& each : browsers) each.hear();
        rig->check();
        demand_to_be_served(*rig, path);
    }
    rig.reset();
    return 0;
}
