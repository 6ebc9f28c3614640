// The simulated carpet loom at the other end of the machine's wires, in any world.
#pragma once

#include "apps/carpet_loom/maps.hpp"
#include "apps/carpet_loom/plant/options.hpp"
#include "apps/carpet_loom/plant/plant.hpp"
#include "drivers/can/far_end.hpp"
#include "drivers/gpio/far_end.hpp"
#include "drivers/modbus/far_end.hpp"
#include "drivers/plant/plant.hpp"

#include <optional>

namespace tappet::carpet {

/// Weaves until its last pick is woven and the shaft stands.
class Plant final : public tappet::Plant {
public:
    /// No fault occurs unless options request one.
    explicit Plant(std::uint64_t seed) : Plant{loom::Settings{}, seed} {}
    Plant(const loom::Settings& settings, std::uint64_t seed) : settings_{settings}, seed_{seed} {}

    Time move(Time now) override;
    [[nodiscard]] Time next_edge() const override {
        const Time next = loom().next_contact();
        return next == never ? never : next + origin_.value_or(Duration::zero());
    }
    [[nodiscard]] std::optional<Time> leap(Time until) override;
    [[nodiscard]] std::string_view usage() const override { return loom::usage(); }
    bool take_option(std::string_view option, std::string_view value, Sentence& fault) override;
    [[nodiscard]] bool is_done() const override {
        return settings_.last_pick != 0 && settings_.picks_after_told == 0 && has_woven(settings_.last_pick);
    }
    [[nodiscard]] Duration usual_time() const override {
        return settings_.last_pick == 0 ? Duration{60s} : 30s + settings_.last_pick * 2s;
    }
    void told() override;
    [[nodiscard]] Sentence fault() const override;
    void report(JsonText& json) const override { loom::write_json(loom().report(), json); }
    [[nodiscard]] std::uint64_t digest() const override { return loom().report().digest; }

    /// Returns true when at least `picks` are woven and the shaft stands.
    [[nodiscard]] bool has_woven(std::uint64_t picks) const {
        return loom_ && loom_->picks() >= picks && loom_->speed_rpm() == 0.0;
    }
    [[nodiscard]] loom::Plant& loom() {
        if (!loom_) loom_.emplace(settings_, seed_); // its options are known by now
        return *loom_;
    }
    [[nodiscard]] const loom::Plant& loom() const { return const_cast<Plant*>(this)->loom(); }

private:
    void begin();
    void take_wires(Time own);
    void give_frames(Time now);
    void give_lines(Time now);
    void exchange_registers();

    can::RawFarEnd can_{ends, "loom-can"};
    gpio::FarEnd<io_lines> io_{ends, "loom-io"};
    modbus::FarEnd<utility_registers> utility_{ends, "loom-utility"};
    loom::Settings settings_;
    std::uint64_t seed_;
    std::optional<loom::Plant> loom_{};
    struct {
        std::uint64_t steps = ~std::uint64_t{0};
        std::uint32_t changes = 0;
    } exchanged_{};                    // last exchanged: the climate's steps, the tables' changes
    std::optional<Duration> origin_{}; // the plant's own time begins at Time{}
};

} // namespace tappet::carpet
