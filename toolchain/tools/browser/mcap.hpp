// Recordings as MCAP, version 0 (mcap.dev/spec): append-only self-describing records in small chunks with
// checksums, so that a truncated or damaged file is good in all other chunks.
#pragma once

#include <cstdint>
#include <expected>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tappet::browser::mcap {

inline constexpr std::string_view magic{"\x89MCAP0\r\n", 8};

enum class Opcode : std::uint8_t {
    header = 0x01,
    footer = 0x02,
    schema = 0x03,
    channel = 0x04,
    message = 0x05,
    chunk = 0x06,
    metadata = 0x0C,
    data_end = 0x0F
};

using Pairs = std::vector<std::pair<std::string, std::string>>;

struct Channel {
    std::uint16_t id = 0;
    std::uint16_t schema = 0; ///< 0: none
    std::string topic{};
    std::string encoding{};
    Pairs metadata{};
};

struct Message {
    std::uint16_t channel = 0;
    std::uint32_t sequence = 0;
    std::uint64_t log_ns = 0;
    std::string_view data{};
};

// Each appends one record.
void put_begin(std::string& file, std::string_view library);
void put_schema(std::string& file, std::uint16_t id, std::string_view name, std::string_view json_schema);
void put_channel(std::string& file, const Channel& channel);
void put_message(std::string& file, const Message& message);
/// `records`: schemas, channels and messages, from the first to the last time of the messages.
void put_chunk(std::string& file, std::uint64_t first_ns, std::uint64_t last_ns, std::string_view records);
void put_metadata(std::string& file, std::string_view name, const Pairs& values);
/// Writes the end of a complete file.
void put_end(std::string& file);

/// The readable content of a file. Its messages point into the read bytes.
struct Contents {
    std::vector<Channel> channels{};
    std::map<std::uint16_t, std::string> schemas{}; ///< their text
    std::vector<Message> messages{};                ///< in the order of the file
    std::map<std::string, Pairs, std::less<>> metadata{};
    bool has_end = false;        ///< it was not cut off
    std::size_t whole_bytes = 0; ///< up to the end of its last whole record
    std::string damage{};        ///< the first damage, which is left out; empty: none
};

/// The error states why the file is no readable MCAP. A truncated end is no error, nor are zeros up to the
/// end, which a power cut leaves. Skips unknown records.
[[nodiscard]] std::expected<Contents, std::string> read(std::string_view file);

} // namespace tappet::browser::mcap
