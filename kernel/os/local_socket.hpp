// Packets between processes of one box: a listening socket in the file system, whose permissions state who
// may connect, and connections that know the peer.
#pragma once

#include "kernel/base/bounded.hpp"
#include "kernel/base/text.hpp"

#include <cstddef>
#include <cstdint>
#include <expected>
#include <optional>
#include <span>
#include <string_view>

namespace tappet::os {

/// The peer of a connection, as the kernel knows it.
struct Peer {
    std::int32_t process = 0;
    std::uint32_t user = 0;
    std::uint32_t group = 0;
    Bounded<std::uint32_t, 64> groups{}; ///< supplementary; empty when there are more

    [[nodiscard]] bool is_in(std::uint32_t wanted) const noexcept {
        for (const std::uint32_t each : groups)
            if (each == wanted) return true;
        return group == wanted;
    }
};

/// Returns the user that this process runs as.
[[nodiscard]] std::uint32_t own_user() noexcept;
[[nodiscard]] std::int32_t own_process() noexcept;

/// Number of descriptors accepted with a packet. A server of untrusted peers accepts none.
enum class Passed : std::uint8_t { none, one };

/// One end of a connection (AF_UNIX, SOCK_SEQPACKET: a packet arrives whole, in order, or not at all). No
/// function blocks or allocates; each is a system call, so none is real-time.
class LocalConnection {
public:
    enum class Sent : std::uint8_t { sent, full, closed };

    LocalConnection() = default;
    explicit LocalConnection(int descriptor) noexcept : descriptor_{descriptor} {}
    LocalConnection(LocalConnection&& other) noexcept : descriptor_{other.descriptor_} {
        other.descriptor_ = -1;
    }
    LocalConnection& operator=(LocalConnection&& other) noexcept {
        close();
        descriptor_ = other.descriptor_;
        other.descriptor_ = -1;
        return *this;
    }
    ~LocalConnection() { close(); }

    /// Connects to a listener at `path`. The error names the cure.
    static std::expected<LocalConnection, Sentence> connect(const char* path) noexcept;

    [[nodiscard]] bool open() const noexcept { return descriptor_ >= 0; }
    [[nodiscard]] int descriptor() const noexcept { return descriptor_; }
    void close() noexcept;
    [[nodiscard]] std::optional<Peer> peer() const noexcept;

    /// Sends a packet. With `passed` >= 0 the other end gets a descriptor for the same file.
    [[nodiscard]] Sent send(std::string_view packet, int passed = -1) const noexcept;

    struct Received {
        enum class What : std::uint8_t { packet, nothing, closed };
        What what = What::nothing;
        std::size_t bytes = 0; ///< length of the packet in `into`
        bool cut = false;      ///< the packet was longer
        int passed = -1;       ///< a descriptor that came with it; the caller must close it
    };
    /// Receives a packet. Descriptors that the other end passes beyond `passed` never become open in this
    /// process.
    [[nodiscard]] Received receive(std::span<char> into, Passed passed = Passed::none) const noexcept;
    /// Waits until there is a packet or the end of the connection; false after `milliseconds`.
    [[nodiscard]] bool wait(int milliseconds) const noexcept;

private:
    int descriptor_ = -1;
};

class LocalListener {
public:
    LocalListener() = default;
    LocalListener(const LocalListener&) = delete;
    LocalListener& operator=(const LocalListener&) = delete;
    ~LocalListener() { close(); }

    /// Listens at `path` (at most 107 characters), created with `mode`. A socket at which nobody listens any
    /// more is replaced, and a missing directory is made. Not real-time. The error names the cure.
    std::expected<void, Sentence> listen(std::string_view path, unsigned mode,
                                         std::int64_t group = -1) noexcept;
    [[nodiscard]] bool open() const noexcept { return descriptor_ >= 0; }
    [[nodiscard]] int descriptor() const noexcept { return descriptor_; }
    /// Returns a connection that waits, or one that is not open.
    [[nodiscard]] LocalConnection accept() const noexcept;
    /// Closes the socket and removes its path.
    void close() noexcept;

private:
    int descriptor_ = -1;
    char path_[108] = {};
};

} // namespace tappet::os
