// The table of both, and the start of their connection.
#include "tests/figures/wire/ends.hpp"

#include "drivers/system/station.hpp"
#include "kernel/machine/accept.hpp"
#include "kernel/machine/worlds/virtual_world.hpp"
#include "tests/figures/measure/world.hpp"

namespace tappet::figures {

namespace {

// clang-format off
constexpr auto telling = machine("telling",
    components(component<Teller>("teller")),
    activities(activity("telling", every(5ms), runs("teller"), budget(50us))), connections(), reactions(), behaviours());
constexpr auto hearing = machine("hearing",
    components(component<Hearer>("hearer")),
    activities(activity("hearing", every(5ms), runs("hearer"), budget(50us))), connections(), reactions(), behaviours());
// Beats are rare, so that the rows dominate the measurement.
constexpr auto two = tappet::system("two",
    nodes(node<telling>("a"), node<hearing>("b")),
    wire("wire", bit_rate(500'000), beats(100s), silent_after(1000s), served_within(1ms, budget(40us))),
    crossings(
        across(data("a.teller.level", "b.hearer.level"), every(value_period), in_bits(level_bits, level_step)),
        across(when("a.teller.full", tell("b.hearer.take")), at_most(1, 40ms), within(30ms))),
    promises());
// clang-format on

constexpr Board board{
    .name = "figures", .world = "host", .memory_budget_bytes = 8 * 1024 * 1024, .simulated = true};
constexpr auto from_table = station<two, "a", telling>;
constexpr auto to_table = station<two, "b", hearing>;

using From = systems::Link<two, 0>;
using To = systems::Link<two, 1>;
using ToBus = can::Bus<systems::no_signals, systems::StationRows<two, 1>::services>;

os::Clock the_clock{os::Clock::Kind::virtual_time};
const Ends* the_ends = nullptr;
From* link_from = nullptr;
To* link_to = nullptr;
ToBus* bus_to = nullptr;
std::uint32_t wire_of_from = 0, wire_of_to = 0, hearing_activity = 0;

Cycle cycle_now() { return {.now = the_clock.now(), .release = the_clock.now(), .period = {}}; }

std::uint32_t activity_of_row(const MachineInstance& instance, std::string_view name) {
    for (std::uint32_t a = 0; a < instance.machine().table.activities.size(); ++a)
        if (instance.machine().table.activities[a].name == name) return a;
    std::cerr << "there is no activity " << name << '\n';
    std::exit(2);
}

void give_functions(Ends& found) {
    found.exchange = [] {
        const Ends& both = *the_ends;
        both.from->bring_to(*both.to);
        both.receives->run(true);
        both.hears->run(true);
        both.to->bring_to(*both.from);
        both.sends->run(true);
        both.from->bring_to(*both.to);
        both.receives->run(true);
    };
    found.hearer_level = [] {
        const RunsActivity here{hearing_activity};
        return the_ends->hearer->level.get();
    };
    found.are_all_answered = [] {
        const SendCounts& count = link_from->sent(1);
        return count.offered == count.delivered && count.offered > 0;
    };
}

} // namespace

Ends& ends() {
    static Memory from, to;
    static MachineInstance a{AtRunTime<from_table, board>::machine(), the_clock};
    static MachineInstance b{AtRunTime<to_table, board>::machine(), the_clock};
    static VirtualWorld world_a{a}, world_b{b};
    static Ends all = [] {
        Ends found;
        the_clock.advance_to(Time{1s});
        for (auto [instance, world, memory] :
             {std::tuple{&a, &world_a, &from}, std::tuple{&b, &world_b, &to}}) {
            const ProvidedDevice provided{type_id<can::Device>, "wire", static_cast<can::Device*>(memory)};
            const auto configured = instance->configure(std::span{&provided, 1});
            exit_if(configured ? world->start() : configured.error());
        }
        wire_of_from = activity_of_row(a, "wire"), wire_of_to = activity_of_row(b, "wire");
        found.teller = a.find<Teller>("teller");
        found.hearer = b.find<Hearer>("hearer");
        found.telling = activity_of_row(a, "telling");
        found.sends = &a.engines()[wire_of_from];
        found.receives = &b.engines()[wire_of_to];
        hearing_activity = activity_of_row(b, "hearing");
        found.hears = &b.engines()[hearing_activity];
        found.from = &from, found.to = &to;
        found.advance = [](Duration by) { the_clock.advance_to(the_clock.now() + by); };
        found.now = [] { return the_clock.now(); };
        link_from = a.find<From>("wire"), link_to = b.find<To>("wire");
        bus_to = b.find<ToBus>("wire_can");
        found.end_sends = [] {
            const RunsActivity here{wire_of_from};
            link_from->fire(cycle_now());
        };
        found.end_receives = [](const can::Frame& frame) {
            const RunsActivity here{wire_of_to};
            bus_to->services.push(frame);
            link_to->step(cycle_now());
        };
        constexpr auto& plan = systems::plan_of<two>;
        const WireFrame &level = plan.frames[plan.place[0].frame], &full = plan.frames[plan.place[1].frame],
                        &answer = plan.frames[plan.place[1].answer];
        found.identifiers = {level.id, full.id, answer.id, level.data_id, full.data_id, answer.data_id};
        {
            const RunsActivity here{found.telling};
            found.teller->level.write(1.0);
        }
        give_functions(found);
        return found;
    }();
    static const bool met = [] {
        the_ends = &all;
        for (int i = 0; i < 500; ++i) {
            all.advance(value_period);
            all.exchange();
        }
        if (!link_from->works(1) || !link_to->works(0) || !link_to->works(1))
            exit_if(Sentence{"the two machines have not come to know each other"});
        return true;
    }();
    static_cast<void>(met);
    return all;
}

} // namespace tappet::figures
