// The connection to a running machine: its socket, requests with their replies, and the memory that the
// machine passes.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <atomic>
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

/// The causes of failed requests; their numbers are the program's exit codes.
enum class Fault : int {
    refused = 1,     ///< the machine refused: role, value, state
    bad_request = 2, ///< a wrong command line, or an unknown name
    no_machine = 3,  ///< unreachable, or ended meanwhile
    failed = 4,      ///< a command was accepted and then rejected or failed
    too_late = 5     ///< no answer in time, or a value that was busy at every attempt
};

struct Failure {
    Fault fault = Fault::no_machine;
    std::string sentence{};
};

/// Not 0 once a line shall stop; a signal handler, or another thread, sets it.
using StopFlag = std::atomic<int>;
static_assert(StopFlag::is_always_lock_free);

template <class T> using Result = std::expected<T, Failure>;

[[nodiscard]] inline std::unexpected<Failure> failure(Fault fault, std::string sentence) {
    return std::unexpected(Failure{fault, std::move(sentence)});
}
[[nodiscard]] inline std::unexpected<Failure> wrong(std::string sentence) {
    return failure(Fault::bad_request, std::move(sentence));
}

/// Memory of the machine, read-only; unmapped by the destructor.
class SharedBlock {
public:
    /// Maps from `at` on, which is a multiple of the page size.
    static Result<SharedBlock> map(int descriptor, std::size_t at = 0);
    SharedBlock(SharedBlock&& other) noexcept;
    SharedBlock& operator=(SharedBlock&& other) noexcept;
    ~SharedBlock();
    [[nodiscard]] std::span<const std::byte> bytes() const { return bytes_; }

private:
    explicit SharedBlock(std::span<const std::byte> bytes) : bytes_{bytes} {}
    std::span<const std::byte> bytes_{};
};

/// One connection. Replies are JSON objects. Packets that answer no waiting request (events, states of
/// commands) are queued in the order of their arrival.
class Link {
public:
    static Result<Link> connect(const std::string& path);
    /// Opens the black box `path` of an ended machine: it repeats the stored answers, laid out as in
    /// map/black_box.hpp.
    static Link to_nobody(const std::string& path, const std::string& answers);
    Link(Link&& other) noexcept;
    Link& operator=(Link&& other) noexcept;
    ~Link();

    /// Waits for the reply of this request. A refusal becomes a failure with the machine's own sentence.
    Result<nlohmann::ordered_json> request(std::string_view line);
    /// The same; `number` identifies later packets of this request.
    Result<nlohmann::ordered_json> request(std::string_view line, std::uint32_t& number);
    /// Returns the descriptor that came with the reply of `map`, which the caller then owns; -1: none came.
    [[nodiscard]] int take_descriptor();
    /// Returns the next packet that answers no request; nothing when none came within `patience`.
    Result<std::optional<nlohmann::ordered_json>> next(std::chrono::milliseconds patience);
    /// Returns true when the machine has closed the connection, or ended.
    [[nodiscard]] bool ended();
    [[nodiscard]] const std::string& path() const { return path_; }
    [[nodiscard]] int descriptor() const { return socket_; }

    /// The longest wait for a reply.
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
    std::map<std::string, std::string, std::less<>> answers_{}; ///< of an ended machine
};

} // namespace tappet::browser
