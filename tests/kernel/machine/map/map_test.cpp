// The map of a machine (thesis 4.7.2, names): the compiler computes it from the table, start-up adds the
// addresses, and another process reads every name, row and live value through it.
#include "kernel/machine/map/view.hpp"

#include "kernel/machine/firmware.hpp"
#include "tests/kernel/machine/virtual_rig.hpp"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstring>
#include <thread>
#include <utility>
#include <vector>

namespace tappet {

enum class Gait { rest, walk, run };
template <>
inline constexpr auto names_of<Gait> = std::array<std::string_view, 3>{"rest", "walk", "run"};
struct Pose {
    float turn = 0;
    double x = 0;
};
template <>
inline constexpr auto fields_of<Pose> = fields(field<&Pose::x>("x", "mm"), field<&Pose::turn>("turn", "deg"));

namespace {

struct Wheel {
    Output<double> angle;
    Output<Pose> pose;
    Output<Gait> gait;
    BufferOutput<std::int64_t> ticks;
    Event<double, bool> turned;
    Property<double> gain{0.5};
    Property<Text<12>> label{"front"};
    void step(const Cycle&) noexcept TAPPET_REALTIME {
        angle.write(angle.last() + gain);
        pose.write({static_cast<float>(angle.last()), 2 * angle.last()});
        gait.write(Gait::run);
        turned.emit(angle.last(), true);
    }
    static constexpr auto interface() {
        return facets(output<&Wheel::angle>("angle", "deg", "of the wheel"),
                      output<&Wheel::pose>("pose", "", "where it is"),
                      output<&Wheel::gait>("gait", "", "how it goes"),
                      output<&Wheel::ticks>("ticks", "", "of its encoder"),
                      event<&Wheel::turned>("turned", "a step was made"),
                      property<&Wheel::gain>("gain", "deg", "of one step", range(0, 2)),
                      property<&Wheel::label>("label", "", "on its cover"));
    }
};

struct Road {
    Input<double> near, far;
    BufferInput<std::int64_t> ticks;
    std::int64_t steps = 0;
    void step(const Cycle&) noexcept TAPPET_REALTIME {
        static_cast<void>(near.get());
        static_cast<void>(far.get());
    }
    void on_turned(double, bool) noexcept TAPPET_REALTIME { ++steps; }
    static constexpr auto interface() {
        return facets(input<&Road::near>("near", "deg", "a wheel"),
                      input<&Road::far>("far", "deg", "another", optional),
                      input<&Road::ticks>("ticks", "", "of a wheel", optional),
                      operation<&Road::on_turned>("on_turned", "counts"));
    }
};

// clang-format off
constexpr auto table = machine("cart",
    components(component<Wheel>("left"), component<Wheel>("right", set("gain", 0.25)), component<Road>("road"),
               component<Onlooker>("onlooker")),
    activities(
        activity("wheels", every(1ms), budget(50us), runs("left", "right")),
        activity("ground", every(5ms), budget(50us), runs("road")),
        activity("office", every(100ms), not_real_time, runs("onlooker"))),
    connections(
        data("left.angle", "road.near", stale_after(10ms), hold),
        buffer<16>("right.ticks", "road.ticks", drop_oldest)),
    reactions(when("left.turned", tell("road.on_turned", queue(5)))),
    behaviours());
constexpr auto blind = machine("blind",
    components(component<Wheel>("left")), activities(activity("wheels", every(1ms), budget(50us), runs("left"))),
    connections(), reactions(), behaviours());
// clang-format on

using Cart = Firmware<table, test_board>;
using Blind = Firmware<blind, test_board>;

// The map is a constant: the compiler evaluates the following checks.
constexpr auto& drawn = Cart::map();
static_assert(drawn.text(drawn.header.machine) == "cart");
static_assert(drawn.header.components.count == 4 && drawn.header.facets.count == 18);
static_assert(drawn.text(drawn.components[2].name) == "road" && drawn.components[2].activity == 1);
static_assert(drawn.text(drawn.facets[5].name) == "gain" && drawn.facets[5].high == 2);
constexpr auto& unseen = Blind::map();
static_assert(unseen.text(unseen.header.machine) == "blind",
              "any table has one, also when nothing sees the machine");

TEST(Accepted, produces_the_same_map_and_memory_as_the_compiler) {
    for (const auto& [of, compiled] :
         {std::pair{table.view(), Cart::machine()}, {blind.view(), Blind::machine()}}) {
        Accepted accepted{of, test_board};
        ASSERT_EQ(accepted.refusal().view(), "");
        const AcceptedMachine made = accepted.machine();
        EXPECT_TRUE(std::ranges::equal(made.map, compiled.map));
        EXPECT_TRUE(std::ranges::equal(made.map_types, compiled.map_types));
        EXPECT_TRUE(std::ranges::equal(made.index.position, compiled.index.position));
        EXPECT_TRUE(std::ranges::equal(made.plan.component_at, compiled.plan.component_at));
        EXPECT_EQ(made.memory.size(), compiled.memory.size());
        EXPECT_EQ(made.plan.shared_bytes, compiled.plan.shared_bytes);
    }
    constexpr Board small{.name = "small", .world = "host", .memory_budget_bytes = 4096};
    EXPECT_NE((Accepted{table.view(), small}.refusal().view().find("the board's budget is 4096")),
              std::string_view::npos);
}

class Map : public testing::Test {
protected:
    os::Clock clock{os::Clock::Kind::virtual_time};
    MachineInstance instance{Cart::machine(), clock};
    VirtualWorld world{instance};
    std::span<const std::byte> seen{};
    map::View view{};

    void SetUp() override {
        ASSERT_TRUE(instance.configure({}));
        world.start();
        seen = os::map_to_read(instance.observation().shared_descriptor());
        const auto opened = map::View::open(seen);
        ASSERT_TRUE(opened) << opened.error().view();
        view = *opened;
    }
    ~Map() override { os::unmap(seen); }

    const map::Facet& facet(std::string_view component, std::string_view name) const {
        for (const map::Facet& each : view.facets())
            if (view.text(each.name) == name &&
                view.text(view.components()[each.component].name) == component)
                return each;
        ADD_FAILURE() << "no facet " << component << "." << name;
        return view.facets()[0];
    }
    template <class T> T value(std::uint64_t at) const {
        T value{};
        EXPECT_TRUE(view.copy(at, std::as_writable_bytes(std::span{&value, 1})));
        return value;
    }
};

TEST_F(Map, names_every_component_with_its_activity_and_its_facets) {
    ASSERT_EQ(view.components().size(), table.components.size());
    for (std::size_t c = 0; c < table.components.size(); ++c) {
        const map::Component& seen_one = view.components()[c];
        const ComponentRow& row = table.components[c];
        EXPECT_EQ(view.text(seen_one.name), row.name);
        EXPECT_EQ(view.text(seen_one.type), row.type->tag->name);
        ASSERT_EQ(seen_one.facet_count, row.type->facets.size());
        for (std::size_t f = 0; f < seen_one.facet_count; ++f) {
            const map::Facet& each = view.facets()[seen_one.first_facet + f];
            EXPECT_EQ(view.text(each.name), row.type->facets[f].name);
            EXPECT_EQ(view.text(each.unit), row.type->facets[f].unit);
            EXPECT_EQ(view.text(each.doc), row.type->facets[f].doc);
            EXPECT_EQ(view.text(each.role), (each.flags & map::facet_can_request) != 0
                                                ? to_text(row.type->facets[f].least_role)
                                                : "");
            EXPECT_EQ(each.component, c);
        }
    }
    EXPECT_EQ(view.text(facet("left", "angle").kind), "output");
    EXPECT_EQ(view.text(facet("road", "ticks").kind), "buffered input");
    EXPECT_EQ(view.text(facet("road", "on_turned").kind), "operation");
}

TEST_F(Map, describes_data_flows_and_reactions) {
    ASSERT_EQ(view.connections().size(), 2u);
    const map::Connection& data = view.connections()[0];
    EXPECT_EQ(&view.facets()[data.from], &facet("left", "angle"));
    EXPECT_EQ(&view.facets()[data.to], &facet("road", "near"));
    EXPECT_EQ(data.flags, map::connection_across);
    EXPECT_EQ(data.max_age_ns, 10'000'000);
    EXPECT_EQ(view.text(data.when_stale), "hold");
    EXPECT_EQ(view.connections()[1].capacity, 16u);
    EXPECT_EQ(view.text(view.connections()[1].overflow), "drop_oldest");
    ASSERT_EQ(view.reactions().size(), 1u);
    const map::Reaction& reaction = view.reactions()[0];
    EXPECT_EQ(view.text(reaction.how), "tell");
    EXPECT_EQ(&view.facets()[reaction.from], &facet("left", "turned"));
    EXPECT_EQ(&view.facets()[reaction.to], &facet("road", "on_turned"));
    EXPECT_EQ(reaction.quota, 5u);
    EXPECT_NE(facet("road", "near").flags & map::facet_connected, 0u);
    EXPECT_EQ(facet("road", "far").flags & map::facet_connected, 0u);
}

TEST_F(Map, describes_how_each_activity_runs) {
    ASSERT_EQ(view.activities().size(), 3u);
    EXPECT_EQ(view.text(view.activities()[0].name), "wheels");
    EXPECT_EQ(view.activities()[0].period_ns, 1'000'000);
    EXPECT_EQ(view.activities()[0].budget_ns, 50'000);
    EXPECT_GT(view.activities()[0].priority, view.activities()[1].priority);
    EXPECT_EQ(view.activities()[2].real_time, 0u);
    EXPECT_EQ(view.text(view.activities()[2].trigger), "background");
}

TEST_F(Map, describes_types_including_fields_and_names) {
    const map::Type& pose = view.types()[facet("left", "pose").type];
    EXPECT_EQ(pose.shape, map::Shape::record);
    ASSERT_EQ(pose.field_count, 2u);
    const map::Field& x = view.fields()[pose.first_field];
    EXPECT_EQ(view.text(x.name), "x");
    EXPECT_EQ(view.text(x.unit), "mm");
    EXPECT_EQ(x.at, offsetof(Pose, x));
    EXPECT_EQ(view.types()[x.type].shape, map::Shape::real);
    const map::Type& gait = view.types()[facet("left", "gait").type];
    EXPECT_EQ(gait.shape, map::Shape::enumeration);
    ASSERT_EQ(gait.enumerator_count, 3u);
    EXPECT_EQ(view.text(view.enumerators()[gait.first_enumerator + 2].name), "run");
    const map::Type& turned = view.types()[facet("left", "turned").type];
    EXPECT_EQ(turned.shape, map::Shape::arguments);
    ASSERT_EQ(turned.field_count, 2u);
    EXPECT_EQ(view.fields()[turned.first_field + 1].at, sizeof(double));
    const map::Type& label = view.types()[facet("left", "label").type];
    EXPECT_EQ(label.shape, map::Shape::text);
    EXPECT_EQ(label.columns, 12u);
}

TEST_F(Map, locates_every_live_value) {
    static_cast<void>(world.run_until(at_ns(0) + 50ms));
    const double angle = instance.find<Wheel>("left")->angle.last();
    EXPECT_GT(angle, 0);
    EXPECT_EQ(value<double>(facet("left", "angle").value_at), angle);
    EXPECT_EQ(value<Pose>(facet("left", "pose").value_at).x, 2 * angle);
    EXPECT_EQ(value<std::int64_t>(facet("left", "angle").stamp_at), 50'000'000);
    EXPECT_EQ(value<std::uint64_t>(facet("left", "angle").writes_at), 50u);
    EXPECT_GT(value<double>(facet("road", "near").value_at), 0);
    EXPECT_EQ(value<double>(facet("left", "gain").value_at), 0.5);
    EXPECT_EQ(value<double>(facet("right", "gain").value_at), 0.25);
    EXPECT_EQ(value<Text<12>>(facet("left", "label").value_at).view(), "front");
    EXPECT_EQ(value<std::int64_t>(view.activities()[0].now_at), 50'000'000);
    EXPECT_EQ(view.word<std::uint64_t>(view.activities()[0].generation_at), 102u)
        << "even, two for the start and for each cycle";
    EXPECT_EQ(facet("left", "turned").value_at, 0u) << "an event has none";
}

TEST_F(Map, locates_the_statistics_of_the_framework) {
    static_cast<void>(world.run_until(at_ns(0) + 50ms));
    bool cycles = false, state = false;
    for (const map::Figure& each : view.figures()) {
        ASSERT_NE(each.value_at, 0u) << view.text(each.name);
        if (each.owner == map::Owner::activity && each.index == 1 && view.text(each.name) == "cycles") {
            EXPECT_EQ(value<std::uint64_t>(each.value_at), 10u);
            cycles = true;
        }
        if (each.owner == map::Owner::component && each.index == 0 && view.text(each.name) == "state") {
            EXPECT_EQ(value<ComponentState>(each.value_at), ComponentState::running);
            state = true;
        }
    }
    EXPECT_TRUE(cycles && state);
}

TEST_F(Map, shows_a_forced_port) {
    static_cast<void>(world.run_until(at_ns(0) + 50ms)); // an unwritten value is not forced
    const End angle{0, 0};
    const double forced = 90;
    facet_at(instance.machine().table, angle)
        .port->force(instance.place_of(angle), false, reinterpret_cast<const std::byte*>(&forced));
    EXPECT_EQ(value<bool>(facet("left", "angle").forced_at), true);
    EXPECT_EQ(value<double>(facet("left", "angle").value_at), 90);
}

TEST_F(Map, uses_memory_without_any_stack) {
    EXPECT_EQ(view.header().block_bytes, seen.size());
    EXPECT_GT(seen.size(), sizeof(map::Header));
    for (std::size_t a = 0; a < table.activities.size(); ++a) {
        const auto stack = instance.stack_of(a);
        EXPECT_GE(stack.data(), instance.machine().memory.data() + seen.size());
    }
}

TEST_F(Map, is_absent_when_no_component_sees_the_machine) {
    MachineInstance alone{Blind::machine(), clock};
    ASSERT_TRUE(alone.configure({}));
    EXPECT_TRUE(alone.observation().shared_memory().empty());
    EXPECT_EQ(alone.observation().shared_descriptor(), -1);
}

TEST_F(Map, is_refused_by_a_reader_when_damaged_or_of_another_layout) {
    const auto refusal = [](std::span<const std::byte> block) {
        const auto opened = map::View::open(block);
        return opened ? Sentence{} : opened.error();
    };
    std::vector<std::uint64_t> copy(seen.size() / 8);
    std::memcpy(copy.data(), seen.data(), seen.size());
    const auto bytes = std::as_writable_bytes(std::span{copy});
    auto& header = *reinterpret_cast<map::Header*>(copy.data());
    EXPECT_TRUE(refusal(bytes).empty());
    EXPECT_FALSE(refusal(bytes.first(100)).empty());
    EXPECT_FALSE(refusal(bytes.first(4096)).empty()) << "shorter than it says";
    const map::Header good = header;
    header.layout_version = map::layout_version + 1;
    EXPECT_NE(refusal(bytes).view().find("use the browser that was built with the firmware"),
              std::string_view::npos);
    header = good;
    header.facets.count = 1u << 30;
    EXPECT_FALSE(refusal(bytes).empty());
    header = good;
    header.texts.at = 0xfffffff0u;
    EXPECT_FALSE(refusal(bytes).empty());
    header = good;
    header.ready = 0;
    EXPECT_NE(refusal(bytes).view().find("still being configured"), std::string_view::npos);
    header = good;
    header.magic[0] = 'X';
    EXPECT_FALSE(refusal(bytes).empty());
}

TEST_F(Map, allows_whole_values_to_be_copied_while_the_machine_writes) {
    // The pose holds two numbers of one step: a torn copy mixes two steps.
    const map::Facet& pose = facet("left", "pose");
    const map::Facet& angle = facet("left", "angle");
    std::atomic<bool> ends{false};
    std::thread machine{[&] {
        for (int i = 1; i <= 400; ++i) static_cast<void>(world.run_until(at_ns(0) + i * 5ms));
        ends = true;
    }};
    std::size_t whole = 0;
    while (!ends || whole == 0) {
        Pose seen_pose;
        double seen_angle = 0;
        const bool good = view.consistent(0, 100, [&] {
            seen_pose = value<Pose>(pose.value_at);
            seen_angle = value<double>(angle.value_at);
        });
        if (!good) continue;
        ++whole;
        ASSERT_EQ(seen_pose.x, 2 * seen_angle);
        ASSERT_EQ(seen_pose.turn, static_cast<float>(seen_angle));
    }
    machine.join();
    EXPECT_GT(whole, 0u);
}

TEST_F(Map, reports_a_busy_activity_instead_of_a_torn_value) {
    int copies = 0;
    EXPECT_FALSE(view.consistent(99, 3, [&] { ++copies; })) << "there is no such activity";
    EXPECT_EQ(copies, 0);
}

} // namespace
} // namespace tappet
