// Data flow between the components of a machine (thesis 4.4): for any type, within one activity and across
// two, one to many and many to one, with every policy of a row.
#include "kernel/base/random.hpp"
#include "kernel/machine/check/flow.hpp"
#include "tests/kernel/machine/virtual_rig.hpp"

#include <Eigen/Core>

#include <cstdint>
#include <deque>
#include <limits>
#include <string>

namespace tappet {
namespace {

/// A user's struct with a fixed-size Eigen member.
struct Wrench {
    Eigen::Vector3d force{0, 0, 0};
    std::int16_t frame = 0;
    friend bool operator==(const Wrench&, const Wrench&) = default;
};

} // namespace

template <>
inline constexpr bool copied_as_bytes<Wrench> = true;

namespace {

using RowMajor = Eigen::Matrix<float, 2, 3, Eigen::RowMajor>;

/// The k-th value of a type: no two are equal, and none is T{} (k from 1 to 99).
template <class T>
T nth(int k) {
    if constexpr (FixedSizeEigen<T>) {
        T value;
        for (Eigen::Index i = 0; i < value.size(); ++i)
            value(i / T::ColsAtCompileTime, i % T::ColsAtCompileTime) =
                static_cast<typename T::Scalar>(100 * i + k);
        return value;
    } else if constexpr (std::same_as<T, Wrench>) {
        return {nth<Eigen::Vector3d>(k), static_cast<std::int16_t>(-k)};
    } else if constexpr (std::same_as<T, Text<12>>) {
        Text<12> text;
        EXPECT_TRUE(text.assign("pick " + std::to_string(k)));
        return text;
    } else {
        return static_cast<T>(k);
    }
}

template <class T>
struct Given {
    static inline const T substitute = nth<T>(98);
    static inline const T initial = nth<T>(99);
};

template <class T>
struct Source {
    Output<T> value;
    BufferOutput<T> all;
    T next = nth<T>(1);
    bool writes = false;
    bool pushes = false;
    bool pushed = false;
    void step(const Cycle&) noexcept TAPPET_REALTIME {
        if (writes) value.write(next);
        if (pushes) pushed = all.push(next);
        writes = pushes = false;
    }
    static constexpr auto interface() {
        return facets(output<&Source::value>("value", "", "the last one"),
                      output<&Source::all>("all", "", "each of them"));
    }
};

template <class T>
struct Sink {
    Input<T> value;
    BufferInput<T> all;
    Flow flow = Flow::stale;
    T seen = nth<T>(97);
    Time stamp{};
    std::uint64_t steps = 0;
    bool drains = false;
    Bounded<T, 32> drained;
    void step(const Cycle&) noexcept TAPPET_REALTIME {
        ++steps;
        flow = value.read(seen);
        stamp = value.stamp();
        if (!drains) return;
        for (T each = seen; !drained.full() && all.pop(each);) static_cast<void>(drained.push(each));
    }
    static constexpr auto interface() {
        return facets(input<&Sink::value>("value", "", "the last one", optional),
                      input<&Sink::all>("all", "", "each of them", optional));
    }
};

// clang-format off
template <class T>
inline constexpr auto table = machine("flow",
    components(component<Source<T>>("source"), component<Source<T>>("other"),
               component<Sink<T>>("near"), component<Sink<T>>("far"), component<Sink<T>>("holder"), component<Sink<T>>("plain"),
               component<Sink<T>>("bare")),
    activities(activity("motion", every(1ms), runs("near", "other", "source", "holder"), budget(10us)),
               activity("logic",  every(5ms), runs("far", "plain", "bare"),            budget(10us))),
    connections(data("source.value", "near.value",   stale_after(3ms), substitute<Given<T>::substitute>(), initially<Given<T>::initial>()),
                data("source.value", "holder.value", stale_after(3ms), hold),
                data("source.value", "far.value",    stale_after(12ms), substitute<Given<T>::substitute>()),
                data("other.value",  "plain.value",  initially<Given<T>::initial>()),
                data("other.value",  "bare.value"),
                buffer<3>("source.all", "near.all",  drop_oldest),
                buffer<2>("other.all",  "near.all",  reject_newest),
                buffer<3>("source.all", "far.all",   reject_newest),
                buffer<2>("other.all",  "far.all",   drop_oldest)),
    reactions(), behaviours());
// clang-format on

template <class T>
struct Flows : testing::Test, RunningRig<table<T>> {
    /// Runs one more millisecond.
    void run() { this->pass(1ms); }
    Source<T>& source(std::string_view name) { return this->template the<Source<T>>(name); }
    Sink<T>& sink(std::string_view name) { return this->template the<Sink<T>>(name); }
    Random random{static_cast<std::uint64_t>(testing::UnitTest::GetInstance()->random_seed())};
};

using Types = testing::Types<double, std::int8_t, Text<12>, Eigen::Vector3d, Eigen::Matrix4d, RowMajor,
                             Eigen::Matrix<std::int16_t, 5, 1>, Wrench>;
TYPED_TEST_SUITE(Flows, Types);

TYPED_TEST(Flows, begin_with_the_row_value_before_the_first_value) {
    for (int i = 0; i < 10; ++i) this->run();
    for (const char* name : {"near", "holder", "far", "plain", "bare"}) {
        ASSERT_GT(this->sink(name).steps, 0u);
        EXPECT_EQ(this->sink(name).flow, Flow::never_written) << name;
    }
    EXPECT_EQ(this->sink("near").seen, Given<TypeParam>::initial) << "not the substitute that it has too";
    EXPECT_EQ(this->sink("plain").seen, Given<TypeParam>::initial);
    EXPECT_EQ(this->sink("far").seen, Given<TypeParam>::substitute) << "its row gives nothing else";
    EXPECT_EQ(this->sink("bare").seen, default_value<TypeParam>())
        << "a matrix is zero, not whatever lay there";
}

/// The expected view of a row's reader, computed beside the machine.
template <class T>
struct Expected {
    Time stamp{};
    int k = 0; ///< of the last value; 0: none yet
    bool is_new = false;
    Duration max_age{};

    [[nodiscard]] Flow flow(Time now) const {
        return k == 0                  ? Flow::never_written
               : now - stamp > max_age ? Flow::stale
               : is_new                ? Flow::fresh
                                       : Flow::old;
    }
};

TYPED_TEST(Flows, report_fresh_old_or_stale_to_each_reader_of_one_output) {
    using T = TypeParam;
    Expected<T> near{.max_age = 3ms}, far{.max_age = 12ms};
    std::size_t met[4] = {};
    for (int cycle = 1; cycle <= 2'000; ++cycle) {
        // Writes come in bursts with pauses longer than the longest age.
        const bool writes = (cycle / 40) % 2 == 0 && this->random.below(3) == 0;
        const int k = static_cast<int>(1 + this->random.below(90));
        this->source("source").next = nth<T>(k);
        this->source("source").writes = writes;
        const std::uint64_t far_steps = this->sink("far").steps;
        this->run();
        if (writes)
            for (Expected<T>* each : {&near, &far})
                each->stamp = this->clock.now(), each->k = k, each->is_new = true;
        const Flow flow = near.flow(this->clock.now());
        ++met[static_cast<std::size_t>(flow)];
        ASSERT_EQ(this->sink("near").flow, flow) << "cycle " << cycle;
        ASSERT_EQ(this->sink("holder").flow, flow) << "cycle " << cycle;
        if (near.k != 0) {
            const T value = nth<T>(near.k);
            ASSERT_EQ(this->sink("near").seen, flow == Flow::stale ? Given<T>::substitute : value);
            ASSERT_EQ(this->sink("holder").seen, value) << "held, however old";
            ASSERT_EQ(this->sink("near").stamp, near.stamp);
        }
        near.is_new = near.is_new && flow == Flow::stale;
        if (this->sink("far").steps == far_steps) continue;
        const Flow across = far.flow(this->clock.now());
        ASSERT_EQ(this->sink("far").flow, across) << "cycle " << cycle;
        ASSERT_EQ(this->sink("far").seen,
                  across == Flow::stale || far.k == 0 ? Given<T>::substitute : nth<T>(far.k));
        if (far.k != 0) {
            ASSERT_EQ(this->sink("far").stamp, far.stamp);
        }
        far.is_new = far.is_new && across == Flow::stale;
    }
    for (const Flow each : {Flow::fresh, Flow::old, Flow::stale})
        EXPECT_GT(met[static_cast<std::size_t>(each)], 20u) << "the run met every answer";
}

/// The expected content of one row's buffer, computed beside the machine.
template <class T>
struct Queue {
    std::size_t capacity;
    bool drops;
    std::deque<int> values{};
    bool push(int k) {
        const bool full = values.size() == capacity;
        if (full && !drops) return false;
        if (full) values.pop_front();
        values.push_back(k);
        return true;
    }
};

TYPED_TEST(Flows, give_every_reader_each_buffered_value_in_order_or_drop_by_row) {
    using T = TypeParam;
    struct Reader {
        std::string_view name;
        Queue<T> from_source, from_other;
    };
    Reader readers[] = {{"near", {3, true}, {2, false}}, {"far", {3, false}, {2, true}}};
    std::size_t refused = 0;
    for (int cycle = 1; cycle <= 2'000; ++cycle) {
        bool all_took[2] = {true, true};
        int i = 0;
        for (const char* name : {"source", "other"}) {
            Source<T>& writer = this->source(name);
            const int k = static_cast<int>(1 + this->random.below(90));
            writer.next = nth<T>(k);
            writer.pushes = this->random.below(2) == 0;
            writer.pushed = true;
            if (writer.pushes)
                for (Reader& reader : readers)
                    all_took[i] &= (i == 0 ? reader.from_source : reader.from_other).push(k);
            ++i;
        }
        std::uint64_t steps[2] = {};
        for (std::size_t r = 0; r < 2; ++r) {
            Sink<T>& sink = this->sink(readers[r].name);
            steps[r] = sink.steps;
            sink.drained.clear();
            sink.drains = this->random.below(6) == 0;
        }
        this->run();
        ASSERT_EQ(this->source("source").pushed, all_took[0]) << "cycle " << cycle;
        ASSERT_EQ(this->source("other").pushed, all_took[1]) << "cycle " << cycle;
        refused += !all_took[0] + !all_took[1];
        for (std::size_t r = 0; r < 2; ++r) {
            Sink<T>& sink = this->sink(readers[r].name);
            std::deque<int> expected;
            if (sink.drains && sink.steps != steps[r])
                for (Queue<T>* each : {&readers[r].from_source, &readers[r].from_other}) {
                    expected.insert(expected.end(), each->values.begin(), each->values.end());
                    each->values.clear();
                }
            ASSERT_EQ(sink.drained.size(), expected.size()) << readers[r].name << ", cycle " << cycle;
            for (std::size_t n = 0; n < expected.size(); ++n) ASSERT_EQ(sink.drained[n], nth<T>(expected[n]));
        }
    }
    EXPECT_GT(refused, 20u) << "the run met full buffers";
}

TEST(Flow, through_a_buffer_orders_the_components_of_an_activity) {
    PlacedRig<table<double>> rig;
    const auto place = [&](std::string_view name) {
        return rig.instance.machine().index.position[find_component(rig.instance.machine().table, name)];
    };
    EXPECT_GT(place("near"), place("source")) << "though its row stands first";
    EXPECT_GT(place("near"), place("other")) << "from which it has a buffer only";
}

/// Two components that feed each other within one activity: the reader of the delayed row is one cycle
/// behind.
struct Echo {
    Input<int> heard;
    Output<int> said;
    int last = 0;
    void step(const Cycle&) noexcept TAPPET_REALTIME {
        last = heard.get();
        said.write(last + 1);
    }
    static constexpr auto interface() {
        return facets(input<&Echo::heard>("heard", "", "of the other"),
                      output<&Echo::said>("said", "", "one more"));
    }
};

// clang-format off
inline constexpr auto echoes = machine("echoes",
    components(component<Echo>("one"), component<Echo>("other")),
    activities(activity("motion", every(1ms), runs("other", "one"), budget(10us))),
    connections(data("one.said", "other.heard"), data("other.said", "one.heard", delayed, initially(100))),
    reactions(), behaviours());

template <bool across>
inline constexpr auto guarded = machine("guarded",
    components(component<Source<double>>("source"), component<Source<double>>("spare"),
               component<Sink<double>>("near"), component<Sink<double>>("far")),
    activities(activity("motion", every(1ms), runs("source", "spare", "near"), budget(10us)),
               activity("logic",  every(5ms), runs("far"),            budget(10us))),
    connections(across ? data("source.value", "far.value", stale_after(20ms), stop_machine)
                       : data("source.value", "near.value", stale_after(20ms), stop_machine)),
    reactions(), behaviours());

/// The same into an activity that only the value's age can wake: no other wake ever comes.
inline constexpr auto guarded_asleep = machine("guarded_asleep",
    components(component<Source<double>>("source"), component<Source<double>>("mute"), component<Sink<double>>("far")),
    activities(activity("motion", every(1ms), runs("source", "mute"), budget(10us)),
               activity("logic",  on_work(), at_most(1, 1ms), runs("far"), deadline(1ms), budget(10us))),
    connections(data("source.value", "far.value", stale_after(20ms), stop_machine),
                buffer<4>("mute.all", "far.all", wakes)),
    reactions(), behaviours());

inline constexpr auto told_when_stale = machine("told_when_stale",
    components(component<Source<double>>("source"), component<Source<double>>("mute"),
               component<Sink<double>>("told"), component<Sink<double>>("untold")),
    activities(activity("motion", every(1ms), runs("source", "mute"), budget(10us)),
               activity("told",   on_work(), at_most(1, 1ms), runs("told"),   deadline(1ms), budget(10us)),
               activity("untold", on_work(), at_most(1, 1ms), runs("untold"), deadline(1ms), budget(10us))),
    connections(data("source.value", "told.value",   stale_after(20ms), hold, wakes),
                data("source.value", "untold.value", stale_after(20ms), hold),
                buffer<4>("mute.all", "untold.all", wakes)),
    reactions(), behaviours());

inline constexpr auto woken = machine("woken",
    components(component<Source<double>>("source"), component<Sink<double>>("by_data"), component<Sink<double>>("by_buffer"),
               component<Sink<double>>("asleep"), component<Source<double>>("mute")),
    activities(activity("motion", every(1ms), runs("source", "mute"), budget(10us)),
               activity("data",   on_work(), at_most(1, 1ms), runs("by_data"),   deadline(1ms), budget(10us)),
               activity("buffer", on_work(), at_most(1, 1ms), runs("by_buffer"), deadline(1ms), budget(10us)),
               activity("asleep", on_work(), at_most(1, 1ms), runs("asleep"),    deadline(1ms), budget(10us))),
    connections(data("source.value",    "by_data.value", wakes),
                buffer<4>("source.all", "by_buffer.all", wakes),
                data("source.value",    "asleep.value"),
                buffer<4>("mute.all",   "asleep.all", wakes)),
    reactions(), behaviours());
// clang-format on

TEST(Flow, by_a_delayed_row_gives_the_value_of_the_previous_cycle) {
    RunningRig<echoes> rig;
    for (int cycle = 0; cycle < 20; ++cycle) {
        EXPECT_TRUE(rig.run(1ms));
        EXPECT_EQ(rig.the<Echo>("one").last, 100 + 2 * cycle);
        EXPECT_EQ(rig.the<Echo>("other").last, 101 + 2 * cycle) << "in the same cycle";
    }
}

template <const auto& machine_table>
void stops_when_the_value_is_stale(std::string_view reader) {
    RunningRig<machine_table> rig;
    for (int cycle = 0; cycle < 60; ++cycle) EXPECT_TRUE(rig.run(1ms)) << "never written is not stale";
    for (int cycle = 0; cycle < 60; ++cycle) {
        rig.template the<Source<double>>("source").writes = cycle % 12 == 0;
        EXPECT_TRUE(rig.run(1ms));
    }
    for (int cycle = 0; cycle < 60 && rig.run(1ms); ++cycle) {
    }
    EXPECT_TRUE(rig.instance.stop_asked());
    EXPECT_EQ(rig.instance.stop_request().reason, StopReason::stale_input);
    EXPECT_EQ(rig.instance.describe_stop().view(),
              Sentence("connection \"source.value\" -> \"", reader,
                       ".value\" is stale: nothing came for more than 20000 us")
                  .view());
}

TEST(Flow, stops_the_machine_when_it_is_stale_and_its_row_says_so) {
    stops_when_the_value_is_stale<guarded<false>>("near");
    stops_when_the_value_is_stale<guarded<true>>("far");
    stops_when_the_value_is_stale<guarded_asleep>("far");
}

TEST(Flow, wakes_its_reader_once_when_it_is_stale_and_its_row_wakes) {
    RunningRig<told_when_stale> rig;
    const Sink<double>& told = rig.the<Sink<double>>("told");
    for (int outage = 0; outage < 3; ++outage) {
        rig.the<Source<double>>("source").writes = true;
        for (int cycle = 0; cycle < 15; ++cycle) EXPECT_TRUE(rig.run(1ms));
        EXPECT_NE(told.flow, Flow::stale);
        const std::uint64_t before = told.steps;
        for (int cycle = 0; cycle < 100; ++cycle) EXPECT_TRUE(rig.run(1ms));
        EXPECT_EQ(told.flow, Flow::stale);
        EXPECT_EQ(told.steps, before + 1);
    }
    EXPECT_EQ(rig.the<Sink<double>>("untold").steps, 0u);
}

TEST(Flow, wakes_the_activities_of_readers_whose_rows_say_so) {
    RunningRig<woken> rig;
    const Sink<double>& by_data = rig.the<Sink<double>>("by_data");
    const Sink<double>& by_buffer = rig.the<Sink<double>>("by_buffer");
    std::uint64_t writes = 0, pushes = 0;
    for (int cycle = 0; cycle < 200; ++cycle) {
        rig.the<Source<double>>("source").writes = cycle % 3 == 0;
        rig.the<Source<double>>("source").pushes = cycle % 4 == 0;
        const std::uint64_t data_before = by_data.steps, buffer_before = by_buffer.steps;
        EXPECT_TRUE(rig.run(1ms));
        writes += cycle % 3 == 0;
        pushes += cycle % 4 == 0;
        if (cycle % 3 == 0) {
            EXPECT_GT(by_data.steps, data_before) << "cycle " << cycle;
        }
        if (cycle % 4 == 0) {
            EXPECT_GT(by_buffer.steps, buffer_before) << "cycle " << cycle;
        }
    }
    EXPECT_LE(by_data.steps, writes + 1) << "at the start perhaps once, and by nothing else";
    EXPECT_LE(by_buffer.steps, pushes + 1);
    EXPECT_LE(rig.the<Sink<double>>("asleep").steps, 1u);
}

/// The check's fault for a number and a port of the type.
template <class T>
std::string fault_of(double number) {
    const Facet port{.name = "value", .type = type_id<T>};
    const ConnectionRow row = data("a.value", "b.value", substitute(number));
    return std::string{checks::check_row_value(row, "substitute", row.substitute, port).view()};
}

TEST(Flow, accepts_only_row_numbers_that_the_port_can_hold) {
    for (const double good : {-128.0, 0.0, 127.0}) EXPECT_EQ(fault_of<std::int8_t>(good), "");
    for (const double bad : {-129.0, 128.0, 0.5, -0.5, 1e300, std::numeric_limits<double>::quiet_NaN()})
        EXPECT_NE(fault_of<std::int8_t>(bad), "") << bad;
    EXPECT_EQ(fault_of<std::uint64_t>(0x1p63), "");
    EXPECT_NE(fault_of<std::uint64_t>(0x1p64), "");
    EXPECT_NE(fault_of<std::uint64_t>(-1), "");
    EXPECT_EQ(fault_of<std::int64_t>(-0x1p63), "");
    EXPECT_NE(fault_of<std::int64_t>(0x1p63), "");
    EXPECT_EQ(fault_of<bool>(1), "");
    EXPECT_NE(fault_of<bool>(2), "");
    EXPECT_EQ(fault_of<float>(0.1), "");
    EXPECT_NE(fault_of<float>(1e39), "");
    for (const double bad :
         {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
        EXPECT_NE(fault_of<float>(bad), "") << bad;
        EXPECT_NE(fault_of<double>(bad), "") << bad;
    }
    EXPECT_NE(fault_of<Text<12>>(0).find(
                  "is not a number; write substitute<constant>() with a constant of that type"),
              std::string::npos);
}

} // namespace
} // namespace tappet
