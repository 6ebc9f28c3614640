// rtnetlink by hand: two requests do not justify a library in the firmware.
#include "drivers/can/link.hpp"

#include <array>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <linux/can/netlink.h>
#include <linux/rtnetlink.h>
#include <net/if.h>
#include <net/if_arp.h>
#include <sys/socket.h>
#include <unistd.h>

namespace tappet::can {
namespace {

/// A netlink socket for one request and its answer.
class Netlink {
public:
    Netlink() : fd_{::socket(AF_NETLINK, SOCK_RAW | SOCK_CLOEXEC, NETLINK_ROUTE)} {
        const timeval patience{2, 0};
        if (fd_ >= 0) ::setsockopt(fd_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    }
    Netlink(const Netlink&) = delete;
    Netlink& operator=(const Netlink&) = delete;
    ~Netlink() {
        if (fd_ >= 0) ::close(fd_);
    }
    /// 0 and the answer in the buffer, or an errno.
    int ask(ifinfomsg what, std::uint16_t type, std::uint16_t flags) {
        struct {
            nlmsghdr header;
            ifinfomsg info;
        } request{};
        request.header.nlmsg_len = sizeof request;
        request.header.nlmsg_type = type;
        request.header.nlmsg_flags = static_cast<std::uint16_t>(NLM_F_REQUEST | flags);
        request.info = what;
        if (fd_ < 0) return errno;
        if (::send(fd_, &request, sizeof request, 0) < 0) return errno;
        const ssize_t n = ::recv(fd_, buffer_.data(), buffer_.size(), 0);
        if (n < 0) return errno;
        length_ = static_cast<std::size_t>(n);
        nlmsghdr header{};
        if (length_ < sizeof header) return EPROTO;
        std::memcpy(&header, buffer_.data(), sizeof header);
        if (header.nlmsg_type != NLMSG_ERROR) return 0;
        nlmsgerr error{};
        if (length_ < sizeof header + sizeof error) return EPROTO;
        std::memcpy(&error, buffer_.data() + sizeof header, sizeof error);
        return -error.error;
    }
    [[nodiscard]] const std::byte* data() const { return buffer_.data(); }
    [[nodiscard]] std::size_t length() const { return length_; }

private:
    int fd_;
    std::array<std::byte, 16384> buffer_{};
    std::size_t length_ = 0;
};

/// Calls visit(type, payload, length) for each attribute; stops at the first that does not fit.
template <class Visit> void each_attribute(const std::byte* at, std::size_t left, Visit visit) {
    rtattr attribute{};
    while (left >= sizeof attribute) {
        std::memcpy(&attribute, at, sizeof attribute);
        if (attribute.rta_len < sizeof attribute || attribute.rta_len > left) return;
        visit(attribute.rta_type & NLA_TYPE_MASK, at + sizeof attribute,
              attribute.rta_len - sizeof attribute);
        const std::size_t step = (attribute.rta_len + 3u) & ~std::size_t{3};
        if (step >= left) return;
        at += step;
        left -= step;
    }
}

void read_can_attributes(const std::byte* at, std::size_t left, Link& link) {
    each_attribute(at, left, [&](int type, const std::byte* payload, std::size_t length) {
        if (type == IFLA_CAN_RESTART_MS && length >= sizeof link.restart_ms)
            std::memcpy(&link.restart_ms, payload, sizeof link.restart_ms);
        can_bittiming timing{};
        if (type == IFLA_CAN_BITTIMING && length >= sizeof timing) {
            std::memcpy(&timing, payload, sizeof timing);
            link.bit_rate = timing.bitrate;
        }
    });
}

void read_link_info(const std::byte* at, std::size_t left, Link& link) {
    each_attribute(at, left, [&](int type, const std::byte* payload, std::size_t length) {
        if (type == IFLA_INFO_KIND) {
            char kind[16] = {};
            std::memcpy(kind, payload, length < sizeof kind ? length : sizeof kind - 1);
            link.is_virtual = std::string_view{kind} == "vcan" || std::string_view{kind} == "vxcan";
        }
        if (type == IFLA_INFO_DATA && !link.is_virtual) read_can_attributes(payload, length, link);
    });
}

} // namespace

std::expected<Link, Sentence> find_link(std::string_view interface) {
    const Sentence who{"CAN interface \"", interface, "\""};
    char name[IFNAMSIZ] = {};
    if (interface.empty() || interface.size() >= sizeof name)
        return std::unexpected{
            Sentence{who, " cannot exist: a name has 1 to 15 letters; correct it in the board"}};
    interface.copy(name, interface.size());
    Link link;
    link.index = static_cast<int>(::if_nametoindex(name));
    if (link.index == 0)
        return std::unexpected{
            Sentence{who, " does not exist: create it (ip link add dev ", interface,
                     " type vcan, or load its controller's driver) or name another in the board"}};
    Netlink netlink;
    ifinfomsg what{};
    what.ifi_family = AF_UNSPEC;
    what.ifi_index = link.index;
    if (const int error = netlink.ask(what, RTM_GETLINK, 0))
        return std::unexpected{Sentence{who, " cannot be asked for its settings: ", strerrordesc_np(error),
                                        "; the kernel must offer rtnetlink"}};
    ifinfomsg info{};
    constexpr std::size_t head = sizeof(nlmsghdr) + sizeof info;
    if (netlink.length() < head)
        return std::unexpected{
            Sentence{who, " gave a short answer over rtnetlink; is this kernel supported?"}};
    std::memcpy(&info, netlink.data() + sizeof(nlmsghdr), sizeof info);
    if (info.ifi_type != ARPHRD_CAN)
        return std::unexpected{
            Sentence{who, " is no CAN interface; name another in the board (ip link show type can)"}};
    link.up = (info.ifi_flags & IFF_UP) != 0;
    each_attribute(netlink.data() + head, netlink.length() - head,
                   [&](int type, const std::byte* payload, std::size_t length) {
                       if (type == IFLA_LINKINFO) read_link_info(payload, length, link);
                   });
    return link;
}

std::expected<void, Sentence> restart_link(const Link& link) {
    Netlink netlink;
    for (const bool up : {false, true}) {
        ifinfomsg what{};
        what.ifi_family = AF_UNSPEC;
        what.ifi_index = link.index;
        what.ifi_change = IFF_UP;
        what.ifi_flags = up ? unsigned{IFF_UP} : 0u;
        if (const int error = netlink.ask(what, RTM_NEWLINK, NLM_F_ACK))
            return std::unexpected{Sentence{
                "CAN interface number ", link.index, up ? " cannot be set up" : " cannot be set down", ": ",
                strerrordesc_np(error),
                error == EPERM ? "; run the firmware with CAP_NET_ADMIN" : "; see the kernel's log"}};
    }
    return {};
}

} // namespace tappet::can
