// A bus in a periodic activity that is just as fast as its map lets frames cross.
#include "drivers/can/bus.hpp"
#include "drivers/can/twin_bus.hpp"
#include "tests/drivers/components/machine_rig.hpp"

namespace tappet::test {
namespace {

constexpr auto orders = can::signal_map(can::transmit(can::standard(0x201), "order", can::bytes(2),
                                                      can::on_demand(100ms), can::signal("number", 0, 16))
                                            .safe_by_silence());
struct Boss {
    Output<std::int64_t> number{};
    void step(const Cycle&) noexcept TAPPET_REALTIME { number.write(number.last() + 1); }
    static constexpr auto interface() { return facets(output<&Boss::number>("number", "", "of an order")); }
};
using Bus = can::Bus<orders>;
constexpr auto slow =
    machine("slow", components(component<Bus>("can", device("wire")), component<Boss>("boss")),
            activities(activity("can", every(100ms), not_real_time, runs("can")),
                       activity("boss", every(100ms), runs("boss"), budget(20us))),
            connections(data("boss.number", "can.order.number")), reactions(), behaviours());

struct SlowBus : MachineRig<slow> {
    static constexpr std::array sends{can::standard(0x201)};
    SlowBus() {
        EXPECT_TRUE(twin.open({.interface = "machine", .receive = {}, .transmit = sends}));
        EXPECT_TRUE(far_end.open({.interface = "far end", .receive = sends, .transmit = {}}));
        EXPECT_TRUE(wire.attach(twin));
        EXPECT_TRUE(wire.attach(far_end));
        configure<can::Device>("wire", twin);
    }
    Time carry(Time now) override {
        far_end.service(now);
        wire.deliver_until(now);
        for (can::Frame frame; far_end.receive(frame).what != can::Received::none;) ++heard;
        return now + 50us;
    }
    can::TwinBus wire{1};
    can::Twin twin, far_end;
    int heard = 0;
};

TEST_F(SlowBus, sends_each_order_and_takes_no_confirmation_for_missing) {
    run_until(10s);
    EXPECT_FALSE(instance.find<Bus>("can")->is_faulted.last());
    EXPECT_GE(heard, 98);
}

} // namespace
} // namespace tappet::test
