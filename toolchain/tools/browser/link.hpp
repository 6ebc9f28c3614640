// The wire to a running machine: its socket, connected; requests with their replies; the memory that it hands
// over.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <expected>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tappet::browser {

/// Why nothing came of a request; the numbers are the exit codes of the program.
enum class Fault : int {
    refused = 1,     ///< the machine said no: role, value, state
    bad_request = 2, ///< a wrong command line, or a name that the machine does not have
    no_machine = 3,  ///< it cannot be reached, or it ended meanwhile
    failed = 4,      ///< a command was accepted and then rejected or failed
    too_late = 5     ///< no answer in time, or a value that was busy at every attempt
};

struct Failure {
    Fault fault = Fault::no_machine;
    std::string sentence{};
};

template <class T> using Result = std::expected<T, Failure>;

[[nodiscard]] inline std::unexpected<Failure> failure(Fault fault, std::string sentence) {
    return std::unexpected(Failure{fault, std::move(sentence)});
}
[[nodiscard]] inline std::unexpected<Failure> wrong(std::string sentence) {
    return failure(Fault::bad_request, std::move(sentence));
}

/// Memory of the machine, read-only; unmapped at the end.
class SharedBlock {
public:
    /// From `at` on, which is whole pages.
    static Result<SharedBlock> map(int descriptor, std::size_t at = 0);
    SharedBlock(SharedBlock&& other) noexcept;
    SharedBlock& operator=(SharedBlock&& other) noexcept;
    ~SharedBlock();
    [[nodiscard]] std::span<const std::byte> bytes() const { return bytes_; }

private:
    explicit SharedBlock(std::span<const std::byte> bytes) : bytes_{bytes} {}
    std::span<const std::byte> bytes_{};
};

/// One connection. Replies are JSON objects; packets that answer no waiting request (events, states of
/// commands) are kept in the order of their arrival.
class Link {
public:
    static Result<Link> connect(const std::string& path);
    /// Of a machine that is no more, kept in the file `path`: it gives the answers that it gave before, as
    /// map/black_box.hpp lays them out.
    static Link to_nobody(const std::string& path, const std::string& answers);
    Link(Link&& other) noexcept;
    Link& operator=(Link&& other) noexcept;
    ~Link();

    /// Waits for the reply of this request. A refusal is a failure that says the machine's own sentence.
    Result<nlohmann::ordered_json> request(std::string_view line);
    /// The same; `number` is what later packets of this request carry.
    Result<nlohmann::ordered_json> request(std::string_view line, std::uint32_t& number);
    /// The descriptor that came with the reply of `map`; -1 when none did. It is the caller's.
    [[nodiscard]] int take_descriptor();
    /// The next packet that answers no request; nothing when none came within `patience`.
    Result<std::optional<nlohmann::ordered_json>> next(std::chrono::milliseconds patience);
    /// The machine has closed the connection, or ended.
    [[nodiscard]] bool ended();
    [[nodiscard]] const std::string& path() const { return path_; }
    [[nodiscard]] int descriptor() const { return socket_; }

    /// How long a reply may take.
    std::chrono::milliseconds patience{3000};

private:
    Link() = default;
    Result<std::optional<nlohmann::ordered_json>> receive(std::chrono::milliseconds patience);
    Failure gone() const;

    int socket_ = -1;
    int received_descriptor_ = -1;
    std::uint32_t last_number_ = 0;
    std::string path_{};
    std::vector<std::string> waiting_{};
    std::map<std::string, std::string, std::less<>> answers_{}; ///< of a machine that is no more
};

} // namespace tappet::browser
