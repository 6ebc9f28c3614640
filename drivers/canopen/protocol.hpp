// The identifiers and states that CiA 301 defines for every network.
#pragma once

#include "kernel/base/realtime.hpp"
#include "kernel/base/type_tag.hpp"

#include <array>
#include <cstdint>

namespace tappet::canopen {

/// COB-IDs of the predefined connection set; `+ node` where stated.
namespace cob {
inline constexpr std::uint32_t nmt = 0x000;
inline constexpr std::uint32_t sync = 0x080;
inline constexpr std::uint32_t emergency = 0x080; ///< + node
inline constexpr std::uint32_t time = 0x100;
inline constexpr std::uint32_t tpdo = 0x180;       ///< + node, and 100h more for each further PDO
inline constexpr std::uint32_t rpdo = 0x200;       ///< the same
inline constexpr std::uint32_t sdo_answer = 0x580; ///< + node
inline constexpr std::uint32_t sdo_request = 0x600;
inline constexpr std::uint32_t heartbeat = 0x700;
} // namespace cob

inline constexpr std::uint8_t most_nodes = 127;
inline constexpr std::size_t predefined_pdos = 4;         ///< in each direction
inline constexpr std::uint32_t pdo_invalid = 0x8000'0000; ///< in 1400h:1 and 1800h:1

/// The byte of an NMT frame.
enum class NmtCommand : std::uint8_t {
    start = 0x01,
    stop = 0x02,
    enter_pre_operational = 0x80,
    reset_node = 0x81,
    reset_communication = 0x82,
};
/// The byte of a heartbeat.
enum class NmtState : std::uint8_t {
    boot_up = 0x00,
    stopped = 0x04,
    operational = 0x05,
    pre_operational = 0x7F,
};

/// Emergency error codes (CiA 301, table 26) that the protocol stack itself sends.
namespace emergency_code {
inline constexpr std::uint16_t error_reset = 0x0000;
inline constexpr std::uint16_t heartbeat = 0x8130;
inline constexpr std::uint16_t pdo_too_short = 0x8210;
} // namespace emergency_code

} // namespace tappet::canopen
