// One packet per request, one per reply, over AF_UNIX (see unix(7)).
#include "toolchain/tools/browser/link.hpp"

#include "kernel/services/browsing/protocol.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <sstream>
#include <utility>

#include <fcntl.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/time.h>
#include <sys/un.h>
#include <unistd.h>

namespace tappet::browser {

namespace {

using nlohmann::ordered_json;
using Milliseconds = std::chrono::milliseconds;
using Steady = std::chrono::steady_clock;

std::string why_not_connected(const std::string& path, int error) {
    const std::string socket = "'" + path + "'";
    switch (error) {
    case ENOENT:
        return "there is no socket " + socket + "; is the machine running, and does it serve browsers?";
    case ECONNREFUSED: return "nobody listens at " + socket + "; the machine has ended: start it again";
    case EACCES:
    case EPERM:
        return "you may not open " + socket +
               "; its file mode and group do not allow it: ask the box's administrator";
    case EAGAIN:
        return "the machine accepted no connection for 5 s; check that its browser's activity runs, or end "
               "other browsers";
    case EPROTOTYPE: return socket + " is a socket of another kind; name the machine's with --socket";
    default: return "cannot connect to " + socket + ": " + std::strerror(error);
    }
}

} // namespace

Result<SharedBlock> SharedBlock::map(int descriptor, std::size_t at_byte) {
    struct stat state{};
    if (::fstat(descriptor, &state) != 0 || state.st_size <= static_cast<off_t>(at_byte))
        return failure(Fault::no_machine, "the machine did not pass its memory");
    const auto size = static_cast<std::size_t>(state.st_size) - at_byte;
    void* const at = ::mmap(nullptr, size, PROT_READ, MAP_SHARED, descriptor, static_cast<off_t>(at_byte));
    if (at == MAP_FAILED)
        return failure(Fault::no_machine,
                       std::string{"the machine's memory cannot be mapped: "} + std::strerror(errno));
    return SharedBlock{{static_cast<const std::byte*>(at), size}};
}

SharedBlock::SharedBlock(SharedBlock&& other) noexcept : bytes_{std::exchange(other.bytes_, {})} {}

SharedBlock& SharedBlock::operator=(SharedBlock&& other) noexcept {
    std::swap(bytes_, other.bytes_);
    return *this;
}

SharedBlock::~SharedBlock() {
    if (!bytes_.empty()) ::munmap(const_cast<std::byte*>(bytes_.data()), bytes_.size());
}

Result<Link> Link::connect(const std::string& path) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    if (path.empty() || path.size() >= sizeof address.sun_path)
        return failure(Fault::bad_request, "the path of a socket has 1 to 107 characters; '" + path +
                                               "' has " + std::to_string(path.size()));
    std::ranges::copy(path, address.sun_path);
    Link link;
    link.path_ = path;
    // Waits in the queue for a while, beside others that retry their connection.
    constexpr timeval in_queue{.tv_sec = 5, .tv_usec = 0};
    link.socket_ = ::socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0);
    if (link.socket_ < 0 ||
        ::setsockopt(link.socket_, SOL_SOCKET, SO_SNDTIMEO, &in_queue, sizeof in_queue) != 0 ||
        ::connect(link.socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 ||
        ::fcntl(link.socket_, F_SETFL, O_NONBLOCK) != 0)
        return failure(Fault::no_machine, why_not_connected(path, errno));
    return link;
}

Link Link::to_nobody(const std::string& path, const std::string& answers) {
    Link link;
    link.path_ = path;
    std::istringstream lines{answers};
    for (std::string line; std::getline(lines, line) && !lines.eof();) // the last line may be cut off
        if (const std::size_t tabulator = line.find('\t'); tabulator != std::string::npos)
            link.answers_[line.substr(0, tabulator)] = line.substr(tabulator + 1);
    return link;
}

Link::Link(Link&& other) noexcept
    : patience{other.patience},
      socket_{std::exchange(other.socket_, -1)},
      received_descriptor_{std::exchange(other.received_descriptor_, -1)},
      last_number_{other.last_number_},
      path_{std::move(other.path_)},
      waiting_{std::move(other.waiting_)},
      answers_{std::move(other.answers_)} {}

Link& Link::operator=(Link&& other) noexcept {
    std::swap(patience, other.patience);
    std::swap(socket_, other.socket_);
    std::swap(received_descriptor_, other.received_descriptor_);
    std::swap(last_number_, other.last_number_);
    std::swap(path_, other.path_);
    std::swap(waiting_, other.waiting_);
    std::swap(answers_, other.answers_);
    return *this;
}

Link::~Link() {
    if (socket_ >= 0) ::close(socket_);
    if (received_descriptor_ >= 0) ::close(received_descriptor_);
}

int Link::take_descriptor() { return std::exchange(received_descriptor_, -1); }

Failure Link::gone() const {
    return {Fault::no_machine, "the machine has ended, or it has closed the connection at '" + path_ + "'"};
}

bool Link::ended() {
    pollfd look{socket_, POLLRDHUP, 0};
    return ::poll(&look, 1, 0) > 0 && (look.revents & (POLLHUP | POLLRDHUP | POLLERR)) != 0;
}

Result<std::optional<ordered_json>> Link::receive(Milliseconds within) {
    pollfd look{socket_, POLLIN, 0};
    const int ready = ::poll(&look, 1, static_cast<int>(within.count()));
    if (ready < 0 && errno != EINTR) return std::unexpected(gone());
    if (ready <= 0) return std::optional<ordered_json>{};
    std::array<char, 64 * 1024> packet{};
    alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof(int))> control{};
    iovec place{packet.data(), packet.size()};
    msghdr message{};
    message.msg_iov = &place;
    message.msg_iovlen = 1;
    message.msg_control = control.data();
    message.msg_controllen = CMSG_LEN(sizeof(int)); // room for one: the kernel closes further descriptors
    const ssize_t count = ::recvmsg(socket_, &message, MSG_CMSG_CLOEXEC);
    if (count < 0 && (errno == EAGAIN || errno == EINTR)) return std::optional<ordered_json>{};
    if (count < 0) return std::unexpected(gone());
    for (cmsghdr* each = CMSG_FIRSTHDR(&message); each != nullptr; each = CMSG_NXTHDR(&message, each)) {
        if (each->cmsg_level != SOL_SOCKET || each->cmsg_type != SCM_RIGHTS) continue;
        if (received_descriptor_ >= 0) ::close(received_descriptor_);
        std::memcpy(&received_descriptor_, CMSG_DATA(each), sizeof(int));
    }
    if (count == 0) return std::unexpected(gone());
    auto parsed = ordered_json::parse(packet.data(), packet.data() + count, nullptr, false);
    if (!parsed.is_object())
        return failure(Fault::no_machine, "the machine's answer is no JSON object: " +
                                              std::string{packet.data(), static_cast<std::size_t>(count)});
    // The browser's requests count from 1; id 0 reports that this connection got no place, or lost it.
    if (parsed.value("id", std::int64_t{-1}) == 0 && parsed.contains("error"))
        return failure(Fault::refused, parsed.value("error", std::string{}));
    return std::optional{std::move(parsed)};
}

Result<ordered_json> Link::request(std::string_view line) {
    std::uint32_t number = 0;
    return request(line, number);
}

Result<ordered_json> Link::request(std::string_view line, std::uint32_t& number) {
    if (socket_ < 0) {
        if (const auto kept = answers_.find(line); kept != answers_.end())
            return ordered_json::parse(kept->second, nullptr, false);
        return failure(Fault::bad_request,
                       "'" + path_ + "' is a black box: it can be read, but it answers no requests");
    }
    number = ++last_number_;
    const std::string packet = std::to_string(number) + " " + std::string{line};
    if (packet.size() > browsing::max_packet_bytes)
        return failure(Fault::bad_request, "the request is longer than " +
                                               std::to_string(browsing::max_packet_bytes) +
                                               " bytes; ask for less at a time");
    const auto end = Steady::now() + patience;
    while (::send(socket_, packet.data(), packet.size(), MSG_NOSIGNAL) < 0) {
        if (errno != EAGAIN && errno != EINTR) return std::unexpected(gone());
        pollfd room{socket_, POLLOUT, 0};
        const auto left = std::chrono::duration_cast<Milliseconds>(end - Steady::now());
        if (left.count() <= 0)
            return failure(Fault::too_late,
                           "the machine accepts no request because others flood it: try again");
        ::poll(&room, 1, static_cast<int>(left.count()));
    }
    for (;;) {
        const auto left = std::chrono::duration_cast<Milliseconds>(end - Steady::now());
        if (left.count() <= 0)
            return failure(Fault::too_late,
                           "no answer within " + std::to_string(patience.count()) +
                               " ms; the machine is flooded by others, or stopped: try again");
        auto packet_in = receive(left);
        if (!packet_in) return std::unexpected(packet_in.error());
        if (!*packet_in) continue;
        ordered_json& reply = **packet_in;
        if (!reply.contains("ok") || reply.value("id", std::int64_t{-1}) != number) {
            waiting_.push_back(reply.dump());
            continue;
        }
        if (reply["ok"] == true) return std::move(reply);
        const std::string code = reply.value("code", std::string{});
        const bool written_wrong =
            code == to_text(browsing::Refusal::bad_request) || code == to_text(browsing::Refusal::unknown);
        return failure(written_wrong ? Fault::bad_request : Fault::refused,
                       reply.value("error", std::string{"refused without a reason"}));
    }
}

Result<std::optional<ordered_json>> Link::next(Milliseconds within) {
    if (!waiting_.empty()) {
        auto first = ordered_json::parse(waiting_.front(), nullptr, false);
        waiting_.erase(waiting_.begin());
        return std::optional{std::move(first)};
    }
    return receive(within);
}

} // namespace tappet::browser
