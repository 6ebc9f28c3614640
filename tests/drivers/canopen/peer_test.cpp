// Our manager against a foreign device, a foreign client against our simulated node, and our reader of a
// device's file against a foreign one.
#include "tests/drivers/canopen/network_machine.hpp"
#include "tests/drivers/canopen/peer.hpp"

#include <gtest/gtest.h>

#include <map>
#include <optional>
#include <sstream>

namespace tappet::test {
namespace {

const std::string nodes_folder = TAPPET_SOURCE "/apps/carpet_loom/nodes/";

/// In place of a simulated node, each millisecond.
struct WithPeer : testing::Test, NetworkRig {
    ~WithPeer() override { EXPECT_TRUE(good); }
    void hear(const can::Frame& frame, Time now) override {
        NetworkRig::hear(frame, now);
        if (peer) peer->give(frame);
    }
    void pass(Time now) override {
        NetworkRig::pass(now);
        const std::int64_t ms = to_ns(now) / 1'000'000;
        if (!peer || ms == moved_to) return;
        moved_to = ms;
        for (const can::Frame& frame : peer->move_to(ms)) send(frame);
    }
    std::optional<Peer> peer;
    std::int64_t moved_to = -1;
};

TEST_F(WithPeer, the_manager_configures_and_starts_a_foreign_device) {
    peer.emplace("device " + nodes_folder + "drive.eds 5");
    std::erase(all, &drive);
    run_until(2500ms); // it sends no boot-up message, and is polled
    EXPECT_TRUE(operational()) << reason();
    EXPECT_TRUE(peer->has_told("state 5"));
    EXPECT_TRUE(peer->has_told("mapped 2")) << "objects in its PDO";
    EXPECT_EQ(people->statusword.get(), 0x231);
    EXPECT_EQ(people->velocity.get(), -1234 * 0.1);
    EXPECT_TRUE(peer->has_told("controlword 6"));
    EXPECT_TRUE(peer->has_told("target -123"));
    peer.reset();
    run(300ms);
    EXPECT_FALSE(operational());
    EXPECT_EQ(reason(), "node 5 \"drive\": its heartbeat is missing; look at its supply and its cable");
}

TEST_F(WithPeer, the_manager_refuses_another_device) {
    peer.emplace("device " + nodes_folder + "encoder.eds 5");
    std::erase(all, &drive);
    run_until(1500ms);
    EXPECT_FALSE(operational());
    EXPECT_EQ(reason(),
              "node 5 \"drive\": object 1000h:0 must be 00020192h and is 00020196h; connect a \"Velocity "
              "drive\" as apps/carpet_loom/nodes/drive.eds describes it");
}

/// Without the machine: only the peer and our node.
TEST(PeerClient, reads_and_writes_our_simulated_node) {
    struct Wire final : canopen::FrameSink {
        std::vector<can::Frame> frames;
        void send(const can::Frame& frame) noexcept override {
            TAPPET_ESCAPE("a test keeps them", frames.push_back(frame));
        }
    } wire;
    canopen::SimulatedDevice<canopen::dictionary<files::drive_eds>> drive{5};
    drive.power_on(Time{2ms});
    Peer peer{"client 5"};
    for (std::int64_t ms = 0; ms < 400; ++ms) {
        const Time now{std::chrono::milliseconds{ms}};
        drive.tick(now, wire);
        if (ms == 300) drive.send_emergency(0x2310, 1, now, wire);
        for (const can::Frame& frame : std::exchange(wire.frames, {})) peer.give(frame);
        for (const can::Frame& frame : peer.move_to(ms)) drive.receive(frame, now, wire);
    }
    for (const char* expected :
         {"vendor 999", "name Velocity drive", "mode written -3", "missing abort 6020000",
          "read-only abort 6010002", "too long abort 6070012", "too high abort 6090031", "beat written",
          "heartbeat 5 0", "heartbeat 5 127", "emergency 8976"})
        EXPECT_TRUE(peer.has_told(expected)) << expected;
    if (HasFailure())
        for (const std::string& each : peer.told) ADD_FAILURE() << each;
}

/// The values of each object that it shows, as hexadecimal bytes or a text.
std::map<std::string, std::string> values_by_peer(const std::string& file) {
    std::map<std::string, std::string> values;
    std::istringstream lines{output_of_peer("values " + file)};
    for (std::string line; std::getline(lines, line);) {
        const std::size_t first = line.find('|'), second = line.find('|', first + 1);
        values[line.substr(0, second)] = line.substr(second + 1);
    }
    return values;
}
std::string our_value(const canopen::Object& object) {
    if (canopen::bits_of(object.type) == 0) return std::string{object.text};
    std::string text;
    for (unsigned i = 0; i < canopen::bytes_of(object.type); ++i) {
        char digits[3];
        std::snprintf(digits, sizeof digits, "%02x",
                      static_cast<unsigned>(object.value.of(5) >> (8 * i) & 0xFF));
        text += digits;
    }
    return text;
}

TEST(PeerEds, reads_the_same_values_out_of_a_file) {
    const auto compare = [](const canopen::Dictionary& ours, const std::string& file) {
        const auto theirs = values_by_peer(nodes_folder + file);
        std::size_t compared = 0;
        for (const canopen::Object& object : ours.objects) {
            // The peer counts sub-indices itself, and shows nothing for a missing value.
            const bool counts = object.at.sub == 0 && ours.find({object.at.index, 1}) != nullptr;
            const std::string key = std::to_string(object.at.index) + "|" + std::to_string(object.at.sub);
            const auto found = theirs.find(key);
            if (counts || object.text.empty()) continue;
            ASSERT_NE(found, theirs.end()) << file << " " << canopen::to_text(object.at).view();
            constexpr std::array<std::string_view, 6> accesses{"ro", "wo", "rw", "rwr", "rww", "const"};
            EXPECT_EQ(found->second, std::to_string(static_cast<unsigned>(object.type)) + "|" +
                                         std::string{accesses[static_cast<std::size_t>(object.access)]} +
                                         "|" + our_value(object))
                << file << " " << canopen::to_text(object.at).view();
            ++compared;
        }
        EXPECT_GT(compared, 15u);
    };
    compare(canopen::dictionary<files::drive_eds>, "drive.eds");
    compare(canopen::dictionary<files::encoder_eds>, "encoder.eds");
}

} // namespace
} // namespace tappet::test
