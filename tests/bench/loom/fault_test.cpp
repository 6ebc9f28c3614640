// Faults that the loom must survive or end safely with: the bus goes off, the plant dies.
#include "tests/bench/loom/loom_rig.hpp"

namespace tappet::bench {
namespace {

constexpr const char* bus_off = "cansend can0 20000040#0000000000000000"; // as the controller reports it

TEST(LoomBus, becomes_safe_at_bus_off_and_weaves_again_after_an_acknowledgement) {
    Loom loom;
    Foreign listener{listen_to_the_machine};
    ASSERT_TRUE(loom.weaves()) << loom.machine->output();
    const long picks_before = loom.picks();

    loom.forget();
    ASSERT_EQ(run_foreign(bus_off), 0);
    EXPECT_TRUE(soon(is_safe, 100ms)) << "brake on, valve closed";
    EXPECT_TRUE(loom.says("the loom goes to \"fault\": the CAN bus is off")) << loom.since();
    EXPECT_TRUE(loom.says("state=fault"));

    // The operator presses when the lamp asks; the bus may not be back by then, and he presses again.
    WallTime acknowledged{};
    bool pressed = false;
    std::string told;
    EXPECT_TRUE(soon(
        [&] {
            const bool now_pressed = level(wires::line::button_acknowledge);
            if (now_pressed && !pressed) acknowledged = wall_now();
            pressed = now_pressed;
            if (!pressed) told = loom.since();
            return told.find("state=ready") != std::string::npos;
        },
        8s))
        << told;
    EXPECT_TRUE(loom.weaves()) << loom.since();
    EXPECT_EQ(loom.last("restarts"), "1");
    EXPECT_GE(loom.picks(), picks_before);
    EXPECT_EQ(loom.end(), 0) << loom.machine->output();

    listener.signal(SIGINT);
    listener.wait();
    const auto frames = frames_of(listener.output());
    const auto fault =
        std::find_if(frames.begin(), frames.end(), [](const Logged& f) { return f.id == 0x20000040; });
    ASSERT_NE(fault, frames.end());
    const auto again = std::find_if(fault + 1, frames.end(), [&](const Logged& f) {
        return f.at > fault->at + 2ms;
    }); // frames that were in the controller already
    ASSERT_NE(again, frames.end());
    EXPECT_GE(again->at - fault->at, 900ms) << "a deliberate restart comes after a pause";
    int early = 0;
    int commands = 0;
    // The press was seen at most one poll after it happened: some milliseconds.
    for (auto f = again; f != frames.end() && f->at < acknowledged - 3ms; ++f) {
        if (f->id != wires::cob::main_drive_command && f->id != wires::cob::let_off_drive_command) continue;
        ++commands;
        early += f->enables_operation() || f->target() != 0;
    }
    EXPECT_EQ(early, 0) << "before the acknowledge nothing is enabled or turned";
    EXPECT_GT(commands, 0) << "the drives hear the machine again before the acknowledge";
    EXPECT_EQ(number_in(loom.summary, "can_faults"), 1);
    EXPECT_EQ(number_in(loom.summary, "can_restarts"), 1);
    expect_undisturbed(loom);
}

TEST(LoomBus, becomes_safe_when_the_plant_dies_and_can_still_be_stopped) {
    Loom loom;
    ASSERT_TRUE(loom.weaves()) << loom.machine->output();
    loom.forget();
    loom.plant.signal(SIGKILL);
    EXPECT_TRUE(soon(is_safe, 200ms)) << "brake on, valve closed";
    EXPECT_TRUE(loom.says("state=fault")) << loom.since();
    EXPECT_NE(loom.since().find("encoder"), std::string::npos) << loom.since(); // the awaited part
    EXPECT_NE(loom.machine->output().find("the loom goes to \"fault\": the encoder is stale"),
              std::string::npos)
        << loom.machine->output();
    std::this_thread::sleep_for(500ms);
    EXPECT_TRUE(is_safe()) << "and stays so";
    EXPECT_TRUE(loom.machine->runs());
    EXPECT_EQ(loom.end(), 0);
    expect_undisturbed(loom);
}

} // namespace
} // namespace tappet::bench
