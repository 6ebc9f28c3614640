// A client of the WebSocket: its login, its watches and its requests. It knows no socket of the network.
#pragma once

#include "toolchain/tools/gateway/carriage.hpp"
#include "toolchain/tools/gateway/frame.hpp"
#include "toolchain/tools/gateway/message.hpp"

namespace tappet::network {

/// The way to the client.
class Outlet {
public:
    Outlet() = default;
    Outlet(const Outlet&) = delete;
    Outlet& operator=(const Outlet&) = delete;
    virtual ~Outlet() = default;
    /// Queues a binary frame; false: the queue is full, and the frame is lost.
    [[nodiscard]] virtual bool offer(std::string frame) = 0;
    /// Returns whether the queue is less than half full.
    [[nodiscard]] virtual bool has_room() const = 0;
    /// Queues a text; a full queue ends the connection.
    virtual void send(std::string text) = 0;
    /// Ends the connection, with a reason of at most 123 bytes.
    virtual void end(std::string_view reason) = 0;
};

class Peer : public std::enable_shared_from_this<Peer> {
public:
    /// `who` and `token`: of the session that came with the connection; nobody: the client logs in.
    Peer(Hub& hub, Outlet& outlet, std::string address, std::optional<LoggedIn> who, std::string token,
         Clock::time_point now);
    ~Peer();

    /// Handles one message.
    void receive(std::string_view text, Clock::time_point now);
    void tick(Clock::time_point now, std::int64_t now_ns);
    /// Ends what lost its session, and closes idle connections to machines.
    void check(Clock::time_point now);
    void end_watches(Station& station, std::string_view reason);
    /// Tells that a machine appeared, started again or ended.
    void tell(const Station& station);
    /// The connection is gone: nothing is sent any more.
    void close();

private:
    struct Watch {
        std::string machine{};
        std::uint32_t life = 0;
        std::vector<std::uint32_t> facets{};
        unsigned every = 1; ///< ticks
        unsigned left = 1;
        Frames frames{};
    };
    void obey(const Message& message, Clock::time_point now);
    void login(const Message& message, Clock::time_point now);
    void admit(std::uint32_t id, LoggedIn who, std::string token);
    void watch(const Message& message);
    void unwatch(const Message& message);
    void request(const Message& message, Clock::time_point now);
    void run(const Message& message);
    void end(const Message& message);
    /// Sends what runs have for the client, as far as it reads.
    void forward();
    void drop(const Watch& watch);
    void refuse(std::uint32_t id, std::string_view code, std::string_view sentence);
    [[nodiscard]] bool uses(std::uint32_t id) const;

    Hub& hub_;
    Outlet* outlet_;
    std::string address_;
    std::optional<LoggedIn> who_;
    std::string token_;
    Clock::time_point begun_;
    bool logging_in_ = false;
    std::map<std::uint32_t, Watch> watches_{};
    std::map<std::string, std::unique_ptr<Carriage>, std::less<>> carriages_{};
    struct Running {
        std::shared_ptr<Run> run{};
        std::uint64_t logged = 0; ///< number in the log; 0: it only looks
        std::string line{};
    };
    std::map<std::uint32_t, Running> runs_{};
    void finish(const Running& running, std::string_view outcome);
};

} // namespace tappet::network
