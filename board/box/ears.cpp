// SPDX-License-Identifier: Apache-2.0
// One descriptor for each kind of input.
#include "board/box/ears.hpp"

#include <array>
#include <csignal>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <string>

#include <fcntl.h>
#include <linux/input.h>
#include <poll.h>
#include <sys/signalfd.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

namespace tappet::box {

namespace {

constexpr std::string_view notify_name{"\0tappet-init", 12};
constexpr int most_at_once = 16; // limit per call, so that endless output cannot block init

} // namespace

init::Done Ears::open() {
    sigset_t all;
    ::sigfillset(&all);
    ::sigprocmask(SIG_SETMASK, &all, nullptr);
    signals_ = ::signalfd(-1, &all, SFD_NONBLOCK | SFD_CLOEXEC);
    notices_ = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
    ::setenv("NOTIFY_SOCKET", "@tappet-init", 1);
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::memcpy(address.sun_path, notify_name.data(), notify_name.size());
    const auto length = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + notify_name.size());
    const int yes = 1;
    int ends[2] = {-1, -1};
    if (notices_ < 0 || ::setsockopt(notices_, SOL_SOCKET, SO_PASSCRED, &yes, sizeof yes) != 0 ||
        ::bind(notices_, reinterpret_cast<sockaddr*>(&address), length) != 0 || ::pipe2(ends, O_CLOEXEC) != 0)
        return init::failed("the firmware's messages cannot be received");
    prints_ = ends[0];
    mouth_ = ends[1];
    ::fcntl(prints_, F_SETFL, O_NONBLOCK);
    return {};
}

void Ears::open_power_buttons() {
    for (const std::string& name : init::names_in("/dev/input"))
        if (name.starts_with("event"))
            if (const int device = ::open(("/dev/input/" + name).c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
                device >= 0)
                buttons_.push_back(device);
}

void Ears::wait(std::chrono::milliseconds time) const {
    std::vector<pollfd> files{{signals_, POLLIN, 0}, {notices_, POLLIN, 0}, {prints_, POLLIN, 0}};
    for (const int button : buttons_) files.push_back({button, POLLIN, 0});
    ::poll(files.data(), files.size(), static_cast<int>(time.count()));
}

void Ears::take_prints(const std::function<void(std::string_view)>& take) const {
    std::array<char, 4096> text{};
    ssize_t count = 0;
    for (int i = 0; i < most_at_once && (count = ::read(prints_, text.data(), text.size())) > 0; ++i)
        take({text.data(), static_cast<std::size_t>(count)});
}

void Ears::take_notices(const std::function<void(std::string_view)>& take) const {
    std::array<char, 256> text{};
    alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof(ucred))> about{};
    for (int i = 0; i < most_at_once; ++i) {
        iovec part{text.data(), text.size()};
        msghdr message{};
        message.msg_iov = &part;
        message.msg_iovlen = 1;
        message.msg_control = about.data();
        message.msg_controllen = about.size();
        const ssize_t count = ::recvmsg(notices_, &message, 0);
        if (count <= 0) return;
        // The service, which strangers talk to, can reach the socket too, but its notices are ignored.
        const cmsghdr* const header = CMSG_FIRSTHDR(&message);
        ucred sender{};
        const bool is_told = header != nullptr && header->cmsg_type == SCM_CREDENTIALS;
        if (is_told) std::memcpy(&sender, CMSG_DATA(header), sizeof sender);
        if (is_told && sender.uid == ::getuid()) take({text.data(), static_cast<std::size_t>(count)});
    }
}

void Ears::take_signals(const std::function<void(int)>& take) const {
    signalfd_siginfo signal{};
    while (::read(signals_, &signal, sizeof signal) == static_cast<ssize_t>(sizeof signal))
        take(static_cast<int>(signal.ssi_signo));
}

bool Ears::power_button_was_pressed() const {
    bool pressed = false;
    for (const int button : buttons_) {
        input_event event{};
        while (::read(button, &event, sizeof event) == static_cast<ssize_t>(sizeof event))
            pressed |= event.type == EV_KEY && event.code == KEY_POWER && event.value == 1;
    }
    return pressed;
}

} // namespace tappet::box
