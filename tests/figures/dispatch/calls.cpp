// A method, a change of properties, a cam row.
#include "tests/figures/dispatch/groups.hpp"
#include "tests/figures/dispatch/machine.hpp"

#include "kernel/cam/schedule.hpp"
#include "kernel/component/property_transaction.hpp"

#include <functional>
#include <mutex>

namespace tappet::figures {

namespace {

// ---- a method

double sum = 0;
void method(std::size_t times) {
    const Emitter& emitter = *measured().emitter;
    for (std::size_t i = 0; i < times; ++i) sum += emitter.scaled(2.0).value_or(0.0);
    keep(sum);
}
[[gnu::noinline]] double scaled(void* context, double value) noexcept {
    return static_cast<Listener*>(context)->scaled(value);
}
double (*volatile pointer)(void*, double) noexcept = &scaled;
void call_pointer(std::size_t times) {
    Listener* const listener = measured().listener[0];
    for (std::size_t i = 0; i < times; ++i) sum += pointer(listener, 2.0);
    keep(sum);
}
void call_function(std::size_t times) {
    static std::function<double(double)> function = [at = measured().listener[0]](double value) {
        return at->scaled(value);
    };
    for (std::size_t i = 0; i < times; ++i) sum += function(2.0);
    keep(sum);
}

// ---- properties

struct Tuned {
    Property<double> p{1.0}, i{2.0}, d{3.0}, limit{4.0};
    double sum = 0;
    Sentence accepts(const Proposal& proposal) const noexcept TAPPET_REALTIME {
        if (proposal.of(p) > proposal.of(limit)) return Sentence{"p exceeds its limit; lower it"};
        return {};
    }
    void changed() noexcept TAPPET_REALTIME { sum += p.get(); }
    static constexpr auto interface() {
        return facets(property<&Tuned::p>("p", "", "gain"), property<&Tuned::i>("i", "", "gain"),
                      property<&Tuned::d>("d", "", "gain"), property<&Tuned::limit>("limit", "", "of p"));
    }
};
Tuned tuned;
PropertyTransaction transaction;
void propose(std::size_t) {
    transaction.begin("tuned", component_type<Tuned>, &tuned);
    for (std::size_t f = 0; f < 4; ++f) {
        const double value = static_cast<double>(f);
        std::memcpy(transaction.change(f), &value, sizeof value);
    }
}
void propose_and_commit(std::size_t times) {
    for (std::size_t i = 0; i < times; ++i) {
        propose(1);
        transaction.commit();
    }
}
void commit(std::size_t times) {
    for (std::size_t i = 0; i < times; ++i) transaction.commit();
}
std::array<double, 4> proposed{};
std::array<double, 4> current{};
void copy_under_mutex(std::size_t times) {
    static std::mutex mutex;
    for (std::size_t i = 0; i < times; ++i) {
        const std::lock_guard locked{mutex};
        keep(proposed);
        if (proposed[0] <= proposed[3]) current = proposed;
        keep(current);
    }
}
void copy_four(std::size_t times) {
    for (std::size_t i = 0; i < times; ++i) {
        keep(proposed);
        if (proposed[0] <= proposed[3]) current = proposed;
        keep(current);
    }
}

// ---- cam rows

constexpr std::size_t cam_rows = 16;
constexpr auto cams = [] {
    CamTable<cam_rows> table{{}, 700_rpm};
    for (std::size_t i = 0; i < cam_rows; ++i) {
        table.rows[i] =
            cam("row", at(Rotation::degrees(10.0 + 20.0 * static_cast<double>(i))), dead_time(2ms));
    }
    return table;
}();

/// A shaft that turns evenly at 600 turns a minute, sampled every ms.
struct Shaft {
    ShaftEstimator estimator{ShaftProperties{}};
    CamSchedule<cam_rows> schedule{cams};
    std::int64_t sample = 0;
    double fired = 0;

    Shaft() {
        for (int i = 0; i < 200; ++i) take_sample();
    }
    [[nodiscard]] Time now() const { return at_ns(sample * 1'000'000); }
    void take_sample() {
        ++sample;
        estimator.sample(static_cast<std::uint32_t>(sample * 4096 / 100 % 4096), now());
    }
    void fire_due() {
        schedule.advance(std::max(now(), schedule.next_due()),
                         [this](const CamEvent& event) noexcept TAPPET_REALTIME { fired += event.late_deg; });
    }
};
Shaft& shaft() {
    static Shaft turning;
    return turning;
}
void estimate(std::size_t times) {
    Shaft& turning = shaft();
    for (std::size_t i = 0; i < times; i += cam_rows) turning.take_sample();
}
void predict_rows(std::size_t times) {
    Shaft& turning = shaft();
    for (std::size_t i = 0; i < times; i += cam_rows)
        turning.schedule.update(turning.estimator, turning.now());
}
struct Line {
    double position, velocity;
    std::array<double, cam_rows> angles, due;
};
/// Calculates the time at which an even motion reaches each angle.
void predict_line(std::size_t times) {
    static Line line{5.0, 3600.0, {}, {}};
    for (std::size_t i = 0; i < times; i += cam_rows) {
        keep(line);
        double next = 1e9;
        for (std::size_t row = 0; row < cam_rows; ++row) {
            line.due[row] = (line.angles[row] - line.position) / line.velocity;
            next = std::min(next, line.due[row]);
        }
        keep(next);
        keep(line);
    }
}
/// Fires due rows: at this speed every sixth sample has one.
void next_sample(std::size_t) {
    Shaft& turning = shaft();
    do {
        turning.fire_due();
        turning.take_sample();
        turning.schedule.update(turning.estimator, turning.now());
    } while (turning.schedule.next_due() == never);
}
void fire_row(std::size_t) { shaft().fire_due(); }

struct Due {
    Time when;
    void (*function)(void*, double) noexcept;
    void* context;
};
[[gnu::noinline]] void hear(void* context, double value) noexcept {
    static_cast<Listener*>(context)->hear(value);
}
Due due{at_ns(5), &hear, nullptr};
void fire_bare(std::size_t times) {
    due.context = measured().listener[0];
    Time now = at_ns(7);
    for (std::size_t i = 0; i < times; ++i) {
        keep(now);
        keep(due);
        if (due.when <= now) due.function(due.context, 1.0);
    }
}

} // namespace

void add_calls(std::vector<Group>& groups) {
    groups.push_back({"dispatch.method",
                      "a method of a peer, called",
                      "thesis 4.5.1",
                      64,
                      {{"MethodCall", Standing::ours, &method},
                       {"call through a function pointer", Standing::floor, &call_pointer},
                       {"std::function", Standing::peer, &call_function}}});
    groups.push_back({"dispatch.properties",
                      "four properties changed as one",
                      "thesis 4.7.1",
                      64,
                      {{"commit, in the engine", Standing::ours, &commit, &propose},
                       {"proposed and committed", Standing::ours, &propose_and_commit},
                       {"compare and copy", Standing::floor, &copy_four},
                       {"compare and copy under std::mutex", Standing::peer, &copy_under_mutex}}});
    groups.push_back({"dispatch.cam.row",
                      "a cam row predicted anew upon a sample of the shaft, one of 16",
                      "thesis 3.1, 5.2",
                      cam_rows,
                      {{"update", Standing::ours, &predict_rows, &estimate},
                       {"angle over an even speed, and the least", Standing::floor, &predict_line}}});
    groups.push_back({"dispatch.cam.fire",
                      "a cam row of 16 fired when it is due",
                      "thesis 3.1, 5.2",
                      1,
                      {{"advance", Standing::ours, &fire_row, &next_sample},
                       {"compare and call through a function pointer", Standing::floor, &fire_bare}}});
}

} // namespace tappet::figures
