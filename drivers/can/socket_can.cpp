// SocketCAN without blocking: one recvmmsg reads all queued frames, a limited number is handed over, and
// faults are returned as values.
#include "drivers/can/socket_can.hpp"

#include "drivers/can/wire.hpp"

#include <algorithm>
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
Time read_clock(clockid_t clock) noexcept TAPPET_REALTIME {
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

/// A frame with the kernel's data about it.
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
    link_ = link;
    controller_.configure(settings, link.state);
    found_ = Sentence{"CAN interface \"", name, "\" "};
    if (link.is_virtual)
        found_.add("is virtual: it has no bit rate to compare with the board's ").add(settings.bit_rate);
    else
        found_.add("runs at ").add(link.bit_rate).add(" bit/s");
    if (!link.is_virtual && link.takes_fd()) found_.add(", CAN FD at ").add(link.data_bit_rate).add(" bit/s");
    if (!link.is_virtual) found_.add(", error ").add(to_text(link.state));
    auto done = open(arrives_, settings, settings.receive);
    if (done) done = open(sends_, settings, settings.transmit);
    if (!done) close();
    return done;
}

std::expected<void, Sentence> SocketCan::open(Socket& socket, const Settings& settings,
                                              std::span<const Identifier> identifiers) {
    const std::string_view name = settings.interface;
    const bool sends = &socket == &sends_;
    socket.arrivals.begin(read_clock(CLOCK_REALTIME), read_clock(CLOCK_MONOTONIC));
    socket.fd = ::socket(PF_CAN, SOCK_RAW | SOCK_NONBLOCK | SOCK_CLOEXEC, CAN_RAW);
    if (socket.fd < 0)
        return std::unexpected{failure(name, "no raw socket", "load can and can_raw, run with CAP_NET_RAW")};
    const auto set = [&](int level, int option, const void* value, std::size_t size) {
        return ::setsockopt(socket.fd, level, option, value, static_cast<socklen_t>(size)) == 0;
    };
    const auto set_int = [&](int level, int option, int value) {
        return set(level, option, &value, sizeof value);
    };

    std::array<can_filter, CAN_RAW_FILTER_MAX> filters{};
    std::size_t used = 0;
    for (const Identifier& one : identifiers) {
        if (!valid(one) || used == filters.size())
            return std::unexpected{Sentence{"CAN interface \"", name, "\": identifier ", one.id,
                                            valid(one) ? " is one too many: 512 fit" : " is out of range",
                                            "; correct the signal map"}};
        if (sends || std::ranges::find(settings.transmit, one) == settings.transmit.end()) // ours come there
            filters[used++] = wire::exactly(one);
    }
    // Without a filter call the socket would receive everything, with an empty filter nothing, as wanted.
    bool ok =
        set(SOL_CAN_RAW, CAN_RAW_FILTER, used == 0 ? nullptr : filters.data(), used * sizeof(can_filter));
    ok = ok && set_int(SOL_CAN_RAW, CAN_RAW_ERR_FILTER, sends ? 0 : static_cast<int>(wire::error_mask));
    ok = ok && set_int(SOL_CAN_RAW, CAN_RAW_RECV_OWN_MSGS, sends ? 1 : 0); // as confirmations
    ok = ok && (!settings.takes_fd || set_int(SOL_CAN_RAW, CAN_RAW_FD_FRAMES, 1));
    ok = ok && set_int(SOL_SOCKET, SO_RXQ_OVFL, 1);
    ok = ok && set_int(SOL_SOCKET, SO_SNDBUF, 0); // raised to the kernel's minimum: EAGAIN precedes ENOBUFS
    if (!ok)
        return std::unexpected{failure(name, "a socket option is refused", "is the kernel 5.10 or newer?")};
    // The machine works without these: frames then count as arrived when read, and the buffer has Linux's
    // default size. Stamps are the kernel's, not the controller's: Linux does not relate a CAN controller's
    // counter to its own clock (no CAN driver has a PTP clock), and the two drift apart with the controller's
    // crystal.
    set_int(SOL_SOCKET, SO_TIMESTAMPING, SOF_TIMESTAMPING_RX_SOFTWARE | SOF_TIMESTAMPING_SOFTWARE);
    if (!set_int(SOL_SOCKET, SO_RCVBUFFORCE, settings.receive_buffer_bytes))
        set_int(SOL_SOCKET, SO_RCVBUF, settings.receive_buffer_bytes);
    sockaddr_can address{};
    address.can_family = AF_CAN;
    address.can_ifindex = link_.index;
    if (::bind(socket.fd, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
        return std::unexpected{failure(name, "cannot be bound to", "is it up and a CAN interface?")};
    return {};
}

void SocketCan::close() noexcept {
    for (Socket* each : {&arrives_, &sends_}) {
        if (each->fd >= 0) ::close(each->fd);
        *each = {};
    }
    nothing_arrives_ = more_confirmed_ = false;
    lost_there_ = 0;
    controller_.purge();
}

bool SocketCan::wakes(os::Waiter& waiter) noexcept {
    waiter_ = &waiter;
    return waiter.watch(arrives_.fd) && waiter.watch(sends_.fd);
}

bool SocketCan::read(Socket& from) noexcept TAPPET_REALTIME {
    Batch& batch = from.batch;
    if (!batch.is_empty()) return true;
    // The last read emptied the socket, so there is no need to ask again.
    if (std::exchange(batch.is_last, false)) return false;
    // The kernel reports an error once, ahead of queued frames.
    for (int tries = 0; tries < 2; ++tries) {
        TAPPET_ESCAPE("the driver's own read, which does not block", batch.read_from(from.fd));
        if (!batch.is_empty()) return true;
        const int error = batch.error;
        const bool gone = error == ENETDOWN || error == ENODEV || error == ENXIO;
        if (gone && controller_.recovery.running()) controller_.fault(State::down);
        if (error == EAGAIN) break;
    }
    batch.is_last = false;
    nothing_arrives_ = nothing_arrives_ || &from == &arrives_;
    return false;
}

Receive SocketCan::receive(Frame& frame) noexcept TAPPET_REALTIME {
    belongs_to_.used();
    if (!is_open()) return {};
    // A malformed frame is not returned, so reading continues. The limit keeps a flood of them from blocking
    // the caller. The batch is always emptied, because no descriptor would signal its rest.
    for (std::uint32_t i = 0; i <= most_in_flight || !arrives_.batch.is_empty(); ++i) {
        if (!read(arrives_)) return {.lost = std::exchange(lost_there_, 0)};
        const std::size_t at = arrives_.batch.next++;
        Receive answer = judge(Raw{arrives_.batch.frames[at], arrives_.batch.messages[at]}, arrives_, frame);
        answer.lost += std::exchange(lost_there_, 0);
        if (answer.what != Received::none || answer.lost != 0) return answer;
    }
    return {};
}

// Error frames and confirmations are still evaluated. Both sockets are emptied, because other senders' frames
// may have filled the one for sending, and then confirmations would have no room.
void SocketCan::drop_arrivals() noexcept TAPPET_REALTIME {
    belongs_to_.used();
    constexpr int most = 1024; // batches: the kernel's buffer holds fewer
    Frame ignored;
    for (int n = 0; n < most && is_open(); ++n) {
        for (Batch& batch = arrives_.batch; !batch.is_empty();) {
            const std::size_t at = batch.next++;
            static_cast<void>(judge(Raw{batch.frames[at], batch.messages[at]}, arrives_, ignored));
        }
        if (n == 0) arrives_.batch.is_last = false; // it was empty when it was last read
        if (!read(arrives_)) break;
    }
    if (is_open()) sends_.batch.is_last = false;
    for (int n = 0; n < most && is_open(); ++n) {
        take_confirmations();
        if (!more_confirmed_) break;
    }
    lost_there_ = 0;
}

void SocketCan::take_confirmations() noexcept TAPPET_REALTIME {
    nothing_arrives_ = more_confirmed_ = false;
    Frame ignored;
    for (std::uint32_t i = 0; i <= most_in_flight || !sends_.batch.is_empty(); ++i) {
        if (!read(sends_)) return;
        const std::size_t at = sends_.batch.next++;
        lost_there_ += judge(Raw{sends_.batch.frames[at], sends_.batch.messages[at]}, sends_, ignored).lost;
    }
    more_confirmed_ = !std::exchange(sends_.batch.is_last, false);
}

Receive SocketCan::judge(const Raw& raw, Socket& from, Frame& frame) noexcept TAPPET_REALTIME {
    Receive answer;
    if (raw.drops_known) { // the kernel's count is cumulative and may wrap
        answer.lost = raw.drops - from.drops_seen;
        from.drops_seen = raw.drops;
        controller_.count.lost_in_kernel += answer.lost;
    }
    const Time now = read_clock(CLOCK_MONOTONIC);
    const Time arrived =
        raw.stamped ? from.arrivals.of(to_time(raw.stamp), read_clock(CLOCK_REALTIME), now) : now;
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
        controller_.confirmed(arrived, !from.arrivals.was_set());
        hand_over(now); // a frame sent now has the present time, whenever room for it was made
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
    if (!is_open()) return;
    // One call reads several confirmations. They are always read before one counts as missing.
    const bool looks = nothing_arrives_ || more_confirmed_ || now >= next_look_ || controller_.is_filled(2) ||
                       (wakes_when_confirmed_ && controller_.in_flight() != 0);
    const bool is_due = controller_.next_timeout() <= now;
    if (is_due) take_confirmations();
    if (controller_.tick(now, more_confirmed_)) {
        for (const Socket* each : {&arrives_, &sends_}) {
            int told = 0; // the interface was down in between, which the socket keeps as an error
            socklen_t size = sizeof told;
            TAPPET_ESCAPE("reads a field of the socket",
                          ::getsockopt(each->fd, SOL_SOCKET, SO_ERROR, &told, &size));
        }
    }
    hand_over(now);
    if ((looks || controller_.waiting() != 0) && !is_due) take_confirmations(); // after the hand-over
    next_look_ = controller_.in_flight() == 0 || faulted(controller_.state()) ? never
                 : looks || is_due || next_look_ == never ? now + controller_.confirm_within() / looks_at_one
                                                          : next_look_;
    if (waiter_ == nullptr) return;
    // While nothing is in flight, frames that arrive there are not this device's, and would fill the socket.
    const bool waits = more_confirmed_ || controller_.in_flight() == 0 || controller_.waiting() != 0 ||
                       controller_.is_filled(1);
    waiter_->heed(sends_.fd, waits || wakes_when_confirmed_);
}

bool SocketCan::finish(Time now) noexcept TAPPET_REALTIME {
    constexpr Duration longest_pause = 20ms, longest = 200ms;
    const Time begin = read_clock(CLOCK_MONOTONIC);
    std::uint64_t sent = controller_.count.sent;
    Frame ignored;
    service(now);
    for (Time at = begin, last = begin; !controller_.all_is_sent() && !faulted(controller_.state()) &&
                                        at - last < longest_pause && at - begin < longest;
         at = read_clock(CLOCK_MONOTONIC)) {
        static_cast<void>(receive(ignored));
        take_confirmations();
        hand_over(now);
        if (controller_.count.sent != sent) last = at;
        sent = controller_.count.sent;
    }
    return controller_.all_is_sent();
}

void SocketCan::hand_over(Time now) noexcept TAPPET_REALTIME {
    for (std::uint32_t i = 0; i < most_in_flight && is_open(); ++i) {
        const Frame* frame = controller_.next(now);
        if (frame == nullptr) return;
        canfd_frame raw;
        wire::encode(*frame, raw);
        const std::size_t bytes = wire::bytes_of(*frame);
        ssize_t written = 0;
        int error = 0;
        TAPPET_ESCAPE("the driver's own write, which does not block",
                      written = ::write(sends_.fd, &raw, bytes);
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
