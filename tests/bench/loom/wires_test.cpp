// Disturbances that a weaving loom must ignore, and those that must stop it at once. One loom for all of
// these tests, in this order: a start takes seconds of the bench.
#include "tests/bench/loom/loom_rig.hpp"

#include <memory>

namespace tappet::bench {
namespace {

struct LoomWires : testing::Test {
    static void SetUpTestSuite() {
        // One test stops its process for a while; a guardian would end it.
        loom = std::make_unique<Loom>("", "--no-guardian");
        ASSERT_TRUE(loom->weaves()) << loom->machine->output();
    }
    static void TearDownTestSuite() { loom.reset(); }
    void SetUp() override {
        ASSERT_TRUE(loom && loom->machine->runs());
        loom->forget();
        ASSERT_TRUE(loom->weaves()) << loom->machine->output();
    }
    /// Weaves this many more picks, in its current state.
    static bool keeps_weaving(long picks) {
        const long from = loom->picks();
        return soon([&] { return loom->picks() >= from + picks; }) && loom->last("state") == "weave";
    }
    static inline std::unique_ptr<Loom> loom;
};

TEST_F(LoomWires, ignores_unmapped_frames_and_keeps_weaving) {
    loom->forget();
    for (const char* frame :
         {"183#0102", "183#0102030405060708", "181#00", "703#0000", "184#"}) // wrong lengths: counted
        ASSERT_EQ(run_foreign(std::string{"cansend can0 "} + frame), 0) << frame;
    for (const char* frame :
         {"7A5#DEADBEEF", "187#0102030405060708", // unknown identifiers
          "00000183#01020304", "00000703#00",
          "00000181#0800000000000000", // an extended frame's low bits are no standard identifier
          "183#R", "703#R"})           // a request carries no data
        ASSERT_EQ(run_foreign(std::string{"cansend can0 "} + frame), 0) << frame;
    ASSERT_EQ(run_foreign("cansend can0 205#01DC05"),
              0); // the machine's own identifier from another node: the feeder's usual command
    ASSERT_EQ(run_foreign("cangen can0 -e -g 1 -n 200 -L r"), 0);
    EXPECT_TRUE(keeps_weaving(5)) << loom->since();
    EXPECT_EQ(loom->last("bus"), "0");
    EXPECT_EQ(loom->since().find("the loom goes to"), std::string::npos) << loom->since();
}

TEST_F(LoomWires, survives_a_burst_of_edges_without_an_unreported_loss) {
    loom->forget();
    for (int i = 0; i < 100; ++i) {
        pull(wires::line::button_acknowledge, i % 2 == 0); // debounced: no press lasts long enough
        pull(wires::line::weft_detector, i % 2 == 0);      // the detector chatters, and ends without a weft
    }
    // A weft that seems early counts as missed: then the loom stops for it, which is right, too.
    EXPECT_TRUE(loom->weaves()) << loom->since();
    EXPECT_EQ(loom->last("edges_lost"), "0") << "the driver outruns whoever pulls a line";
}

TEST_F(LoomWires, stops_at_once_at_the_emergency_stop_and_counts_lost_edges) {
    Foreign listener{listen_to_the_machine};
    std::this_thread::sleep_for(100ms);
    const WallTime pressed = wall_now();
    pull(wires::line::emergency_stop, true);
    const bool safe = soon(is_safe, 100ms);
    const WallDuration took = std::chrono::duration_cast<WallDuration>(wall_now() - pressed);
    std::printf("emergency stop: brake on and valve closed at most %lld us after the line\n",
                static_cast<long long>(took.count()));
    EXPECT_TRUE(safe);
    EXPECT_LT(took, 5ms);
    EXPECT_TRUE(loom->says("the loom goes to \"emergency\": the emergency stop was pressed"))
        << loom->since();
    EXPECT_TRUE(loom->says("waits_for=emergency-stop"));
    listener.signal(SIGINT);
    listener.wait();
    const auto frames = frames_of(listener.output());
    const auto stop = std::find_if(frames.begin(), frames.end(), [](const Logged& f) {
        return f.id == wires::cob::main_drive_command && (f.word() & 0x06u) == 0x02u;
    });
    ASSERT_NE(stop, frames.end()) << "the drive's quick stop";
    EXPECT_LT(stop->at - pressed, 10ms);
    EXPECT_EQ(stop->target(), 0);

    // The whole firmware sleeps while the emergency stop bounces: more edges than the kernel keeps. The last
    // level counts.
    loom->machine->signal(SIGSTOP);
    constexpr int kept_by_the_kernel = 1024;
    for (int i = 0; i < kept_by_the_kernel + 201; ++i) pull(wires::line::emergency_stop, i % 2 != 0);
    loom->machine->signal(SIGCONT);
    EXPECT_TRUE(soon([] { return loom->last("edges_lost") != "0" && !loom->last("edges_lost").empty(); }))
        << loom->since();
    loom->forget();
    EXPECT_TRUE(soon([] { return loom->last("waits_for") != "emergency-stop"; }))
        << "the line has fallen, and the machine knows";
    EXPECT_TRUE(loom->weaves()) << loom->since();
}

TEST_F(LoomWires, leaves_safe_values_on_every_wire_at_its_stop) {
    Foreign listener{listen_to_the_machine};
    std::this_thread::sleep_for(100ms);
    ASSERT_EQ(loom->last("state"), "weave");
    loom->machine->signal(SIGTERM);
    EXPECT_TRUE(soon(is_safe, 1s)) << "brake on, valve closed, while it stops";
    EXPECT_EQ(loom->end(), 0) << loom->machine->output();
    EXPECT_NE(loom->machine->output().find("carpet-loom: stopped: requested from outside"),
              std::string::npos);
    EXPECT_FALSE(level(wires::line::weft_release));
    std::this_thread::sleep_for(50ms);
    listener.signal(SIGINT);
    listener.wait();
    const auto frames = frames_of(listener.output());
    for (const std::uint32_t id : {wires::cob::main_drive_command, wires::cob::let_off_drive_command}) {
        const auto last =
            std::find_if(frames.rbegin(), frames.rend(), [id](const Logged& f) { return f.id == id; });
        ASSERT_NE(last, frames.rend());
        EXPECT_FALSE(last->enables_operation()) << id;
        EXPECT_EQ(last->target(), 0) << id;
    }
    const auto first = std::find_if(frames.begin(), frames.end(), [](const Logged& f) {
        return f.id == wires::cob::main_drive_command && !f.enables_operation();
    });
    ASSERT_NE(first, frames.end());
    EXPECT_EQ(first->word() & 0x06u, 0x02u)
        << "a drive at speed gets its quick stop, it is not left to coast";

    EXPECT_EQ(number_in(loom->summary, "can.wrong_lengths"), 4); // the network judges heartbeats
    EXPECT_EQ(number_in(loom->summary, "can_impostors"), 1);
    EXPECT_EQ(number_in(loom->summary, "can_faults"), 0);
    EXPECT_GT(number_in(loom->summary, "gpio_edges_lost"), 0);
    EXPECT_EQ(number_in(loom->summary, "heap_allocations_after_arming"), 0);
    EXPECT_EQ(number_in(loom->summary, "page_faults_after_arming"), 0);
    loom->plant.signal(SIGTERM);
    loom->plant.wait();
    EXPECT_EQ(number_in(content_of(Loom::report_file), "total"), 0) << "damage to the loom:\n"
                                                                    << content_of(Loom::report_file);
}

} // namespace
} // namespace tappet::bench
