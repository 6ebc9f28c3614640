// SPDX-License-Identifier: Apache-2.0
// Modules, ports, CAN interfaces and GPIO chips, by the kernel's own interfaces: the guest has no tools.
#include "board/bench/devices.hpp"

#include "board/bench/guest.hpp"

#include <cerrno>
#include <cstddef>
#include <cstring>

#include <dirent.h>
#include <fcntl.h>
#include <linux/if_link.h>
#include <linux/rtnetlink.h>
#include <net/if.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace tappet::bench {
namespace {

bool load_module(const std::string& path) {
    const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
    if (descriptor < 0) {
        return false;
    }
    const bool loaded = ::syscall(SYS_finit_module, descriptor, "", 0) == 0 || errno == EEXIST;
    const int error = errno;
    ::close(descriptor);
    errno = error;
    return loaded;
}

// One rtnetlink request, laid out by hand: the alternative is an `ip` program and its libraries in every
// guest.
class LinkRequest {
public:
    LinkRequest() {
        header_.nlmsg_len = NLMSG_LENGTH(sizeof(ifinfomsg));
        header_.nlmsg_type = RTM_NEWLINK;
        header_.nlmsg_flags = NLM_F_REQUEST | NLM_F_CREATE | NLM_F_EXCL | NLM_F_ACK;
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

    void text(unsigned short type, const std::string& value) {
        const std::size_t at = begin(type);
        append(value.data(), value.size());
        end(at);
    }

    bool send() {
        header_.nlmsg_len += static_cast<unsigned>(attributes_.size());
        std::vector<char> message(header_.nlmsg_len);
        std::memcpy(message.data(), &header_, sizeof header_);
        std::memcpy(message.data() + NLMSG_LENGTH(sizeof(ifinfomsg)), attributes_.data(), attributes_.size());
        const int socket = ::socket(AF_NETLINK, SOCK_RAW | SOCK_CLOEXEC, NETLINK_ROUTE);
        if (socket < 0 || ::send(socket, message.data(), message.size(), 0) < 0) {
            return false;
        }
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
    void append(const void* bytes, std::size_t count) {
        const auto* first = static_cast<const char*>(bytes);
        attributes_.insert(attributes_.end(), first, first + count);
    }

    nlmsghdr header_{};
    std::vector<char> attributes_;
};

} // namespace

// A module fails as long as one that it needs is missing. Which needs which changes from kernel to kernel, so
// it is tried again after the others.
void load_modules(std::vector<std::string> modules) {
    while (!modules.empty()) {
        if (std::erase_if(modules, load_module) == 0) {
            load_module(modules.front());
            give_up("load module " + modules.front());
        }
    }
}

int open_port(const std::string& wanted) {
    const std::string folder = "/sys/class/virtio-ports";
    for (int attempt = 0; attempt < 500; ++attempt) {
        if (DIR* ports = ::opendir(folder.c_str())) {
            while (const dirent* entry = ::readdir(ports)) {
                const std::string port = entry->d_name;
                if (read_line(folder + "/" + port + "/name") == wanted) {
                    const int descriptor = ::open(("/dev/" + port).c_str(), O_RDWR | O_CLOEXEC);
                    if (descriptor >= 0) {
                        ::closedir(ports);
                        return descriptor;
                    }
                }
            }
            ::closedir(ports);
        }
        pause_for(std::chrono::milliseconds(10));
    }
    give_up("open host port " + wanted);
}

void set_link(const std::string& name, bool up) {
    const int socket = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    ifreq request{};
    name.copy(request.ifr_name, sizeof request.ifr_name - 1);
    if (socket < 0 || ::ioctl(socket, SIOCGIFFLAGS, &request) != 0) {
        give_up("find interface " + name);
    }
    const int flags = request.ifr_flags;
    request.ifr_flags = static_cast<short>(up ? (flags | IFF_UP) : (flags & ~IFF_UP));
    if (::ioctl(socket, SIOCSIFFLAGS, &request) != 0) {
        give_up("set interface " + name);
    }
    ::close(socket);
}

void create_can(const std::string& name) {
    LinkRequest request;
    request.text(IFLA_IFNAME, name);
    const std::size_t info = request.begin(IFLA_LINKINFO);
    request.text(IFLA_INFO_KIND, "vcan");
    request.end(info);
    if (!request.send()) {
        give_up("create CAN interface " + name);
    }
    set_link(name, true);
}

// A chip is reached by its name on both sides: /dev/NAME is the character device a driver opens, /sim/NAME is
// the folder in which the outside world pulls inputs and reads outputs (sim_gpioN/pull, sim_gpioN/value).
void create_gpio_chip(const std::string& name, const std::string& lines) {
    const std::string chip = "/sys/kernel/config/gpio-sim/" + name;
    const std::string bank = chip + "/bank0";
    if (::mkdir(chip.c_str(), 0755) != 0 || ::mkdir(bank.c_str(), 0755) != 0) {
        give_up("create GPIO chip " + name);
    }
    if (!write_text(bank + "/label", name) || !write_text(bank + "/num_lines", lines) ||
        !write_text(chip + "/live", "1")) {
        give_up("start GPIO chip " + name + " with " + lines + " lines");
    }
    const std::string device = read_line(bank + "/chip_name");
    const std::string simulation = "/sys/devices/platform/" + read_line(chip + "/dev_name") + "/" + device;
    make_folder("/sim");
    if (::symlink(("/dev/" + device).c_str(), ("/dev/" + name).c_str()) != 0 ||
        ::symlink(simulation.c_str(), ("/sim/" + name).c_str()) != 0) {
        give_up("name GPIO chip " + name);
    }
}

} // namespace tappet::bench
