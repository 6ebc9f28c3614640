// One connection to one Modbus server: requests and answers; libmodbus and the in-process server stand behind
// it.
#pragma once

#include "drivers/modbus/kind.hpp"
#include "drivers/modbus/registers.hpp"
#include "kernel/base/time.hpp"
#include "kernel/component/one_activity.hpp"

#include <span>

namespace tappet::modbus {

enum class Outcome : std::uint8_t {
    ok,
    exception, ///< the server answered that it will not; see Answer::exception
    timeout,   ///< no answer, or not all of it, in time
    garbled,   ///< an answer to another request, of a wrong length or with a wrong checksum
    refused,   ///< no connection: nobody listens, or the line is not there
    disconnected,
};

struct Answer {
    Outcome outcome = Outcome::ok;
    std::uint8_t exception = 0; ///< Modbus exception code
    Duration took{};            ///< how long the caller was held, or would have been
};

/// Not real-time: each call holds its caller up to the time-out that the transport was given. One thread
/// only. After anything but `ok` and `exception` the stream may be out of step: call recover() before the
/// next request.
class Transport {
public:
    virtual ~Transport() = default;

    virtual Answer connect() noexcept = 0;
    virtual void disconnect() noexcept = 0;
    /// Drops late answers. True when the connection can still be used, false when it had to be closed.
    virtual bool recover() noexcept = 0;

    /// `values` are words, or 0 and 1 for the tables of bits; at most 125.
    virtual Answer read(Table table, std::uint16_t address, std::span<std::uint16_t> values) noexcept = 0;
    virtual Answer write(Table table, std::uint16_t address,
                         std::span<const std::uint16_t> values) noexcept = 0;

protected:
    OneActivity belongs_to_; ///< checked by every call that belongs to the activity; no copy has it
};

} // namespace tappet::modbus
