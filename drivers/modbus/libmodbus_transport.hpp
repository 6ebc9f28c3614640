// Modbus TCP and RTU by libmodbus, with its own error recovery off, because the client decides about errors.
#pragma once

#include "drivers/modbus/transport.hpp"
#include "kernel/base/text.hpp"
#include "kernel/base/time.hpp"

#include <expected>
#include <memory>
#include <string_view>
#include <variant>

struct _modbus;

namespace tappet::modbus {

struct Tcp {
    std::string_view
        address{}; ///< numeric IPv4: a name would need a look-up, of unknown duration, at each connect
    std::uint16_t port = 502;
};
struct Serial {
    std::string_view device{}; ///< "/dev/ttyS1"
    int baud = 19200;
    char parity = 'E'; ///< 'N', 'E' or 'O'
    int stop_bits = 1;
};

struct TransportSettings {
    std::variant<Tcp, Serial> line{};
    int unit = 1; ///< the server's address: 1 to 247; TCP also 255
    /// Time-out to connect, and from a request to the end of its answer, even if its bytes come slowly. On a
    /// serial line it must include the time of the longest answer: 255 bytes take 150 ms at 19200 baud.
    Duration answer_within = 300ms;
};

/// On a serial line an answer does not identify its request. So each request waits for the silence of 3.5
/// characters (Modbus over serial line V1.02, 2.5.1.1). After a missing or garbled answer the next request
/// waits for another `answer_within`; bytes that arrive in that time are discarded. An even later answer,
/// after more than twice `answer_within`, cannot be recognised.
class LibmodbusTransport final : public Transport {
public:
    LibmodbusTransport() = default;
    ~LibmodbusTransport() override { close(); }

    /// Checks and prepares; does not connect. The error states cause and cure.
    std::expected<void, Sentence> open(const TransportSettings& settings);
    void close() noexcept;
    /// Limits the next call to this time, and to the time-out of the settings.
    void wait_at_most(Duration limit) noexcept;
    [[nodiscard]] bool is_serial() const noexcept { return is_serial_; }

    Answer connect() noexcept override;
    void disconnect() noexcept override;
    bool recover() noexcept override;
    Answer read(Table table, std::uint16_t address, std::span<std::uint16_t> values) noexcept override;
    Answer write(Table table, std::uint16_t address, std::span<const std::uint16_t> values) noexcept override;

private:
    [[nodiscard]] bool forgets_what_is_lost() const noexcept;
    /// Waits until the line is free, before each request. Returns false when the call's time is over first.
    [[nodiscard]] bool settle() noexcept;
    Answer end(int result, int expected, int error, Time began) noexcept;
    struct Free {
        void operator()(_modbus* context) const noexcept;
    };
    std::unique_ptr<_modbus, Free> context_{};
    Duration answer_within_{};
    Duration limit_{};   ///< of one call, at most answer_within_
    Duration silence_{}; ///< of 3.5 characters; 0: not a serial line
    Time quiet_until_{};
    Time ends_ = never; ///< end of the next call, as set by wait_at_most
    bool is_serial_ = false;
    bool connected_ = false;
};

} // namespace tappet::modbus
