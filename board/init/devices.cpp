// SPDX-License-Identifier: Apache-2.0
// Modules, interfaces and GPIO chips, by the kernel's own interfaces, without tools.
#include "board/init/devices.hpp"

#include <cerrno>
#include <cstddef>
#include <cstdio>
#include <cstring>

#include <arpa/inet.h>
#include <fcntl.h>
#include <linux/can.h>
#include <linux/can/netlink.h>
#include <linux/if_link.h>
#include <linux/rtnetlink.h>
#include <net/if.h>
#include <sys/ioctl.h>
#include <sys/mount.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace tappet::init {
namespace {

// One rtnetlink request, built by hand, because an `ip` program would need its libraries in every image.
template <class Body>
class LinkRequest {
public:
    LinkRequest(unsigned short type, const Body& body, unsigned flags) : body_{body} {
        header_.nlmsg_len = NLMSG_LENGTH(sizeof(Body));
        header_.nlmsg_type = type;
        header_.nlmsg_flags = static_cast<unsigned short>(NLM_F_REQUEST | NLM_F_ACK | flags);
    }

    std::size_t begin(unsigned short type) {
        const std::size_t at = attributes_.size();
        rtattr attribute{};
        attribute.rta_type = type;
        append(&attribute, sizeof attribute);
        return at;
    }

    void end(std::size_t at) {
        const auto length = static_cast<unsigned short>(attributes_.size() - at);
        std::memcpy(attributes_.data() + at + offsetof(rtattr, rta_len), &length, sizeof length);
        attributes_.resize((attributes_.size() + 3) / 4 * 4);
    }

    void bytes(unsigned short type, const void* data, std::size_t count) {
        const std::size_t at = begin(type);
        append(data, count);
        end(at);
    }
    void text(unsigned short type, const std::string& value) { bytes(type, value.data(), value.size()); }

    bool send() {
        header_.nlmsg_len += static_cast<unsigned>(attributes_.size());
        std::vector<char> message(header_.nlmsg_len);
        std::memcpy(message.data(), &header_, sizeof header_);
        std::memcpy(message.data() + NLMSG_LENGTH(0), &body_, sizeof body_);
        std::memcpy(message.data() + NLMSG_LENGTH(sizeof(Body)), attributes_.data(), attributes_.size());
        const int socket = ::socket(AF_NETLINK, SOCK_RAW | SOCK_CLOEXEC, NETLINK_ROUTE);
        if (socket < 0 || ::send(socket, message.data(), message.size(), 0) < 0) return false;
        char answer[1024];
        const ssize_t count = ::recv(socket, answer, sizeof answer, 0);
        ::close(socket);
        if (count < static_cast<ssize_t>(NLMSG_LENGTH(sizeof(nlmsgerr)))) {
            errno = EPROTO;
            return false;
        }
        nlmsgerr error{};
        std::memcpy(&error, answer + NLMSG_LENGTH(0), sizeof error);
        errno = -error.error;
        return error.error == 0;
    }

private:
    void append(const void* data, std::size_t count) {
        const auto* first = static_cast<const char*>(data);
        attributes_.insert(attributes_.end(), first, first + count);
    }

    nlmsghdr header_{};
    Body body_;
    std::vector<char> attributes_;
};

} // namespace

// After the module: the signature, a record that ends with the signature's length (4 bytes), a magic text.
std::string_view without_signature(std::string_view module) {
    constexpr std::string_view mark = "~Module signature appended~\n";
    constexpr std::size_t row_bytes = 12, length_bytes = 4;
    if (!module.ends_with(mark) || module.size() < row_bytes + mark.size()) return module;
    const std::string_view rest = module.substr(0, module.size() - mark.size());
    std::size_t length = 0;
    for (const char byte : rest.substr(rest.size() - length_bytes))
        length = 256 * length + static_cast<unsigned char>(byte);
    return length > rest.size() - row_bytes ? module : rest.substr(0, rest.size() - row_bytes - length);
}

Done load_module(const std::string& path, const std::string& parameters, Signature signature) {
    long done = -1;
    if (signature == Signature::off) {
        const std::string file = read_text(path);
        const std::string_view module = without_signature(file);
        done = ::syscall(SYS_init_module, module.data(), module.size(), parameters.c_str());
    } else if (const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC); descriptor >= 0) {
        done = ::syscall(SYS_finit_module, descriptor, parameters.c_str(), 0);
        close_it(descriptor);
    }
    return done == 0 || errno == EEXIST ? Done{} : failed("load module " + path);
}

// A module fails while a dependency is missing. Dependencies change from kernel to kernel, so it is retried
// after the others.
Done load_modules(std::vector<std::string> paths) {
    while (!paths.empty())
        if (std::erase_if(paths, [](const std::string& path) { return load_module(path).has_value(); }) == 0)
            return load_module(paths.front());
    return {};
}

bool has_interface(const std::string& name) { return ::if_nametoindex(name.c_str()) != 0; }

Done set_link(const std::string& name, bool up) {
    const int socket = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    ifreq request{};
    name.copy(request.ifr_name, sizeof request.ifr_name - 1);
    bool set = socket >= 0 && ::ioctl(socket, SIOCGIFFLAGS, &request) == 0;
    if (set) {
        const int flags = request.ifr_flags;
        request.ifr_flags = static_cast<short>(up ? (flags | IFF_UP) : (flags & ~IFF_UP));
        set = ::ioctl(socket, SIOCSIFFLAGS, &request) == 0;
    }
    close_it(socket);
    return set ? Done{} : failed("set interface " + name);
}

Done set_address(const std::string& name, const std::string& address) {
    const std::size_t slash = address.find('/');
    in_addr number{};
    int prefix = 0;
    if (slash == std::string::npos || ::inet_pton(AF_INET, address.substr(0, slash).c_str(), &number) != 1 ||
        std::sscanf(address.c_str() + slash, "/%d", &prefix) != 1 || prefix < 1 || prefix > 32) {
        errno = EINVAL;
        return failed("address " + address + " of interface " + name);
    }
    ifaddrmsg body{};
    body.ifa_family = AF_INET;
    body.ifa_prefixlen = static_cast<unsigned char>(prefix);
    body.ifa_index = ::if_nametoindex(name.c_str());
    LinkRequest request{RTM_NEWADDR, body, NLM_F_CREATE | NLM_F_REPLACE};
    request.bytes(IFA_LOCAL, &number, sizeof number);
    request.bytes(IFA_ADDRESS, &number, sizeof number);
    return request.send() ? Done{} : failed("set address " + address + " of interface " + name);
}

Done set_bit_rates(const std::string& name, std::uint32_t bits_per_second, std::uint32_t in_data_phase) {
    ifinfomsg body{};
    body.ifi_index = static_cast<int>(::if_nametoindex(name.c_str()));
    LinkRequest request{RTM_NEWLINK, body, 0};
    const std::uint32_t room = 10; // frames queued in the kernel: more would only become old
    request.bytes(IFLA_TXQLEN, &room, sizeof room);
    const std::size_t info = request.begin(IFLA_LINKINFO);
    request.text(IFLA_INFO_KIND, "can");
    const std::size_t data = request.begin(IFLA_INFO_DATA);
    can_bittiming timing{};
    timing.bitrate = bits_per_second;
    request.bytes(IFLA_CAN_BITTIMING, &timing, sizeof timing);
    if (in_data_phase != 0) {
        timing.bitrate = in_data_phase;
        request.bytes(IFLA_CAN_DATA_BITTIMING, &timing, sizeof timing);
        const can_ctrlmode fd{CAN_CTRLMODE_FD, CAN_CTRLMODE_FD};
        request.bytes(IFLA_CAN_CTRLMODE, &fd, sizeof fd);
    }
    const std::uint32_t restart_ms = 0;
    request.bytes(IFLA_CAN_RESTART_MS, &restart_ms, sizeof restart_ms);
    request.end(data);
    request.end(info);
    if (request.send()) return {};
    return failed("set " + std::to_string(bits_per_second) + " bit/s" +
                  (in_data_phase == 0 ? "" : ", CAN FD at " + std::to_string(in_data_phase) + " bit/s,") +
                  " on CAN interface " + name);
}

Done create_can(const std::string& name) {
    LinkRequest request{RTM_NEWLINK, ifinfomsg{}, NLM_F_CREATE | NLM_F_EXCL};
    request.text(IFLA_IFNAME, name);
    const std::uint32_t mtu = CANFD_MTU;
    request.bytes(IFLA_MTU, &mtu, sizeof mtu);
    const std::size_t info = request.begin(IFLA_LINKINFO);
    request.text(IFLA_INFO_KIND, "vcan");
    request.end(info);
    if (!request.send()) return failed("create CAN interface " + name);
    return set_link(name, true);
}

Done create_gpio_chip(const std::string& name, const std::string& lines) {
    ::mount("configfs", "/sys/kernel/config", "configfs", 0, nullptr); // it may already be mounted
    const std::string chip = "/sys/kernel/config/gpio-sim/" + name;
    const std::string bank = chip + "/bank0";
    if (::mkdir(chip.c_str(), 0755) != 0 || ::mkdir(bank.c_str(), 0755) != 0)
        return failed("create GPIO chip " + name);
    if (!write_text(bank + "/label", name) || !write_text(bank + "/num_lines", lines) ||
        !write_text(chip + "/live", "1")) {
        return failed("start GPIO chip " + name + " with " + lines + " lines");
    }
    const std::string device = read_line(bank + "/chip_name");
    const std::string simulation = "/sys/devices/platform/" + read_line(chip + "/dev_name") + "/" + device;
    make_folder("/sim");
    if (::symlink(("/dev/" + device).c_str(), ("/dev/" + name).c_str()) != 0 ||
        ::symlink(simulation.c_str(), ("/sim/" + name).c_str()) != 0) {
        return failed("name GPIO chip " + name);
    }
    return {};
}

} // namespace tappet::init
