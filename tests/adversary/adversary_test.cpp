// The adversary finds broken rules of every machine, and repeats its actions for the same seed. ci/planted
// shows how it finds each fault in tests/planted.
#include "kernel/services/browsing/protocol.hpp"
#include "tests/adversary/machine.hpp"
#include "tests/adversary/plant.hpp"
#include "tests/kernel/os/folder.hpp"
#include "toolchain/machine/swarm.hpp"

#include <gmock/gmock.h>

#include <functional>

namespace adversary {

AcceptedMachine on_host();

namespace {

using testing::HasSubstr;

std::unique_ptr<tappet::Plant> make_plant(std::uint64_t seed) { return std::make_unique<Plant>(seed); }

/// Acts on the machine like a fault of the framework, and reports no broken rule itself.
class Meddles final : public SwarmRules {
public:
    using Meddle = std::function<void(MachineInstance&, Time)>;
    Meddles(MachineInstance& machine, Meddle meddle) : machine_{machine}, meddle_{std::move(meddle)} {}
    std::string_view broken(Time now) override {
        meddle_(machine_, now);
        return {};
    }
    bool works() override { return true; }

private:
    MachineInstance& machine_;
    Meddle meddle_;
};

/// The sentence of the first seed that breaks a rule.
Sentence found(const Meddles::Meddle& meddle) {
    const SwarmOf of{
        on_host(), &make_plant,
        [&](MachineInstance& machine, tappet::Plant&, const Struck&) -> std::unique_ptr<SwarmRules> {
            return std::make_unique<Meddles>(machine, meddle);
        }};
    Sentence broken;
    for (std::uint64_t seed = 1; broken.empty() && seed < 60; ++seed) broken = SwarmRun{of, seed}.go().broken;
    return broken;
}

ComponentState state(MachineInstance& machine, std::string_view component) {
    return machine.life().state_of(find_component(machine.machine().table, component));
}

TEST(Adversary, finds_an_output_that_moves_while_its_component_is_stopped) {
    constexpr std::size_t gate = bed_lines.index("gate");
    const Sentence why = found([](MachineInstance& machine, Time) {
        if (state(machine, "gate") == ComponentState::stopped &&
            state(machine, "io") == ComponentState::running)
            machine.find<gpio::LinePort<bed_lines>>("io")->set<gate>();
    });
    EXPECT_THAT(
        std::string{why.view()},
        HasSubstr("output \"io.gate\" is 1 at the wire (safe: 0), though no component that drives it runs"));
}

TEST(Adversary, finds_a_line_left_unsafe_by_a_stop) {
    constexpr std::size_t gate = bed_lines.index("gate");
    const Sentence why = found([](MachineInstance& machine, Time) {
        if (state(machine, "io") == ComponentState::stopped)
            machine.find<gpio::LinePort<bed_lines>>("io")->start(Cycle{}),
                machine.find<gpio::LinePort<bed_lines>>("io")->set<gate>();
    });
    EXPECT_THAT(std::string{why.view()}, HasSubstr("io.gate"));
}

/// With random users and seeds; only the repetition is checked.
TEST(Adversary, repeats_its_actions_for_the_same_seed) {
    const SwarmOf of{on_host(), &make_plant, {}};
    std::vector<std::string> told[2];
    for (auto& each : told)
        static_cast<void>(SwarmRun{
            of, 5, [&each](Time at, std::string_view text) {
                each.push_back(std::to_string(to_ns(at)) + " " + std::string{text});
            }}.go());
    EXPECT_EQ(told[0], told[1]);
    EXPECT_GT(told[0].size(), 50u);
}

TEST(Adversary, plays_users_of_every_role_with_every_request) {
    const SwarmOf of{on_host(), &make_plant, {}};
    std::string told;
    for (std::uint64_t seed = 1; seed <= 30; ++seed)
        static_cast<void>(
            SwarmRun{of, seed, [&told](Time, std::string_view text) { (told += text) += "\n"; }}.go());
    for (const char* verb : {"call ", "send ", "set ", "force ", "release ", "stop ", "restart ", "execute ",
                             "script ", "load ", "unload ", "roll_back ", "get ", "save", "break_off"})
        EXPECT_THAT(told, HasSubstr(std::string{"somebody asks: "} + verb)) << verb;
    EXPECT_THAT(told, HasSubstr("a visitor asks: "));
}

/// The driver keeps its last sent value: a release would leave that in place.
TEST(Bed, refuses_to_force_an_unwritten_input) {
    const test::Folder folder;
    Plant plant{1};
    VirtualRun run{on_host(), plant, 1};
    run.browse_in(folder.path);
    ASSERT_TRUE(run.start());
    SwarmBrowser browser{folder.path + "/bed" + std::string{browsing::socket_suffix}};
    const auto asked = [&](const std::string& request) {
        std::string said;
        static_cast<void>(browser.hear());
        browser.ask(request, run.now(), [&](std::string_view answer) { said = answer; });
        EXPECT_TRUE(run.run_for(200ms));
        static_cast<void>(browser.hear());
        return said;
    };
    EXPECT_TRUE(run.run_for(500ms));
    EXPECT_THAT(asked("force io.valve true"),
                HasSubstr("was not written yet: a release would have nothing to go "
                          "back to; let its component write it first"));
    EXPECT_THAT(asked("call valve.close"), HasSubstr("\"ok\": true"));
    EXPECT_THAT(asked("force io.valve true"), HasSubstr("\"ok\": true"));
    browser.leave();
}

} // namespace
} // namespace adversary
