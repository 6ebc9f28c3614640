// The plant's end of digital lines on the bench: gpio-sim's files, kept open, written and read at offset 0.
#pragma once

#include "drivers/gpio/far_end.hpp"
#include "drivers/twin/bench_end.hpp"

#include <array>
#include <span>
#include <string>
#include <vector>

namespace tappet::gpio {

/// Not real-time.
class BenchLines final : public BenchEnd, public Wires {
public:
    static constexpr const DeviceKind& kind = device_kind;

    BenchLines();
    ~BenchLines() override;

    /// The bench provides /dev/NAME for the machine, and /sim/NAME for the plant.
    std::expected<void, Sentence> open(const DevicePlace& place) override;
    /// `folder` holds sim_gpio<n>/pull and sim_gpio<n>/value; the binding states the lines' offsets.
    std::expected<void, Sentence> open_at(const std::string& folder, std::span<const LineRow> map,
                                          std::span<const Fact> bound);
    ProvidedDevice provided(std::string_view name) noexcept override { return provide<Wires>(name, *this); }

    bool drive(std::size_t line, bool active, Time at) noexcept override;
    /// Reads the actuators at each call, outputs of a port each `slow_period`: reading takes an emulator some
    /// time.
    void look(Time now) override;
    [[nodiscard]] Mask outputs() const noexcept override { return outputs_; }
    /// The change was between two readings: the middle is the best estimate.
    [[nodiscard]] Time changed_at(Time) const noexcept override { return last_ + (looked_ - last_) / 2; }
    [[nodiscard]] std::uint64_t failures() const noexcept override { return failures_; }

private:
    struct Later {
        std::size_t line;
        bool active;
        Time at;
    };
    static constexpr Duration slow_period = 5ms;
    bool pull(std::size_t line, bool active) noexcept;

    std::span<const LineRow> map_{};
    std::array<int, most_lines> files_; ///< of an input its pull file, of an output its value file
    std::vector<Later> later_{};
    Mask outputs_ = 0;
    Time last_{}, looked_{}, slow_at_{};
    std::uint64_t failures_ = 0;
};

} // namespace tappet::gpio
