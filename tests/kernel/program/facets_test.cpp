// Programs act on components through their facets (thesis 5.1.4, 5.1.5): ports, buffers, events, properties.
// The scripts of tests/kernel/script/programs_test.cpp call operations, methods and commands.
#include "tests/kernel/program/fixture.hpp"

#include <gtest/gtest.h>

#include <memory>

namespace program_test {

/// A facet of each kind, and a record of its use.
struct Arm {
    Input<double> measured;
    Output<double> wanted;
    BufferInput<int> jobs;
    BufferOutput<int> results;
    Event<int, double> moved;
    Property<double> speed{1.0};
    Property<std::int32_t> axes{6};
    int changes = 0;

    void tell(double) noexcept TAPPET_REALTIME {}
    double twice(double value) noexcept TAPPET_REALTIME { return 2 * value; }
    bool move_to(int) noexcept TAPPET_REALTIME { return true; }
    CommandProgress moved_to(int) noexcept TAPPET_REALTIME { return CommandProgress::done; }
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

TEST(Ports, are_read_and_written_and_report_their_age) {
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
    port.link_local(&p.arm.measured, &p.arm.wanted, nullptr); // it reads its own writes
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

TEST(Buffers, are_pushed_popped_and_awaited) {
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

TEST(A_property, is_read_and_written_within_its_range_and_component_rules) {
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

TEST(Actions, are_found_only_for_facets_of_their_kind) {
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
