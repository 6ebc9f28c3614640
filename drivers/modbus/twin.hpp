// A Modbus server of the host world: the client's transport on one side, the plant's registers on the other.
#pragma once

#include "drivers/modbus/far_end.hpp"
#include "drivers/modbus/transport.hpp"

#include <atomic>

namespace tappet::modbus {

enum class Fault : std::uint8_t {
    none,
    silent,    ///< takes requests and never answers
    slow,      ///< answers after `slow_by`; later than the time-out, the answer meets the next request
    exception, ///< answers with an exception code
    wrong_transaction, ///< answers another request
    garbage_length,    ///< answers too much or too little
    down,              ///< closes the connection and refuses new ones
};

/// All of its tables' addresses exist. The transport's calls belong to the client's thread, the rest to the
/// plant's. It holds nobody: an answer says how long the caller would have waited, so that it works under
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
    /// Strikes the next `requests`, or all until told otherwise; `down` counts connects, too.
    void inject(Fault fault, std::uint32_t requests = ~0u) noexcept;
    void set_exception(std::uint8_t code) noexcept { exception_.store(code, std::memory_order_relaxed); }
    void set_slow_by(Duration by) noexcept { slow_by_ns_.store(by.count(), std::memory_order_relaxed); }

private:
    [[nodiscard]] Fault strike() noexcept;
    /// What a request comes to before any register is touched.
    [[nodiscard]] Answer admit(std::uint16_t address, std::size_t count) noexcept;

    std::atomic<Fault> fault_{Fault::none};
    std::atomic<std::uint32_t> strikes_left_{0};
    std::atomic<std::uint8_t> exception_{4};
    std::atomic<std::int64_t> slow_by_ns_{0};
    Duration answer_within_;
    Duration turnaround_;
    bool connected_ = false;
    bool late_answer_ = false; ///< on its way, and would be taken for the next request's
};

} // namespace tappet::modbus
