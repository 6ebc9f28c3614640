// A Modbus server as a component, with a component that reads from it and writes to it.
#pragma once

#include "drivers/modbus/client.hpp"
#include "drivers/modbus/twin.hpp"
#include "tests/drivers/components/machine_rig.hpp"

namespace tappet::test {

inline constexpr auto registers =
    modbus::register_map(modbus::read("unit", modbus::input_registers(0, 2), modbus::every(100ms),
                                      modbus::word("temperature", 0).as_signed().times(0.1).in("degC"),
                                      modbus::word("pressure", 1).times(0.01).in("bar")),
                         modbus::write("pump", modbus::coils(0, 1), modbus::every(1s),
                                       modbus::stale_after(5s), modbus::bit("on", 0).safe(false)));

struct Reader {
    Input<double> temperature{};
    Input<bool> connected{};
    Input<std::int64_t> outages{};
    Input<std::int64_t> survived{};
    Output<double> pump{};
    int pump_next = -1;  // 0, 1: written in the next cycle
    Duration pump_age{}; // age of the written value
    int lost = 0, back = 0;
    Flow flow = Flow::never_written;
    std::uint64_t fresh = 0;
    Duration age{};
    double value = 0;

    void on_lost() noexcept TAPPET_REALTIME { ++lost; }
    void on_back() noexcept TAPPET_REALTIME { ++back; }
    void step(const Cycle& cycle) noexcept TAPPET_REALTIME {
        flow = temperature.read(value);
        fresh += flow == Flow::fresh ? 1u : 0u;
        age = cycle.now - temperature.stamp();
        if (pump_next >= 0) pump.write(pump_next, cycle.now - pump_age);
        pump_next = -1;
    }
    void stop(const Cycle& cycle) noexcept TAPPET_REALTIME {
        if (leaves_safe) pump.write(0, cycle.now - pump_age);
    }
    bool leaves_safe = true;
    static constexpr auto interface() {
        return facets(input<&Reader::temperature>("temperature", "degC", "of the hall"),
                      input<&Reader::connected>("connected", "", "the server answers"),
                      input<&Reader::outages>("outages", "", "of the server"),
                      input<&Reader::survived>("survived", "", "outages that ended"),
                      output<&Reader::pump>("pump", "", "shall run"),
                      operation<&Reader::on_lost>("on_lost", "the server is silent"),
                      operation<&Reader::on_back>("on_back", "the server answers again"));
    }
};
using Client = modbus::Client<registers>;

// clang-format off
template <class Server = Client, class... Pump>
constexpr auto machine_with(const Pump&... pump) {
    return machine("utility-machine",
        components(
            component<Server>("server", device("server")),
            component<Reader>("reader")),
        activities( // the reader stops first, so that its last value reaches the server
            activity("server", every(50ms), runs("server"), not_real_time),
            activity("reader", every(1ms), runs("reader"), budget(20us))),
        connections(
            data("server.unit.temperature", "reader.temperature", stale_after(500ms), hold),
            data("server.connected",        "reader.connected"),
            data("server.outages",          "reader.outages"),
            data("server.outages_survived", "reader.survived"),
            data("reader.pump",             "server.pump.on", pump...)),
        reactions(
            when("server.lost", tell("reader.on_lost")),
            when("server.back", tell("reader.on_back"))),
        behaviours());
}
inline constexpr auto utility_machine = machine_with();
inline constexpr auto machine_with_substitute = machine_with(stale_after(200ms), substitute(0.0));
inline constexpr auto machine_with_hold = machine_with(stale_after(200ms), hold);
// clang-format on

template <const auto& table>
struct UtilityOf : MachineRig<table> {
    UtilityOf() {
        twin.set(modbus::Table::input_registers, 0, static_cast<std::uint16_t>(-55)); // -5.5 degC
        this->template configure<modbus::Transport>("server", twin);
        reader = this->instance.template find<Reader>("reader");
        server = this->instance.template find<Client>("server");
    }
    void SetUp() override { this->run_until(1s); }
    void start_the_pump() {
        reader->pump_next = 1;
        this->run(1s);
        ASSERT_TRUE(pump_runs());
    }
    void change_server(LifeChange change) { this->change(0, change); }
    [[nodiscard]] bool pump_runs() const { return twin.get(modbus::Table::coils, 0) != 0; }

    modbus::Twin twin{300ms, 2ms};
    Reader* reader = nullptr;
    Client* server = nullptr;
};
using Utility = UtilityOf<utility_machine>;
using SubstitutedPump = UtilityOf<machine_with_substitute>;
using HeldPump = UtilityOf<machine_with_hold>;

} // namespace tappet::test
