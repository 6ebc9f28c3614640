// Programs act on components through their facets (thesis 5.1.4, 5.1.5): ports, buffers, events, operations,
// methods, the own commands and those of a peer, properties.
#include "tests/kernel/program/fixture.hpp"

#include "kernel/activity/command_processor.hpp"

#include <gtest/gtest.h>

#include <memory>

namespace program_test {

/// A facet of each kind, and what was done with it.
struct Arm {
    Input<double> measured;
    Output<double> wanted;
    BufferInput<int> jobs;
    BufferOutput<int> results;
    Event<int, double> moved;
    Property<double> speed{1.0};
    Property<std::int32_t> axes{6};
    double told = 0;
    int goal = 0;
    bool arrived = false;
    bool broken = false;
    int changes = 0;
    int asked = 0;

    void tell(double what) noexcept TAPPET_REALTIME { told = what; }
    double twice(double value, std::int16_t times) noexcept TAPPET_REALTIME { return 2 * value + times; }
    bool enable(bool how) noexcept TAPPET_REALTIME { return how; }
    bool move_to(int where, double& way) noexcept TAPPET_REALTIME {
        goal = where;
        way = 0;
        return where >= 0;
    }
    CommandProgress moved_to(int where, double& way) noexcept TAPPET_REALTIME {
        ++asked;
        if (broken) return CommandProgress::failed;
        if (!arrived) return CommandProgress::executing;
        way = where / 2.0;
        return CommandProgress::done;
    }
    Sentence accepts(const Proposal& proposal) const noexcept TAPPET_REALTIME {
        return proposal.of(speed) == 7 ? Sentence{"not seven"} : Sentence{};
    }
    void changed() noexcept TAPPET_REALTIME { ++changes; }
    static constexpr auto interface() {
        return facets(
            input<&Arm::measured>("measured", "deg", "angle of the arm"),
            output<&Arm::wanted>("wanted", "deg", "angle of the arm"),
            input<&Arm::jobs>("jobs", "", "to be done"), output<&Arm::results>("results", "", "of the jobs"),
            event<&Arm::moved>("moved", "the arm stands"),
            property<&Arm::speed>("speed", "", "of the arm", range(0, 10)),
            property<&Arm::axes>("axes", "", "how many there are"),
            operation<&Arm::tell>("tell", "hears a number"), method<&Arm::twice>("twice", "doubles a number"),
            method<&Arm::enable>("enable", "switches the arm"),
            command<&Arm::move_to, &Arm::moved_to>("move_to", "goes to an angle"));
    }
};

const Facet& facet(std::string_view name) {
    for (const Facet& each : component_type<Arm>.facets)
        if (each.name == name) return each;
    throw std::runtime_error{std::string{name}};
}

/// An arm, and a program with one link to each of its facets, of the facet's number.
struct ArmProgram {
    Arm arm{};
    GatedComponent gate{&arm, ComponentState::running};
    TableBuilder table{};
    std::vector<ProgramLink> links = [this] {
        std::vector<ProgramLink> all;
        for (const Facet& each : component_type<Arm>.facets)
            all.push_back({&gate, each.at == nullptr ? &arm : each.at(&arm, each.index), nullptr,
                           &component_type<Arm>});
        return all;
    }();
    static std::uint16_t link(std::string_view name) {
        return static_cast<std::uint16_t>(&facet(name) - component_type<Arm>.facets.data());
    }
    static Instruction with(const FacetAction& action, std::string_view name, DataOffset to,
                            DataOffset a = no_data) {
        EXPECT_TRUE(action) << name;
        return TableBuilder::with(action.instruction, to, a, no_data, link(name));
    }
    std::unique_ptr<Running> bind() { return std::make_unique<Running>(table, ProgramPolicy{}, &arm, links); }
};

TEST(Ports, are_read_and_written_and_tell_their_age) {
    ArmProgram p;
    const DataOffset value = p.table.value(2.5);
    const DataOffset read = p.table.value(0.0);
    const DataOffset back = p.table.value(0.0);
    const DataOffset valid_before = p.table.value(true);
    const DataOffset valid = p.table.value(false);
    const DataOffset fresh = p.table.value(false);
    const DataOffset still_fresh = p.table.value(true);
    const DataOffset age = p.table.value(Duration{});
    p.table
        .node({p.with(input_valid(facet("measured")), "measured", valid_before),
               p.with(find_write(facet("wanted")), "wanted", no_data, value),
               p.with(input_valid(facet("measured")), "measured", valid),
               p.with(input_fresh(facet("measured")), "measured", fresh),
               p.with(find_read(facet("measured")), "measured", read),
               p.with(input_fresh(facet("measured")), "measured", still_fresh),
               p.with(find_read(facet("wanted")), "wanted", back),
               p.with(port_age(facet("measured")), "measured", age)})
        .arc(end_node);
    const PortOperations& port = PortAccess::data<double>;
    const Time now = at_ms(30);
    port.set_clock(&p.arm.wanted, false, &now);
    port.set_clock(&p.arm.measured, true, &now);
    port.link_local(&p.arm.measured, &p.arm.wanted, nullptr); // what it writes it reads
    const auto running = p.bind();
    EXPECT_EQ(running->run(at_ms(50)), ProgramStatus::stopped);
    EXPECT_EQ(p.arm.wanted.last(), 2.5);
    EXPECT_FALSE(running->get<bool>(valid_before));
    EXPECT_TRUE(running->get<bool>(valid));
    EXPECT_TRUE(running->get<bool>(fresh)) << "asking leaves it fresh";
    EXPECT_FALSE(running->get<bool>(still_fresh));
    EXPECT_EQ(running->get<double>(read), 2.5);
    EXPECT_EQ(running->get<double>(back), 2.5);
    EXPECT_EQ(running->get<Duration>(age), 20ms);
}

TEST(Buffers, are_pushed_popped_and_waited_for) {
    ArmProgram p;
    const DataOffset in = p.table.value(41);
    const DataOffset out = p.table.value(0);
    const DataOffset later = p.table.value(0);
    const DataOffset room = p.table.value(false);
    const DataOffset empty = p.table.value(false);
    p.table
        .node({p.with(push_buffer(facet("results")), "results", room, in),
               p.with(pop_buffer(facet("jobs")), "jobs", out),
               p.with(buffer_empty(facet("jobs")), "jobs", empty)})
        .arc(1);
    p.table.node({p.with(wait_buffer(facet("jobs")), "jobs", later)}).arc(2);
    p.table.node({p.with(pop_buffer(facet("jobs")), "jobs", out)}).arc(end_node);
    alignas(64) std::byte memory[512];
    PortAccess::buffer<int>.link(&p.arm.results, &p.arm.jobs, memory, 1, Overflow::reject, false);
    const auto running = p.bind();
    EXPECT_EQ(running->run(), ProgramStatus::running) << "the buffer is empty: it waits";
    EXPECT_TRUE(running->get<bool>(room));
    EXPECT_TRUE(running->get<bool>(empty));
    EXPECT_EQ(running->get<int>(out), 41);
    p.arm.results.push(42);
    EXPECT_EQ(running->step(at_ms(1)), ProgramStatus::error) << "the last pop finds nothing";
    EXPECT_EQ(running->get<int>(later), 42);
    EXPECT_EQ(running->execution.line(), 3);
}

TEST(A_buffer_without_room, fails_the_statement_that_writes_to_it) {
    ArmProgram p;
    const DataOffset in = p.table.value(41);
    p.table.node({p.with(find_write(facet("results")), "results", no_data, in)}).arc(1);
    p.table.node({p.with(find_write(facet("results")), "results", no_data, in)}).arc(end_node);
    alignas(64) std::byte memory[512];
    PortAccess::buffer<int>.link(&p.arm.results, &p.arm.jobs, memory, 1, Overflow::reject, false);
    const auto running = p.bind();
    EXPECT_EQ(running->run(), ProgramStatus::error);
    EXPECT_EQ(running->execution.line(), 2);
}

TEST(Events, are_emitted_with_packed_arguments) {
    ArmProgram p;
    struct {
        int number = 0;
        double value = 0;
    } heard;
    std::array<Subscriber<int, double>, 1> room{};
    PortAccess::event<int, double>.give_storage(&p.arm.moved, room.data());
    void (*const call)(void*, int, double) noexcept
        TAPPET_REALTIME = [](void* self, int number, double value) noexcept
        TAPPET_REALTIME { *static_cast<decltype(heard)*>(self) = {number, value}; };
    PortAccess::event<int, double>.subscribe(&p.arm.moved, &call, &heard).store(1);
    std::array<std::byte, 12> packed{};
    detail::pack(packed.data(), 3, 4.5);
    const DataOffset arguments = p.table.value(packed);
    p.table.node({p.with(emit_event(facet("moved")), "moved", no_data, arguments)}).arc(end_node);
    EXPECT_EQ(p.bind()->run(), ProgramStatus::stopped);
    EXPECT_EQ(heard.number, 3);
    EXPECT_EQ(heard.value, 4.5);
}

TEST(Operations_and_methods, are_called_here_and_now) {
    ArmProgram p;
    const DataOffset told = p.table.value(1.25);
    std::array<std::byte, 10> packed{};
    detail::pack(packed.data(), 1.5, std::int16_t{4});
    const DataOffset arguments = p.table.value(packed);
    const DataOffset result = p.table.value(0.0);
    p.table
        .node({p.with(call_operation(facet("tell")), "tell", no_data, told),
               p.with(call_method(facet("twice")), "twice", result, arguments)})
        .arc(end_node);
    const auto running = p.bind();
    EXPECT_EQ(running->run(), ProgramStatus::stopped);
    EXPECT_EQ(p.arm.told, 1.25);
    EXPECT_EQ(running->get<double>(result), 7.0);
}

TEST(A_method_as_a_statement, fails_the_program_when_it_answers_false) {
    for (const bool how : {false, true}) {
        ArmProgram p;
        const DataOffset argument = p.table.value(how);
        p.table.node({p.with(do_method(facet("enable")), "enable", no_data, argument)}).arc(end_node);
        EXPECT_EQ(p.bind()->run(), how ? ProgramStatus::stopped : ProgramStatus::error);
    }
}

/// "do move_to(goal)" of the own component.
struct OwnCommand : ArmProgram {
    std::array<std::byte, 12> packed{};
    DataOffset values, done;
    explicit OwnCommand(int goal) {
        detail::pack(packed.data(), goal, -1.0);
        values = table.value(packed);
        done = table.scratch();
        table.node({with(begin_command(facet("move_to")), "move_to", values)})
            .arc(end_node,
                 table.condition({with(command_progress(facet("move_to")), "move_to", done, values)}, done));
    }
};

TEST(An_own_command, is_begun_once_and_its_completion_asked_in_each_step) {
    OwnCommand p{8};
    const auto running = p.bind();
    EXPECT_EQ(running->run(), ProgramStatus::running);
    EXPECT_EQ(p.arm.goal, 8);
    EXPECT_EQ(p.arm.asked, 1) << "in the step in which it began";
    p.arm.goal = 0;
    EXPECT_EQ(running->step(at_ms(1)), ProgramStatus::running);
    p.arm.arrived = true;
    EXPECT_EQ(running->step(at_ms(2)), ProgramStatus::stopped);
    EXPECT_EQ(p.arm.goal, 0) << "its action ran once";
    EXPECT_EQ(detail::load_packed<double>(running->data.data() + p.values + 4), 4.0) << "its result";
}

TEST(An_own_command, that_is_rejected_or_fails_puts_the_program_in_error) {
    OwnCommand rejected{-1};
    EXPECT_EQ(rejected.bind()->run(), ProgramStatus::error);
    OwnCommand fails{1};
    const auto running = fails.bind();
    EXPECT_EQ(running->run(), ProgramStatus::running);
    fails.arm.broken = true;
    EXPECT_EQ(running->step(at_ms(1)), ProgramStatus::error);
}

/// "do arm.move_to(goal)" of an arm in another activity, whose engine is a command processor.
struct PeersCommand : ArmProgram {
    DataOffset goal = table.value(8);
    DataOffset way = table.value(0.0);
    DataOffset done = table.scratch();
    CommandSlot slot{};
    alignas(8) std::array<std::byte, 16> values{};
    alignas(512) std::array<std::byte, 4096> ring{};
    std::array<CommandMailbox, 1> boxes{};
    std::array<CommandSlot*, 4> followed{};
    CommandProcessor processor{};
    os::Clock clock{os::Clock::Kind::virtual_time};

    PeersCommand() {
        EXPECT_LE(CommandMailbox::bytes_for(2), ring.size());
        boxes[0].place(ring.data(), 2, Overflow::reject);
        processor.place(boxes, followed, 0);
        CommandSlot::Route route;
        route.command = facet("move_to").command;
        route.receiver = &gate;
        route.inbox = &processor.inbox();
        route.clock = &clock;
        slot.place(route, values.data());
        links[link("move_to")].slot = &slot;
        table.node({with(send_command(facet("move_to")), "move_to", no_data, goal)})
            .arc(1, table.condition({with(command_ended(facet("move_to")), "move_to", done)}, done));
        table.node({with(command_results(facet("move_to")), "move_to", way)}).arc(end_node);
    }
    void serve() {
        processor.serve([this](std::uint32_t, CommandSlot& each) noexcept
                        TAPPET_REALTIME { static_cast<void>(processor.take_up(each)); });
        processor.follow([](std::uint32_t, CommandSlot& each) noexcept
                         TAPPET_REALTIME { return !in_flight(each.follow()); });
    }
};

TEST(A_peers_command, is_sent_and_waited_for_to_its_end) {
    PeersCommand p;
    const auto running = p.bind();
    EXPECT_EQ(running->run(), ProgramStatus::running);
    EXPECT_EQ(p.slot.state(), CommandState::sent);
    EXPECT_EQ(p.arm.goal, 0) << "it runs in the other engine";
    p.serve();
    EXPECT_EQ(p.arm.goal, 8);
    EXPECT_EQ(running->step(at_ms(1)), ProgramStatus::running);
    p.arm.arrived = true;
    p.serve();
    EXPECT_EQ(running->step(at_ms(2)), ProgramStatus::stopped);
    EXPECT_EQ(running->get<double>(p.way), 4.0);
}

TEST(A_peers_command, that_is_rejected_or_fails_puts_the_program_in_error) {
    PeersCommand rejected;
    const auto first = rejected.bind();
    first->put(rejected.goal, -1);
    EXPECT_EQ(first->run(), ProgramStatus::running);
    rejected.serve();
    EXPECT_EQ(first->step(at_ms(1)), ProgramStatus::error);

    PeersCommand fails;
    const auto second = fails.bind();
    second->run();
    fails.arm.broken = true;
    fails.serve();
    EXPECT_EQ(second->step(at_ms(1)), ProgramStatus::error);

    PeersCommand stopped;
    stopped.gate.state = ComponentState::stopped;
    EXPECT_EQ(stopped.bind()->run(), ProgramStatus::error) << "its receiver does not run";
}

TEST(A_peers_command, waits_for_an_earlier_sending_that_is_still_on_its_way) {
    PeersCommand p;
    const auto running = p.bind();
    running->run();
    p.serve(); // executing
    ASSERT_TRUE(running->execution.stop());
    EXPECT_EQ(running->run(at_ms(1)), ProgramStatus::running);
    EXPECT_EQ(p.slot.state(), CommandState::executing) << "of the first sending";
    p.arm.arrived = true;
    p.serve();
    ASSERT_EQ(p.slot.state(), CommandState::done);
    EXPECT_EQ(running->step(at_ms(2)), ProgramStatus::running);
    EXPECT_EQ(p.slot.state(), CommandState::sent) << "the second one went";
    p.serve();
    EXPECT_EQ(running->step(at_ms(3)), ProgramStatus::stopped);
}

TEST(A_property, is_read_and_written_where_its_range_and_its_component_allow) {
    struct Case {
        double value;
        bool good;
    };
    for (const Case& each : {Case{2.5, true}, Case{10, true}, Case{10.5, false}, Case{-1, false},
                             Case{std::numeric_limits<double>::quiet_NaN(), false}, Case{7, false}}) {
        ArmProgram p;
        const DataOffset value = p.table.value(each.value);
        const DataOffset read = p.table.value(0.0);
        p.table
            .node({p.with(find_write(facet("speed")), "speed", no_data, value),
                   p.with(find_read(facet("speed")), "speed", read)})
            .arc(end_node);
        const auto running = p.bind();
        EXPECT_EQ(running->run(), each.good ? ProgramStatus::stopped : ProgramStatus::error) << each.value;
        EXPECT_EQ(p.arm.speed.get(), each.good ? each.value : 1.0);
        EXPECT_EQ(p.arm.changes, each.good ? 1 : 0);
        EXPECT_EQ(running->get<double>(read), each.good ? each.value : 0.0);
    }
}

TEST(Actions, are_found_for_facets_of_their_kind_only) {
    EXPECT_FALSE(find_read(facet("move_to")));
    EXPECT_FALSE(find_write(facet("measured"))) << "an input is not written";
    EXPECT_FALSE(emit_event(facet("tell")));
    EXPECT_FALSE(call_method(facet("tell")));
    EXPECT_FALSE(call_operation(facet("twice")));
    EXPECT_FALSE(begin_command(facet("twice")));
    EXPECT_FALSE(pop_buffer(facet("results")));
    EXPECT_FALSE(input_valid(facet("wanted")));
}

} // namespace program_test
