// Reads an interface's answer over rtnetlink, attribute by attribute.
#include "drivers/can/link.hpp"

#include "drivers/can/netlink.hpp"

#include <cerrno>
#include <cstring>
#include <linux/can/netlink.h>
#include <net/if.h>
#include <net/if_arp.h>

namespace tappet::can {
namespace {

/// Calls visit(type, payload, length) for each attribute; stops at the first invalid one.
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

State to_state(std::uint32_t told) {
    switch (told) {
    case CAN_STATE_ERROR_ACTIVE: return State::active;
    case CAN_STATE_ERROR_WARNING: return State::warning;
    case CAN_STATE_ERROR_PASSIVE: return State::passive;
    case CAN_STATE_BUS_OFF: return State::bus_off;
    default: return State::down; // stopped, sleeping
    }
}

void read_can_attributes(const std::byte* at, std::size_t left, Link& link) {
    each_attribute(at, left, [&](int type, const std::byte* payload, std::size_t length) {
        if (type == IFLA_CAN_RESTART_MS && length >= sizeof link.restart_ms)
            std::memcpy(&link.restart_ms, payload, sizeof link.restart_ms);
        if (std::uint32_t told = 0; type == IFLA_CAN_STATE && length >= sizeof told) {
            std::memcpy(&told, payload, sizeof told);
            link.state = to_state(told);
        }
        can_bittiming timing{};
        const bool is_data = type == IFLA_CAN_DATA_BITTIMING;
        if ((type == IFLA_CAN_BITTIMING || is_data) && length >= sizeof timing) {
            std::memcpy(&timing, payload, sizeof timing);
            (is_data ? link.data_bit_rate : link.bit_rate) = timing.bitrate;
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

std::expected<Link, Sentence> read_link(std::string_view interface, std::span<const std::byte> answer) {
    const Sentence who{"CAN interface \"", interface, "\""};
    ifinfomsg info{};
    constexpr std::size_t head = sizeof(nlmsghdr) + sizeof info;
    if (answer.size() < head)
        return std::unexpected{
            Sentence{who, " gave a short answer over rtnetlink; is this kernel supported?"}};
    std::memcpy(&info, answer.data() + sizeof(nlmsghdr), sizeof info);
    if (info.ifi_type != ARPHRD_CAN)
        return std::unexpected{
            Sentence{who, " is not a CAN interface; name another in the board (ip link show type can)"}};
    Link link;
    link.index = info.ifi_index;
    link.up = (info.ifi_flags & IFF_UP) != 0;
    each_attribute(answer.data() + head, answer.size() - head,
                   [&](int type, const std::byte* payload, std::size_t length) {
                       if (type == IFLA_LINKINFO) read_link_info(payload, length, link);
                       if (type == IFLA_MTU && length >= sizeof link.mtu)
                           std::memcpy(&link.mtu, payload, sizeof link.mtu);
                   });
    return link;
}

std::expected<Link, Sentence> find_link(std::string_view interface) {
    const Sentence who{"CAN interface \"", interface, "\""};
    char name[IFNAMSIZ] = {};
    if (interface.empty() || interface.size() >= sizeof name)
        return std::unexpected{
            Sentence{who, " cannot exist: a name has 1 to 15 characters; correct it in the board"}};
    interface.copy(name, interface.size());
    ifinfomsg what{};
    what.ifi_family = AF_UNSPEC;
    what.ifi_index = static_cast<int>(::if_nametoindex(name));
    if (what.ifi_index == 0)
        return std::unexpected{
            Sentence{who, " does not exist: create it (ip link add dev ", interface,
                     " type vcan, or load its controller's driver) or name another in the board"}};
    Netlink netlink;
    if (const int error = netlink.ask(what, RTM_GETLINK, 0))
        return std::unexpected{Sentence{
            who, " cannot be asked for its settings: ", strerrordesc_np(error),
            error == EMSGSIZE ? "; it has too many alternative names, remove some (ip link property del)"
                              : "; the kernel must offer rtnetlink"}};
    return read_link(interface, netlink.data());
}

std::expected<void, Sentence> fit_for_fd(const Link& link, std::string_view interface) {
    if (link.takes_fd()) return {};
    return std::unexpected{
        Sentence{"CAN interface \"", interface, "\" carries classical frames only (mtu ", link.mtu,
                 ", of CAN FD 72), and its bus has CAN FD: set it down, and up again after ip link set ",
                 interface, link.is_virtual ? " mtu 72" : " type can bitrate ... dbitrate ... fd on",
                 link.is_virtual ? "" : "; its controller must be one for CAN FD"}};
}

std::expected<void, Sentence> fit(const Link& link, std::string_view interface, const Settings& settings) {
    const Sentence who{"CAN interface \"", interface, "\""};
    if (!link.up)
        return std::unexpected{Sentence{who, " is down: set it up (ip link set ", interface, " up",
                                        link.is_virtual ? "" : ", after its bitrate is set", ")"}};
    if (link.restart_ms != 0)
        return std::unexpected{
            Sentence{who, " restarts by itself ", link.restart_ms,
                     " ms after bus-off, and a machine restarts it deliberately: set restart-ms 0"}};
    if (settings.bit_rate == 0)
        return std::unexpected{
            Sentence{who, " is opened without its bit rate: the board says it, bit_rate(500'000)"}};
    if (settings.takes_fd && settings.data_bit_rate == 0)
        return std::unexpected{Sentence{who,
                                        " is opened for CAN FD without its data bit rate: the board says "
                                        "it, bit_rate(500'000, 2'000'000)"}};
    if (!link.is_virtual && link.bit_rate != settings.bit_rate)
        return std::unexpected{Sentence{who, " runs at ", link.bit_rate, " bit/s, the board says ",
                                        settings.bit_rate, ": correct one of them (ip link set ", interface,
                                        " type can bitrate ...)"}};
    if (settings.takes_fd || (!link.is_virtual && settings.data_bit_rate != 0))
        if (auto good = fit_for_fd(link, interface); !good) return good;
    if (!link.is_virtual && settings.data_bit_rate != 0 && link.data_bit_rate != settings.data_bit_rate)
        return std::unexpected{Sentence{who, " runs at ", link.data_bit_rate,
                                        " bit/s in CAN FD's data phase, the board says ",
                                        settings.data_bit_rate, ": correct one of them (ip link set ",
                                        interface, " type can dbitrate ... fd on)"}};
    if (faulted(link.state))
        return std::unexpected{Sentence{who, link.state == State::bus_off ? " is bus-off" : " is stopped",
                                        ": look at its wiring and at the other nodes' power, then restart it "
                                        "(ip link set ",
                                        interface, " down, and up)"}};
    return {};
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
