// Digital lines as the drivers' components see them; implemented by the kernel's character device and by the
// twin.
#pragma once

#include "drivers/gpio/kind.hpp"
#include "kernel/base/realtime.hpp"
#include "kernel/base/time.hpp"
#include "kernel/component/one_activity.hpp"
#include "kernel/component/wire_counters.hpp"

#include <cstdint>
#include <span>
#include <string_view>

namespace tappet::gpio {

/// One bit per line, in the order of Settings::lines. Values are logical: active-low lines are already
/// inverted.
using Mask = std::uint64_t;
inline constexpr std::size_t most_lines = 64; // of one request

enum class Role : std::uint8_t { input, output };
enum class Bias : std::uint8_t { as_is, disabled, pull_up, pull_down };

struct Line {
    std::string_view name{}; ///< the machine's name for it, used in messages
    unsigned offset = 0;     ///< on its chip; named by the board
    Role role = Role::input;
    bool active_low = false;
    Bias bias = Bias::as_is;
    Duration debounce{};     ///< inputs: done by the kernel; 0: none
    bool safe_value = false; ///< outputs: written by open(), make_safe() and close()
};

struct Settings {
    std::string_view chip{};       ///< "/dev/gpiochip0", or the chip's label
    std::span<const Line> lines{}; ///< at least two: with a single line the kernel hides lost edges
    std::string_view consumer = "tappet";
};

/// A change of an input.
struct Edge {
    std::uint32_t line = 0;   ///< index in Settings::lines
    bool rising = false;      ///< became active
    Time stamp{};             ///< when the kernel's interrupt handler saw it
    std::uint32_t seqno = 0;  ///< sequence number in the request
    std::uint32_t missed = 0; ///< edges lost just before this one, on any line
    bool operator==(const Edge&) const = default;
};

/// Edges were lost; the levels are then read again and replace the lost edges.
struct Gap {
    std::uint32_t missed = 0;
    bool levels_known = false;
    Mask levels = 0;
};

struct EdgeBatch {
    std::size_t count = 0;
    Gap gap{}; ///< gap.missed == 0: nothing was lost
};

struct Levels {
    bool known = false;
    Mask mask = 0;
};

struct Counters {
    std::uint64_t edges = 0;
    std::uint64_t missed = 0; ///< edges that the kernel counted and did not deliver
    std::uint64_t gaps = 0;
    std::uint64_t writes = 0;
    std::uint64_t failures = 0; ///< calls the kernel refused: the chip is gone
    bool operator==(const Counters&) const = default;

    void tell(WireCounters& into) const noexcept { into.add("gpio_edges_lost", missed); }
};

/// All calls are real-time and belong to one activity.
class Device {
public:
    virtual ~Device() = default;

    /// Fills `edges` from its start with the edges since the last call, oldest first.
    virtual EdgeBatch read_edges(std::span<Edge> edges) noexcept TAPPET_REALTIME = 0;
    /// Returns the present levels of all lines.
    virtual Levels levels() noexcept TAPPET_REALTIME = 0;
    /// Sets the outputs in `mask` to their bits in `values`, all at once; ignores inputs in `mask`.
    virtual bool write(Mask mask, Mask values) noexcept TAPPET_REALTIME = 0;
    /// Writes the safe value of every output.
    virtual bool make_safe() noexcept TAPPET_REALTIME = 0;
    [[nodiscard]] virtual Counters counters() const noexcept TAPPET_REALTIME = 0;

    /// Returns the descriptor to wait on; -1 for a twin, which calls its listener instead.
    [[nodiscard]] virtual int wait_handle() const noexcept TAPPET_REALTIME = 0;
    using Listener = void (*)(void*) noexcept TAPPET_REALTIME;
    virtual void set_listener(Listener ready, void* context) noexcept = 0;

protected:
    OneActivity belongs_to_; ///< checked by every call that belongs to the activity; copies do not have it
};

} // namespace tappet::gpio
