// The values that a Modbus server receives while a port on the way to it is forced, and afterwards.
#include "tests/drivers/components/forced_port.hpp"
#include "tests/drivers/components/utility_machine.hpp"

namespace tappet::test {
namespace {

/// Forced at the input, then at the output; then the force is released, or its writer stops.
TEST_F(HeldPump, receives_a_stale_hidden_value_when_the_force_ends) {
    reader->leaves_safe = false;
    reader->pump_next = 0; // once
    run_until(2s);
    for (const auto& [name, kind] :
         {std::pair{"server.pump.on", FacetKind::input}, std::pair{"reader.pump", FacetKind::output}})
        for (const bool stops : {false, true}) {
            ForcedPort pump{instance, name, kind};
            pump.to(1.0);
            run(2s);
            EXPECT_TRUE(pump_runs());
            if (stops)
                change(1, LifeChange::stop);
            else
                pump.release();
            run(2s);
            EXPECT_FALSE(pump_runs()) << name << (stops ? ", stopped" : ", released");
            if (stops) static_cast<void>(world.change_activity(1, LifeChange::start));
        }
}

/// The pump's value is forced at one end.
struct ForcedPump : Utility {
    void begin(std::string_view name, FacetKind kind) {
        reader->pump_next = 0; // off, the only value that its component writes
        run_until(20s);
        pump.emplace(instance, name, kind).to(1.0);
        run_until(22s);
        ASSERT_TRUE(pump_runs());
    }
    std::optional<ForcedPort> pump;
};

TEST_F(ForcedPump, receives_the_hidden_value_whatever_its_age) {
    begin("server.pump.on", FacetKind::input);
    pump->release();
    run_until(24s);
    EXPECT_FALSE(pump_runs());
}

TEST_F(ForcedPump, receives_the_forced_value_again_after_a_long_outage) {
    begin("server.pump.on", FacetKind::input);
    twin.inject(modbus::Fault::down);
    run_until(32s); // longer than its row calls the value good
    twin.set(modbus::Table::coils, 0, 0);
    twin.inject(modbus::Fault::none);
    run_until(60s);
    EXPECT_TRUE(pump_runs());
}

TEST_F(ForcedPump, receives_the_hidden_value_when_its_writer_stops) {
    reader->leaves_safe = false;
    begin("reader.pump", FacetKind::output);
    change(1, LifeChange::stop);
    run_until(24s);
    EXPECT_FALSE(pump_runs());
}

/// A server that makes itself safe when nobody writes to it.
inline constexpr auto silent_registers = modbus::register_map(
    modbus::read("unit", modbus::input_registers(0, 1), modbus::every(100ms), modbus::word("temperature", 0)),
    modbus::write("pump", modbus::coils(0, 1), modbus::every(1s), modbus::stale_after(5s),
                  modbus::bit("on", 0))
        .safe_by_silence());
inline constexpr auto silent_machine = machine_with<modbus::Client<silent_registers>>();
struct SilentPump : UtilityOf<silent_machine> {};

TEST_F(SilentPump, does_not_receive_a_hidden_value_at_the_stop) {
    reader->leaves_safe = false;
    reader->pump_next = 0;
    run_until(2s);
    ForcedPort{instance, "server.pump.on", FacetKind::input}.to(0.0);
    run_until(4s);
    reader->pump_next = 1; // behind the force
    run_until(6s);
    ASSERT_FALSE(pump_runs());
    world.stop();
    EXPECT_FALSE(pump_runs());
}

/// Its pump runs, and is forced to something.
template <class Rig>
struct ForcedTo : Rig {
    void begin(double to) {
        this->reader->leaves_safe = false;
        this->reader->pump_next = 1;
        this->run_until(2s);
        force(to);
        this->run_until(4s);
        ASSERT_EQ(this->pump_runs(), to != 0);
    }
    void force(double to) { ForcedPort{this->instance, "server.pump.on", FacetKind::input}.to(to); }
};
using Forced = ForcedTo<Utility>;
using ForcedSilent = ForcedTo<SilentPump>;

TEST_F(ForcedSilent, follows_a_writer_that_restarts_between_two_cycles) {
    begin(1);
    change(1, LifeChange::stop);
    change(1, LifeChange::start);
    reader->pump_age = 20ms;
    reader->pump_next = 0;
    run_until(8s);
    EXPECT_FALSE(pump_runs());
}

TEST_F(ForcedSilent, follows_the_final_value_of_a_stop_whatever_its_time) {
    begin(1);
    reader->leaves_safe = true;
    reader->pump_age = 1s;
    change(1, LifeChange::stop);
    run_until(8s);
    EXPECT_FALSE(pump_runs());
}

TEST_F(ForcedSilent, follows_a_writer_that_was_stopped_twice) {
    begin(1);
    static_cast<void>(
        instance.life().ask_component(find_component(instance.machine().table, "reader"), LifeChange::stop));
    run_until(5s);
    force(1);
    run_until(6s);
    change(1, LifeChange::stop);
    change(1, LifeChange::start);
    reader->pump_next = 0;
    run_until(9s);
    EXPECT_FALSE(pump_runs());
}

TEST_F(ForcedSilent, does_not_receive_a_hidden_future_value_at_a_stop) {
    begin(0);
    reader->pump_age = -900ms;
    reader->pump_next = 1;
    run_until(4100ms);
    change(1, LifeChange::stop);
    run_until(8s);
    EXPECT_FALSE(pump_runs());
}

TEST_F(Forced, becomes_safe_after_a_stop_though_the_force_changed_nothing) {
    begin(1);
    change(1, LifeChange::stop);
    run_until(8s);
    EXPECT_FALSE(pump_runs());
}

TEST_F(Forced, receives_the_value_of_a_running_writer_when_its_client_restarts) {
    begin(0);
    change_server(LifeChange::stop);
    run_until(4100ms);
    EXPECT_FALSE(pump_runs());
    change_server(LifeChange::start);
    run_until(4500ms);
    EXPECT_TRUE(pump_runs());
}

/// The writer of the pump's value claims future times.
struct PumpAhead : Utility {
    PumpAhead() { reader->pump_age = -900ms; }
};

TEST_F(PumpAhead, switches_off_at_once) {
    reader->pump_next = 1;
    run_until(1100ms);
    ASSERT_TRUE(pump_runs());
    reader->pump_next = 0;
    run_until(1200ms);
    EXPECT_FALSE(pump_runs());
}

TEST_F(PumpAhead, receives_the_safe_value_of_a_stop_at_once) {
    reader->pump_next = 1;
    run_until(1100ms);
    ASSERT_TRUE(pump_runs());
    change(1, LifeChange::stop);
    run_until(1200ms);
    EXPECT_FALSE(pump_runs());
}

TEST_F(PumpAhead, expires_when_its_row_says_despite_a_future_time) {
    twin.inject(modbus::Fault::down);
    run_until(2800ms);
    reader->pump_next = 1; // good for 5 s
    run_until(8s);
    twin.inject(modbus::Fault::none);
    run_until(12s);
    EXPECT_FALSE(pump_runs());
}

} // namespace
} // namespace tappet::test
