// The plant's end of the GPIO lines: gpio-sim's files, kept open, written and read at offset 0.
#pragma once

#include "apps/carpet_loom/plant/plant.hpp"

#include <expected>
#include <string>

namespace tappet::loom {

class LineWire {
public:
    /// `chip` is the folder in which sim_gpio<n>/pull and sim_gpio<n>/value lie.
    [[nodiscard]] static std::expected<LineWire, std::string> open(const std::string& chip);
    LineWire(LineWire&& other) noexcept;
    LineWire& operator=(LineWire&&) = delete;
    ~LineWire();

    /// Reads the machine's outputs. A changed one changed somewhere since the last look: half-way is the best
    /// guess.
    /// Valve and brake count every microsecond; lamps and cutter are looked at every slow_period.
    void read_outputs(Plant& plant, Time last, Time now);
    /// Drives the machine's inputs by the edges the plant has made.
    void write_inputs(Plant& plant);
    /// Flutters a line and leaves it as it was.
    void flutter(unsigned input, unsigned edges);
    [[nodiscard]] std::uint64_t failures() const { return failures_; }

private:
    LineWire();
    void pull(unsigned input, bool level);
    void read_output(unsigned output, Plant& plant, Time when);

    static constexpr Duration slow_period = 5ms;

    std::array<int, wires::line::input_count> pulls_;
    std::array<int, wires::line::output_count> values_;
    std::array<bool, wires::line::input_count> levels_{};
    Time slow_at_{};
    std::uint64_t failures_ = 0;
};

} // namespace tappet::loom
