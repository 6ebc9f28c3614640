// One connection to one Modbus server, with requests and answers; implemented by libmodbus and by the
// in-process server.
#pragma once

#include "drivers/modbus/kind.hpp"
#include "drivers/modbus/registers.hpp"
#include "kernel/base/time.hpp"
#include "kernel/component/one_activity.hpp"

#include <span>

namespace tappet::modbus {

enum class Outcome : std::uint8_t {
    ok,
    exception, ///< the server refused the request; see Answer::exception
    timeout,   ///< no complete answer in time
    garbled,   ///< an answer to another request, of a wrong length or with a wrong checksum
    refused,   ///< no connection: the server does not listen, or the line does not exist
    disconnected,
};

struct Answer {
    Outcome outcome = Outcome::ok;
    std::uint8_t exception = 0; ///< Modbus exception code
    Duration took{};            ///< how long the caller was blocked, or would have been
};

/// Not real-time: each call blocks up to the transport's time-out. One thread only. After any outcome but
/// `ok` and `exception` the stream may be out of step: call recover() before the next request.
class Transport {
public:
    virtual ~Transport() = default;

    virtual Answer connect() noexcept = 0;
    virtual void disconnect() noexcept = 0;
    /// Drops late answers. Returns true when the connection is still usable, false when it had to be closed.
    virtual bool recover() noexcept = 0;

    /// Reads into `values`: words, or 0 and 1 for tables of bits; at most 125.
    virtual Answer read(Table table, std::uint16_t address, std::span<std::uint16_t> values) noexcept = 0;
    virtual Answer write(Table table, std::uint16_t address,
                         std::span<const std::uint16_t> values) noexcept = 0;

protected:
    OneActivity belongs_to_; ///< checked by every call that belongs to the activity; copies do not have it
};

} // namespace tappet::modbus
