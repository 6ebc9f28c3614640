// Digital lines behind Linux's GPIO character device, by libgpiod 2, in a single request.
#pragma once

#include "drivers/gpio/line_plan.hpp"

#include <array>
#include <memory>

struct gpiod_line_request;
struct gpiod_edge_event_buffer;

namespace tappet::gpio {

class Lines final : public PlannedLines {
public:
    Lines() = default;
    ~Lines() override { close(); }

    /// Opens the lines. Not real-time; allocates everything that the real-time calls use. Outputs take their
    /// safe values. On failure nothing stays open, and the error states cause and cure.
    std::expected<void, Sentence> open(const Settings& settings);
    /// Writes the safe values and releases the lines. Not real-time. The chip decides the level of a released
    /// line (some fall back to their pull): where that matters, the wiring must pull it to its safe value.
    void close() noexcept;

    EdgeBatch read_edges(std::span<Edge> edges) noexcept TAPPET_REALTIME override;
    Levels levels() noexcept TAPPET_REALTIME override;
    bool write(Mask mask, Mask values) noexcept TAPPET_REALTIME override;
    [[nodiscard]] int wait_handle() const noexcept TAPPET_REALTIME override { return fd_; }
    void set_listener(Listener, void*) noexcept override {} // the descriptor becomes readable instead

private:
    struct Release {
        void operator()(gpiod_line_request* request) const noexcept;
        void operator()(gpiod_edge_event_buffer* buffer) const noexcept;
    };
    static constexpr std::size_t edges_at_once = 8; ///< libgpiod clears room for this many in each read

    [[nodiscard]] std::size_t fetch(std::span<Edge> edges) noexcept TAPPET_REALTIME;
    [[nodiscard]] std::uint32_t index_of(unsigned offset) const noexcept TAPPET_REALTIME;

    std::array<unsigned, most_lines> offsets_{};
    std::size_t lines_ = 0;
    std::unique_ptr<gpiod_line_request, Release> request_{};
    std::unique_ptr<gpiod_edge_event_buffer, Release> buffer_{};
    int fd_ = -1;
};

} // namespace tappet::gpio
