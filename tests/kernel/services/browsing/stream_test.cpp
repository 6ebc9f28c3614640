// Events sent to browsers: the subscriptions of one client cost no client of a higher role its events.
#include "tests/kernel/services/browsing/press_rig.hpp"

#include <gmock/gmock.h>

namespace tappet {
namespace {

using press::Talker;

/// Frequent events, and a rare one.
struct Ticker {
    Event<> a, b, c, d, e, f, g, h, i, j;
    Event<std::int64_t> alarm;
    std::int64_t steps = 0;
    void step(const Cycle&) noexcept TAPPET_REALTIME {
        for (int n = 0; n < 3; ++n)
            for (Event<>* const each : {&a, &b, &c, &d, &e, &f, &g, &h, &i, &j}) each->emit();
        if (++steps % 100 == 0) alarm.emit(steps / 100);
    }
    static constexpr auto interface() {
        return facets(
            event<&Ticker::a>("a", "ticks"), event<&Ticker::b>("b", "ticks"), event<&Ticker::c>("c", "ticks"),
            event<&Ticker::d>("d", "ticks"), event<&Ticker::e>("e", "ticks"), event<&Ticker::f>("f", "ticks"),
            event<&Ticker::g>("g", "ticks"), event<&Ticker::h>("h", "ticks"), event<&Ticker::i>("i", "ticks"),
            event<&Ticker::j>("j", "ticks"), event<&Ticker::alarm>("alarm", "its number"));
    }
};

// clang-format off
constexpr auto table = machine("ticking",
    components(component<Ticker>("ticker"), component<BrowserService>("browser", set("log", false))),
    activities(activity("motion",  every(1ms), budget(50us), runs("ticker")),
               activity("browser", every(20ms), not_real_time, stack(256 * 1024), runs("browser"))),
    connections(), reactions(), behaviours());
// clang-format on

using Subscriptions = press::Browsed<table>;

TEST_F(Subscriptions, of_observers_cost_higher_roles_no_events_and_no_counted_losses) {
    if (geteuid() != 0) GTEST_SKIP() << "only root can connect as somebody else";
    /// The number it receives in two seconds, in which twenty are emitted.
    const auto alarms_of = [&](Talker& who) {
        int told = 0;
        for (int i = 0; i < 100; ++i) {
            run(20ms);
            for (std::string each = who.receive(); !each.empty(); each = who.receive()) {
                if (each.find("ticker.alarm") == std::string::npos) continue;
                EXPECT_THAT(each, testing::HasSubstr(R"("lost": 0)"));
                ++told;
            }
        }
        return told;
    };
    Talker engineer{path()};
    ASSERT_TRUE(engineer.send("1 subscribe ticker.alarm"));
    run(60ms);
    Talker observer{path(), 65534};
    for (const char* each : {"a", "b", "c", "d", "e", "f", "g", "h", "i", "j"})
        ASSERT_TRUE(observer.send(std::string{"2 subscribe ticker."} + each));
    EXPECT_NEAR(alarms_of(engineer), 20, 1);
    Talker late{path()};
    ASSERT_TRUE(late.send("3 subscribe ticker.alarm"));
    run(60ms);
    EXPECT_NEAR(alarms_of(late), 20, 1);
}

} // namespace
} // namespace tappet
