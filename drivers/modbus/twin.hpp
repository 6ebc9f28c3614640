// A Modbus server of the host world: the client's transport on one side, the plant's registers on the other.
#pragma once

#include "drivers/modbus/far_end.hpp"
#include "drivers/modbus/transport.hpp"

#include <atomic>

namespace tappet::modbus {

enum class Fault : std::uint8_t {
    none,
    silent,            ///< accepts requests and never answers
    slow,              ///< answers after `slow_by`; after the time-out, the answer meets the next request
    exception,         ///< answers with an exception code
    wrong_transaction, ///< answers another request
    garbage_length,    ///< answers too much or too little
    down,              ///< closes the connection and refuses new ones
};

/// All addresses of its tables exist. The transport's calls belong to the client's thread, the others to the
/// plant's. It never blocks: an answer states how long the caller would have waited, so it works under
/// virtual time.
class Twin final : public Transport, public ServerTables {
public:
    explicit Twin(Duration answer_within = 300ms, Duration turnaround = 2ms) noexcept
        : answer_within_{answer_within}, turnaround_{turnaround} {}

    Answer connect() noexcept override;
    void disconnect() noexcept override;
    bool recover() noexcept override;
    Answer read(Table table, std::uint16_t address, std::span<std::uint16_t> values) noexcept override;
    Answer write(Table table, std::uint16_t address, std::span<const std::uint16_t> values) noexcept override;

    // The plant's side; wait-free.
    /// Applies the fault to the next `requests` requests, or to all until the next call; `down` counts
    /// connects, too.
    void inject(Fault fault, std::uint32_t requests = ~0u) noexcept;
    void set_exception(std::uint8_t code) noexcept { exception_.store(code, std::memory_order_relaxed); }
    void set_slow_by(Duration by) noexcept { slow_by_ns_.store(by.count(), std::memory_order_relaxed); }

private:
    [[nodiscard]] Fault strike() noexcept;
    /// Returns the result of a request before any register is accessed.
    [[nodiscard]] Answer admit(std::uint16_t address, std::size_t count) noexcept;

    std::atomic<Fault> fault_{Fault::none};
    std::atomic<std::uint32_t> strikes_left_{0};
    std::atomic<std::uint8_t> exception_{4};
    std::atomic<std::int64_t> slow_by_ns_{0};
    Duration answer_within_;
    Duration turnaround_;
    bool connected_ = false;
    bool late_answer_ = false; ///< a late answer is pending and would meet the next request
};

} // namespace tappet::modbus
