// Service data objects (CiA 301, 7.2.4): abort codes, and the layout of values in frames.
#pragma once

#include "drivers/can/signal.hpp"
#include "drivers/canopen/object_dictionary.hpp"

#include <array>

namespace tappet::canopen {

/// Abort codes of the standard (CiA 301, table 22).
enum class SdoAbort : std::uint32_t {
    none = 0,
    toggle_bit = 0x0503'0000,
    time_out = 0x0504'0000,
    unknown_command = 0x0504'0001,
    out_of_memory = 0x0504'0005,
    unsupported_access = 0x0601'0000,
    write_only = 0x0601'0001,
    read_only = 0x0601'0002,
    no_object = 0x0602'0000,
    not_mappable = 0x0604'0041,
    pdo_length = 0x0604'0042,
    parameter_incompatible = 0x0604'0043,
    internally_incompatible = 0x0604'0047,
    hardware = 0x0606'0000,
    wrong_length = 0x0607'0010,
    too_long = 0x0607'0012,
    too_short = 0x0607'0013,
    no_sub_index = 0x0609'0011,
    invalid_value = 0x0609'0030,
    too_high = 0x0609'0031,
    too_low = 0x0609'0032,
    maximum_below_minimum = 0x0609'0036,
    no_resource = 0x060A'0023,
    general = 0x0800'0000,
    not_stored = 0x0800'0020,
    local_control = 0x0800'0021,
    device_state = 0x0800'0022,
    no_dictionary = 0x0800'0023,
    no_data = 0x0800'0024,
};

/// Returns true when the same request may succeed later: the transfer was disturbed, or the device cannot
/// serve it now. The other codes mean that the device lacks the object or rejects the value.
constexpr bool passes(SdoAbort code) noexcept TAPPET_REALTIME {
    switch (code) {
    case SdoAbort::toggle_bit:
    case SdoAbort::time_out:
    case SdoAbort::unknown_command:
    case SdoAbort::out_of_memory:
    case SdoAbort::hardware:
    case SdoAbort::no_resource:
    case SdoAbort::not_stored:
    case SdoAbort::local_control:
    case SdoAbort::device_state: return true;
    default: return false;
    }
}

constexpr std::string_view to_text(SdoAbort code) noexcept TAPPET_REALTIME {
    switch (code) {
    case SdoAbort::none: return "no abort";
    case SdoAbort::toggle_bit: return "toggle bit not alternated";
    case SdoAbort::time_out: return "SDO protocol timed out";
    case SdoAbort::unknown_command: return "command specifier not valid or unknown";
    case SdoAbort::out_of_memory: return "out of memory";
    case SdoAbort::unsupported_access: return "unsupported access to an object";
    case SdoAbort::write_only: return "attempt to read a write-only object";
    case SdoAbort::read_only: return "attempt to write a read-only object";
    case SdoAbort::no_object: return "object does not exist in the object dictionary";
    case SdoAbort::not_mappable: return "object cannot be mapped to the PDO";
    case SdoAbort::pdo_length: return "the objects to be mapped would exceed the PDO length";
    case SdoAbort::parameter_incompatible: return "general parameter incompatibility";
    case SdoAbort::internally_incompatible: return "general internal incompatibility in the device";
    case SdoAbort::hardware: return "access failed due to a hardware error";
    case SdoAbort::wrong_length:
        return "data type does not match, length of service parameter does not match";
    case SdoAbort::too_long: return "data type does not match, length of service parameter too high";
    case SdoAbort::too_short: return "data type does not match, length of service parameter too low";
    case SdoAbort::no_sub_index: return "sub-index does not exist";
    case SdoAbort::invalid_value: return "invalid value for parameter";
    case SdoAbort::too_high: return "value of parameter written too high";
    case SdoAbort::too_low: return "value of parameter written too low";
    case SdoAbort::maximum_below_minimum: return "maximum value is less than minimum value";
    case SdoAbort::no_resource: return "resource not available: SDO connection";
    case SdoAbort::general: return "general error";
    case SdoAbort::not_stored: return "data cannot be transferred or stored to the application";
    case SdoAbort::local_control:
        return "data cannot be transferred or stored to the application because of local control";
    case SdoAbort::device_state:
        return "data cannot be transferred or stored to the application because of the present device state";
    case SdoAbort::no_dictionary: return "no object dictionary is present";
    case SdoAbort::no_data: return "no data available";
    }
    return "a code of the device's maker";
}

/// Reads a little-endian number, as always in CANopen.
constexpr std::uint64_t from_bytes(std::span<const std::uint8_t> bytes) noexcept TAPPET_REALTIME {
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < bytes.size() && i < 8; ++i) value |= std::uint64_t{bytes[i]} << (8 * i);
    return value;
}
constexpr void to_bytes(std::uint64_t value, std::span<std::uint8_t> bytes) noexcept TAPPET_REALTIME {
    for (std::size_t i = 0; i < bytes.size(); ++i)
        bytes[i] = i < 8 ? static_cast<std::uint8_t>(value >> (8 * i)) : std::uint8_t{0};
}

namespace sdo {

using can::Payload;

/// Longest value of a transfer; a longer one is aborted.
inline constexpr std::size_t most_bytes = 64;
inline constexpr std::size_t in_segment = 7;

constexpr Address address_in(const Payload& frame) noexcept TAPPET_REALTIME {
    return {static_cast<std::uint16_t>(frame[1] | frame[2] << 8), frame[3]};
}
constexpr Payload with_address(unsigned command, Address at, std::uint32_t rest = 0) noexcept
    TAPPET_REALTIME {
    Payload frame{static_cast<std::uint8_t>(command), static_cast<std::uint8_t>(at.index & 0xFF),
                  static_cast<std::uint8_t>(at.index >> 8), at.sub};
    to_bytes(rest, std::span{frame}.subspan(4, 4));
    return frame;
}
constexpr Payload abort_frame(Address at, SdoAbort why) noexcept TAPPET_REALTIME {
    return with_address(0x80, at, static_cast<std::uint32_t>(why));
}
constexpr SdoAbort abort_in(const Payload& frame) noexcept TAPPET_REALTIME {
    return static_cast<SdoAbort>(from_bytes(std::span{frame}.subspan(4, 4)));
}

} // namespace sdo

} // namespace tappet::canopen
