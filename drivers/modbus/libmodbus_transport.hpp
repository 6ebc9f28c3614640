// Modbus TCP and RTU by libmodbus, with its own recovery off: what goes wrong is for the client to decide.
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
        address{}; ///< numeric IPv4: a name would be looked up, for as long as that takes, at each connect
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
    /// To connect, and from a request to the end of its answer, however its bytes come. A serial line needs
    /// the time of the longest answer too: 255 bytes take 150 ms at 19200 baud.
    Duration answer_within = 300ms;
};

/// On a serial line nothing in an answer tells which question it belongs to. So each request waits for the
/// silence of 3.5 characters (Modbus over serial line V1.02, 2.5.1.1), and after an answer that did not come,
/// or was garbled, for once more the time that it had; what arrives meanwhile is thrown away. A server that
/// answers later still, twice as late as `answer_within`, is not told apart.
class LibmodbusTransport final : public Transport {
public:
    LibmodbusTransport() = default;
    ~LibmodbusTransport() override { close(); }

    /// Checks and prepares; does not connect. The error says what is wrong and how to cure it.
    std::expected<void, Sentence> open(const TransportSettings& settings);
    void close() noexcept;
    /// The next call holds its caller no longer, nor longer than the settings say.
    void wait_at_most(Duration limit) noexcept;
    [[nodiscard]] bool is_serial() const noexcept { return is_serial_; }

    Answer connect() noexcept override;
    void disconnect() noexcept override;
    bool recover() noexcept override;
    Answer read(Table table, std::uint16_t address, std::span<std::uint16_t> values) noexcept override;
    Answer write(Table table, std::uint16_t address, std::span<const std::uint16_t> values) noexcept override;

private:
    [[nodiscard]] bool forgets_what_is_lost() const noexcept;
    /// Before each request. False: the time is over before the line may be asked.
    [[nodiscard]] bool settle() noexcept;
    Answer end(int result, int expected, int error, Time began) noexcept;
    struct Free {
        void operator()(_modbus* context) const noexcept;
    };
    std::unique_ptr<_modbus, Free> context_{};
    Duration answer_within_{};
    Duration limit_{};   ///< of a call, at most answer_within_
    Duration silence_{}; ///< of 3.5 characters; none: no serial line
    Time quiet_until_{};
    Time ends_ = never; ///< the next call, when wait_at_most said so
    bool is_serial_ = false;
    bool connected_ = false;
};

} // namespace tappet::modbus
