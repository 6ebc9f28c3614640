// SocketCAN without blocking: as many frames as wait in one recvmmsg, a bounded number of frames handed over,
// faults taken as values.
#include "drivers/can/socket_can.hpp"

#include "drivers/can/wire.hpp"

#include <cerrno>
#include <cstring>
#include <linux/can.h>
#include <linux/can/raw.h>
#include <linux/errqueue.h>
#include <linux/net_tstamp.h>
#include <net/if.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>
#include <utility>

namespace tappet::can {
namespace {

Time to_time(const timespec& t) noexcept TAPPET_REALTIME {
    return at_ns(std::int64_t{t.tv_sec} * 1'000'000'000 + t.tv_nsec);
}
Time read(clockid_t clock) noexcept TAPPET_REALTIME {
    timespec t{};
    TAPPET_ESCAPE("the vDSO reads the clock without entering the kernel", ::clock_gettime(clock, &t));
    return to_time(t);
}

Sentence failure(std::string_view interface, std::string_view what, std::string_view cure) {
    return Sentence{"CAN interface \"", interface, "\": ", what, ": ", strerrordesc_np(errno), "; ", cure};
}

} // namespace

void SocketCan::Batch::read_from(int fd) noexcept {
    for (std::size_t i = 0; i < size; ++i) {
        parts[i] = {&frames[i], sizeof frames[i]};
        messages[i].msg_hdr = {};
        messages[i].msg_hdr.msg_iov = &parts[i];
        messages[i].msg_hdr.msg_iovlen = 1;
        messages[i].msg_hdr.msg_control = told[i].bytes;
        messages[i].msg_hdr.msg_controllen = sizeof told[i].bytes;
    }
    const int read = ::recvmmsg(fd, messages.data(), size, MSG_DONTWAIT | MSG_TRUNC, nullptr);
    error = read < 0 ? errno : 0;
    next = 0;
    filled = read < 0 ? 0 : static_cast<std::size_t>(read);
    is_last = filled < size;
}

/// A frame, and what the kernel says of it.
struct SocketCan::Raw {
    const canfd_frame& frame;
    std::size_t bytes = 0;
    int flags = 0;
    bool stamped = false;
    timespec stamp{};
    bool drops_known = false;
    std::uint32_t drops = 0;

    Raw(const canfd_frame& read, mmsghdr& message) noexcept TAPPET_REALTIME
        : frame{read},
          bytes{message.msg_len},
          flags{message.msg_hdr.msg_flags} {
        for (cmsghdr* c = CMSG_FIRSTHDR(&message.msg_hdr); c != nullptr; c = following(message.msg_hdr, c)) {
            if (c->cmsg_level != SOL_SOCKET) continue;
            if (c->cmsg_type == SO_RXQ_OVFL) {
                std::memcpy(&drops, CMSG_DATA(c), sizeof drops);
                drops_known = true;
            } else if (c->cmsg_type == SCM_TIMESTAMPING) {
                std::memcpy(&stamp, CMSG_DATA(c), sizeof stamp);
                stamped = stamp.tv_sec != 0 || stamp.tv_nsec != 0;
            }
        }
    }
    static cmsghdr* following(msghdr& of, cmsghdr* c) noexcept TAPPET_REALTIME {
        cmsghdr* next = nullptr;
        TAPPET_ESCAPE("computes an address", next = CMSG_NXTHDR(&of, c));
        return next;
    }
};

std::expected<void, Sentence> SocketCan::open(const Settings& settings) {
    close();
    const auto link = find_link(settings.interface);
    if (!link) return std::unexpected{link.error()};
    return open(settings, *link);
}

std::expected<void, Sentence> SocketCan::open(const Settings& settings, const Link& link) {
    close();
    const std::string_view name = settings.interface;
    if (auto good = fit(link, name, settings); !good) return good;
    fd_ = ::socket(PF_CAN, SOCK_RAW | SOCK_NONBLOCK | SOCK_CLOEXEC, CAN_RAW);
    if (fd_ < 0)
        return std::unexpected{failure(name, "no raw socket", "load can and can_raw, run with CAP_NET_RAW")};
    link_ = link;
    drops_seen_ = 0;
    batch_ = {};
    arrivals_.begin(read(CLOCK_REALTIME), read(CLOCK_MONOTONIC));
    controller_.configure(settings, link.state);
    found_ = Sentence{"CAN interface \"", name, "\" "};
    if (link.is_virtual)
        found_.add("is virtual: it has no bit rate to compare with the board's ").add(settings.bit_rate);
    else
        found_.add("runs at ").add(link.bit_rate).add(" bit/s");
    if (!link.is_virtual && link.takes_fd()) found_.add(", CAN FD at ").add(link.data_bit_rate).add(" bit/s");
    if (!link.is_virtual) found_.add(", error ").add(to_text(link.state));
    auto done = set_options(settings);
    if (done) {
        sockaddr_can address{};
        address.can_family = AF_CAN;
        address.can_ifindex = link_.index;
        if (::bind(fd_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
            done = std::unexpected{failure(name, "cannot be bound to", "is it up and a CAN interface?")};
    }
    if (!done) close();
    return done;
}

std::expected<void, Sentence> SocketCan::set_options(const Settings& settings) {
    const auto set = [&](int level, int option, const void* value, std::size_t size) {
        return ::setsockopt(fd_, level, option, value, static_cast<socklen_t>(size)) == 0;
    };
    const auto set_int = [&](int level, int option, int value) {
        return set(level, option, &value, sizeof value);
    };

    std::array<can_filter, CAN_RAW_FILTER_MAX> filters{};
    std::size_t used = 0;
    for (const auto list : {settings.receive, settings.transmit}) // ours come back as confirmations
        for (const Identifier& one : list) {
            if (!valid(one) || used == filters.size())
                return std::unexpected{Sentence{"CAN interface \"", settings.interface, "\": identifier ",
                                                one.id,
                                                valid(one) ? " is one too many: 512 fit" : " is out of range",
                                                "; correct the signal map"}};
            filters[used++] = wire::exactly(one);
        }
    // No filter at all would mean "everything" to no filter call, and "nothing" to an empty one: the latter
    // is wanted.
    bool ok =
        set(SOL_CAN_RAW, CAN_RAW_FILTER, used == 0 ? nullptr : filters.data(), used * sizeof(can_filter));
    ok = ok && set_int(SOL_CAN_RAW, CAN_RAW_ERR_FILTER, static_cast<int>(wire::error_mask));
    ok = ok && set_int(SOL_CAN_RAW, CAN_RAW_RECV_OWN_MSGS, 1);
    ok = ok && (!settings.takes_fd || set_int(SOL_CAN_RAW, CAN_RAW_FD_FRAMES, 1));
    ok = ok && set_int(SOL_SOCKET, SO_RXQ_OVFL, 1);
    ok = ok &&
         set_int(SOL_SOCKET, SO_SNDBUF, 0); // the kernel raises it to its least: EAGAIN comes before ENOBUFS
    if (!ok)
        return std::unexpected{
            failure(settings.interface, "a socket option is refused", "is the kernel 5.10 or newer?")};
    // Without these the machine still works: frames count as arrived when read, and the buffer is Linux's
    // default. Stamps are the kernel's, not the controller's: what CAN drivers count by has no clock that
    // Linux relates to its own (none has a PTP clock), and runs away from it with the controller's crystal.
    set_int(SOL_SOCKET, SO_TIMESTAMPING, SOF_TIMESTAMPING_RX_SOFTWARE | SOF_TIMESTAMPING_SOFTWARE);
    if (!set_int(SOL_SOCKET, SO_RCVBUFFORCE, settings.receive_buffer_bytes))
        set_int(SOL_SOCKET, SO_RCVBUF, settings.receive_buffer_bytes);
    return {};
}

void SocketCan::close() noexcept {
    if (fd_ >= 0) ::close(fd_);
    fd_ = -1;
    controller_.purge();
}

Receive SocketCan::receive(Frame& frame) noexcept TAPPET_REALTIME {
    belongs_to_.used();
    if (fd_ < 0) return {};
    // A confirmation, an impostor's or a malformed frame is no answer, so reading goes on; as many as can be
    // in flight suffice, and the bound keeps a flood from holding the caller. Nothing stays in the batch
    // then: no descriptor would tell of it.
    for (std::uint32_t i = 0; i <= most_in_flight || !batch_.is_empty(); ++i) {
        if (batch_.is_empty()) {
            // The kernel had no more: that is known without asking it again.
            if (std::exchange(batch_.is_last, false)) return {};
            TAPPET_ESCAPE("the driver's own read, which does not block", batch_.read_from(fd_));
            const int error = batch_.error;
            const bool gone = error == ENETDOWN || error == ENODEV || error == ENXIO;
            if (gone && controller_.recovery.running()) controller_.fault(State::down);
            if (batch_.is_empty()) {
                batch_.is_last = false;
                return {};
            }
        }
        const std::size_t at = batch_.next++;
        const Receive answer = judge(Raw{batch_.frames[at], batch_.messages[at]}, frame);
        if (answer.what != Received::none || answer.lost != 0) return answer;
    }
    return {};
}

Receive SocketCan::judge(const Raw& raw, Frame& frame) noexcept TAPPET_REALTIME {
    Receive answer;
    if (raw.drops_known) { // the kernel's count is cumulative and may wrap
        answer.lost = raw.drops - drops_seen_;
        drops_seen_ = raw.drops;
        controller_.count.lost_in_kernel += answer.lost;
    }
    const Time now = read(CLOCK_MONOTONIC);
    const Time arrived = raw.stamped ? arrivals_.of(to_time(raw.stamp), read(CLOCK_REALTIME), now) : now;
    Frame candidate;
    if (!wire::decode(raw.frame, raw.bytes, controller_.state(), candidate)) {
        ++controller_.count.malformed;
        return answer;
    }
    candidate.stamp = arrived;
    if ((raw.frame.can_id & CAN_ERR_FLAG) != 0) {
        controller_.report(candidate.error);
        answer.what = Received::error_frame;
    } else if ((raw.flags & MSG_CONFIRM) != 0) {
        controller_.confirmed(arrived);
        hand_over(arrived);
        return answer;
    } else if (controller_.ours(candidate)) {
        ++controller_.count.impostors;
        return answer;
    } else {
        ++controller_.count.received;
        answer.what = Received::frame;
    }
    frame = candidate;
    return answer;
}

void SocketCan::service(Time now) noexcept TAPPET_REALTIME {
    belongs_to_.used();
    if (controller_.tick(now)) {
        int told = 0; // the interface was down in between, and the socket remembers it as an error
        socklen_t size = sizeof told;
        TAPPET_ESCAPE("reads a field of the socket", ::getsockopt(fd_, SOL_SOCKET, SO_ERROR, &told, &size));
    }
    hand_over(now);
}

bool SocketCan::finish(Time now) noexcept TAPPET_REALTIME {
    constexpr Duration longest_pause = 20ms, longest = 200ms;
    const Time begin = read(CLOCK_MONOTONIC);
    std::uint64_t sent = controller_.count.sent;
    Frame ignored;
    service(now);
    for (Time at = begin, last = begin; !controller_.all_is_sent() && !faulted(controller_.state()) &&
                                        at - last < longest_pause && at - begin < longest;
         at = read(CLOCK_MONOTONIC)) {
        static_cast<void>(receive(ignored));
        hand_over(now);
        if (controller_.count.sent != sent) last = at;
        sent = controller_.count.sent;
    }
    return controller_.all_is_sent();
}

void SocketCan::hand_over(Time now) noexcept TAPPET_REALTIME {
    for (std::uint32_t i = 0; i < most_in_flight && fd_ >= 0; ++i) {
        const Frame* frame = controller_.next(now);
        if (frame == nullptr) return;
        canfd_frame raw;
        wire::encode(*frame, raw);
        const std::size_t bytes = wire::bytes_of(*frame);
        ssize_t written = 0;
        int error = 0;
        TAPPET_ESCAPE("the driver's own write, which does not block", written = ::write(fd_, &raw, bytes);
                      error = errno);
        if (written == static_cast<ssize_t>(bytes)) {
            controller_.handed_over(now);
            continue;
        }
        if (error == EAGAIN || error == ENOBUFS || error == EINTR)
            ++controller_.count.back_pressure;
        else
            controller_.fault(State::down);
        return;
    }
}

Restart SocketCan::restart() noexcept {
    const Restart begun = controller_.recovery.begin();
    if (begun != Restart::done) return begun;
    return controller_.recovery.end(restart_link(link_).has_value());
}

} // namespace tappet::can
