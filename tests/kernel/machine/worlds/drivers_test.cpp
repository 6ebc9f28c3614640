// Two drivers in one activity: a stopped driver does not disturb the other.
#include "tests/kernel/machine/real_rig.hpp"

#include <sys/eventfd.h>
#include <unistd.h>

namespace tappet {
namespace {

/// Receives the data written to its descriptor.
struct Ear {
    static constexpr DeviceKind device_kind{.name = "test.ear", .is_opened_by_driver = true};
    static constexpr bool woken_by_device = true;
    std::atomic<std::uint64_t> heard{0};
    int descriptor = -1;

    ~Ear() { ::close(descriptor); }
    Sentence configure(Setup& setup) {
        descriptor = ::eventfd(0, EFD_NONBLOCK);
        return setup.woken_by(descriptor);
    }
    void step(const Cycle&) noexcept TAPPET_REALTIME {
        std::uint64_t more = 0;
        TAPPET_ESCAPE("a descriptor that does not block",
                      if (::read(descriptor, &more, sizeof more) == sizeof more) heard += more);
    }
    static constexpr auto interface() { return std::array<Facet, 0>{}; }
};
constexpr auto table = machine(
    "ears", components(component<Ear>("left", device("left")), component<Ear>("right", device("right"))),
    activities(activity("drivers", on_device("left"), at_most(8, 2ms), runs("left", "right"), deadline(1ms),
                        budget(30us))),
    connections(), reactions(), behaviours());
constexpr Board twin_board = [] {
    Board board = real_board;
    board.simulated = true;
    return board;
}();

TEST_F(InRealTime, a_stopped_driver_does_not_disturb_others_of_its_activity) {
    RealRig<table, twin_board> rig;
    ASSERT_TRUE(rig.runs());
    RealWorld& world = rig.world;
    auto&& life = rig.instance.life();
    Ear &left = rig.the<Ear>("left"), &right = rig.the<Ear>("right");
    const auto is_heard_by = [&](Ear& ear) {
        const std::uint64_t before = ear.heard, one = 1;
        EXPECT_EQ(::write(ear.descriptor, &one, sizeof one), static_cast<ssize_t>(sizeof one));
        for (int n = 0; n < 500 && ear.heard == before; ++n) world.supervise(10ms);
        return ear.heard != before;
    };
    EXPECT_TRUE(is_heard_by(left));
    life.ask_component(1, LifeChange::stop);
    while (life.state_of(1) != ComponentState::stopped) world.supervise(10ms);
    EXPECT_TRUE(is_heard_by(left));
    const std::uint64_t before = right.heard, one = 1;
    EXPECT_EQ(::write(right.descriptor, &one, sizeof one), static_cast<ssize_t>(sizeof one));
    world.supervise(50ms);
    EXPECT_EQ(right.heard, before) << "it stands";
    life.ask_component(1, LifeChange::start);
    while (life.state_of(1) != ComponentState::running) world.supervise(10ms);
    EXPECT_TRUE(is_heard_by(right));
    EXPECT_EQ(world.stop(), 0u);
}

/// Says that its device wakes, and lets it wake nobody.
struct Mute {
    static constexpr DeviceKind device_kind{.name = "test.mute", .is_opened_by_driver = true};
    static constexpr bool woken_by_device = true;
    Sentence configure(Setup&) { return {}; }
    void step(const Cycle&) noexcept TAPPET_REALTIME {}
    static constexpr auto interface() { return std::array<Facet, 0>{}; }
};
/// Lets its device wake, and does not say so.
struct Secret {
    static constexpr DeviceKind device_kind{.name = "test.secret", .is_opened_by_driver = true};
    int descriptor = -1;
    ~Secret() { ::close(descriptor); }
    Sentence configure(Setup& setup) { return setup.woken_by(descriptor = ::eventfd(0, EFD_NONBLOCK)); }
    void step(const Cycle&) noexcept TAPPET_REALTIME {}
    static constexpr auto interface() { return std::array<Facet, 0>{}; }
};
template <class Driver>
constexpr auto alone = machine("alone", components(component<Driver>("driver", device("it"))),
                               activities(activity("driver", every(10ms), not_real_time, runs("driver"))),
                               connections(), reactions(), behaviours());
template <class Driver> std::string refusal_at_start() {
    os::Clock clock{os::Clock::Kind::virtual_time};
    MachineInstance instance{AtRunTime<alone<Driver>, twin_board>::machine(), clock};
    const auto configured = instance.configure({});
    return configured ? "" : std::string{configured.error().view()};
}

TEST(DriverWake, is_what_its_type_says) {
    const std::string mute = refusal_at_start<Mute>(), secret = refusal_at_start<Secret>();
    EXPECT_TRUE(mute.starts_with("component \"driver\": its type tappet::") &&
                mute.ends_with(
                    "Mute says woken_by_device, but its configure() never called Setup::woken_by(), so its "
                    "device would wake nobody; call it there, or remove woken_by_device"))
        << mute;
    EXPECT_TRUE(
        secret.ends_with("Secret calls Setup::woken_by() but does not say so; add static constexpr bool "
                         "woken_by_device = true to it"))
        << secret;
    EXPECT_EQ(refusal_at_start<Ear>(), "");
}

} // namespace
} // namespace tappet
