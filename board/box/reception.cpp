// SPDX-License-Identifier: Apache-2.0
// A client sends a line, and for an update its header and kernel; then it is answered and closed.
#include "board/box/reception.hpp"

#include "board/box/facts.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <utility>

#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

namespace tappet::box {

namespace {

constexpr std::size_t longest_line = 512;

/// Does not wait for a client that does not read: its window is larger than any answer.
void say(int socket, std::string_view text) {
    [[maybe_unused]] const ssize_t n = ::send(socket, text.data(), text.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
}

/// Returns the version of the update that waits for the power button. 0: none waits.
std::uint32_t waiting_version() {
    std::string header(update_header_bytes, '\0');
    std::FILE* const file = std::fopen(offered_update, "rb");
    if (file == nullptr) return 0;
    header.resize(std::fread(header.data(), 1, header.size(), file));
    std::fclose(file);
    return claimed_bytes(header) == 0 ? 0 : manifest_of(header).version;
}

/// Writes the whole file or none. A new offer replaces the previous one.
bool keep(const char* name, std::string_view bytes) {
    const std::string part = std::string{name} + ".part";
    std::FILE* const file = std::fopen(part.c_str(), "wb");
    if (file == nullptr) return false;
    bool well = std::fwrite(bytes.data(), 1, bytes.size(), file) == bytes.size();
    well = std::fclose(file) == 0 && well;
    if (well) return std::rename(part.c_str(), name) == 0;
    ::unlink(part.c_str());
    return false;
}

constexpr const char* accepted = "; press the power button at the machine: it stops, and then it is done\n";

std::string refused(const std::string& why) { return "refused\n" + why + "\n"; }

std::string take_order(const Words& words, const ServiceFacts& facts) {
    if (words.size() != 3 || std::ranges::find(order_verbs, words[1]) == order_verbs.end())
        return refused("an order is roll-back, factory-reset or measure, with its signature");
    if (!is_signed({words[1], facts.own.machine, facts.own.board, facts.nonce}, words[2], *facts.key))
        return refused("its signature does not match this box's key, or was made before its last start");
    if (!keep(offered_order, words[1] + "\n" + words[2] + "\n")) return refused("the box has no memory left");
    return "ok\n" + words[1] + accepted;
}

std::string what_waits() {
    std::string text;
    for (const auto& [file, what] : {std::pair{offered_update, "update"}, {offered_order, "order"}})
        if (::access(file, F_OK) == 0) text += std::string{"an "} + what + " waits for the power button\n";
    return text;
}

} // namespace

Reception::~Reception() {
    for (const Client& each : clients_) ::close(each.socket);
}

void Reception::greet(int socket, std::uint32_t address, Time now) {
    if (clients_.size() == most_clients) make_room();
    clients_.push_back({.socket = socket, .address = address, .since = now, .heard = now});
    say(socket, std::string{service_greeting} + facts_.own.machine + " " + facts_.own.board + " " +
                    facts_.nonce + "\n");
}

// Not by silence: a client that sends a byte at times would outstay one that waits for its answer.
void Reception::make_room() {
    const auto places = [this](const Client& of) {
        return of.stage == Stage::kernel ? 0 : std::ranges::count(clients_, of.address, &Client::address);
    };
    const auto leaves = std::ranges::max_element(clients_, {}, places); // the first of equal ones
    ::close(leaves->socket);
    clients_.erase(leaves);
}

bool Reception::wait(int listener) const {
    std::array<pollfd, most_clients + 1> files{};
    files[0] = {listener, POLLIN, 0};
    for (std::size_t i = 0; i < clients_.size(); ++i) files[i + 1] = {clients_[i].socket, POLLIN, 0};
    return ::poll(files.data(), clients_.size() + 1, 1000) > 0 && files[0].revents != 0;
}

void Reception::hear(Time now) {
    for (Client& each : clients_) {
        take_from(each, now);
        end_if_late(each, now);
    }
    for (const Client& each : clients_)
        if (each.stage == Stage::gone) ::close(each.socket);
    std::erase_if(clients_, [](const Client& each) { return each.stage == Stage::gone; });
}

void Reception::take_from(Client& client, Time now) {
    std::array<char, 65536> piece{};
    std::size_t wanted = piece.size();
    if (client.stage == Stage::line) wanted = longest_line - client.said.size();
    if (client.stage == Stage::header || client.stage == Stage::kernel)
        wanted = std::min<std::uint64_t>(wanted, client.bytes - client.said.size());
    const ssize_t n = ::recv(client.socket, piece.data(), wanted, MSG_DONTWAIT);
    if (n > 0) {
        client.heard = now;
        if (client.stage == Stage::goodbye) return;
        client.said.append(piece.data(), static_cast<std::size_t>(n));
        advance(client, now);
    } else if (n == 0 && client.stage == Stage::header) {
        answer(client, refused("it is not an update; send the update.tap that was written with an image"),
               now);
    } else if (n == 0 && client.stage == Stage::kernel) {
        answer(client, refused("it is incomplete"), now);
    } else if (n == 0 || (errno != EAGAIN && errno != EINTR)) {
        client.stage = Stage::gone;
    }
}

void Reception::advance(Client& client, Time now) {
    if (client.stage == Stage::line) take_line(client, now);
    if (client.stage == Stage::header && client.said.size() == client.bytes) take_header(client, now);
    if (client.stage == Stage::kernel && client.said.size() == client.bytes)
        answer(client, judge_update(client), now);
}

void Reception::take_line(Client& client, Time now) {
    const std::size_t end = client.said.find('\n');
    if (end == std::string::npos) {
        if (client.said.size() == longest_line) client.stage = Stage::gone;
        return;
    }
    const Facts lines{client.said.substr(0, end)};
    client.said.erase(0, end + 1);
    const Words words = lines.lines().empty() ? Words{""} : lines.lines().front();
    if (words[0] == "status")
        answer(client, "ok\n" + init::read_text(status_file) + what_waits(), now);
    else if (!facts_.key)
        answer(client, refused("this box's image has no key; flash one that was written with --key"), now);
    else if (words[0] == "update")
        enter(client, Stage::header, now);
    else if (words[0] == "order")
        answer(client, take_order(words, facts_), now);
    else
        answer(client, refused("unknown request; known are status, update and order"), now);
}

void Reception::take_header(Client& client, Time now) {
    if (const std::string why = refusal_of_header(client); !why.empty())
        return answer(client, refused(why), now);
    client.version = manifest_of(client.said).version;
    for (Client& other : clients_) {
        if (other.stage != Stage::kernel) continue;
        const double took_s = std::chrono::duration<double>{now - other.since}.count();
        const bool is_slow =
            took_s >= 5.0 && static_cast<double>(other.said.size()) < slow_bytes_per_s * took_s;
        if (client.version < other.version || (client.version == other.version && !is_slow))
            return answer(client,
                          refused("version " + std::to_string(other.version) +
                                  " is on its way already; wait until it is received"),
                          now);
        answer(other, refused("another update took its place"), now);
    }
    client.bytes = claimed_bytes(client.said);
    client.said.reserve(client.bytes);
    enter(client, Stage::kernel, now);
}

std::string Reception::refusal_of_header(const Client& client) const {
    const std::uint64_t claimed = claimed_bytes(client.said);
    if (claimed == 0) return "it is not an update; send the update.tap that was written with an image";
    if (claimed > most_update_bytes) return "it is larger than a slot";
    const Manifest offered = manifest_of(client.said);
    if (std::string why = refusal_of(offered, facts_.own); !why.empty()) return why;
    if (!has_signed_header(client.said, *facts_.key))
        return "its header's signature does not match this box's key: it is somebody else's, or damaged, or "
               "an older tappet wrote it; write it anew";
    // Older versions are signed, too: with one, somebody could block a newer one for ever.
    if (const auto waiting = waiting_version(); offered.version < waiting)
        return "it is version " + std::to_string(offered.version) + ", and version " +
               std::to_string(waiting) + " waits for the power button";
    return {};
}

std::string Reception::judge_update(const Client& client) const {
    const auto update = decode(client.said, *facts_.key);
    if (!update) return refused(update.error());
    if (!keep(offered_update, client.said)) return refused("the box has no memory left for it");
    std::string text =
        "ok\nversion " + std::to_string(update->manifest.version) + " is received and its signature is valid";
    if (update->manifest.layout != facts_.own.layout)
        text +=
            "; its properties differ: values that it does not know are kept for the version that knows them";
    return text + accepted;
}

void Reception::end_if_late(Client& client, Time now) {
    switch (client.stage) {
    case Stage::line:
        if (now - client.since > for_a_request) client.stage = Stage::gone;
        break;
    case Stage::header:
        if (now - client.since > for_a_request) answer(client, refused("its header came too slowly"), now);
        break;
    case Stage::kernel:
        if (now - client.heard > longest_pause) answer(client, refused("it paused for too long"), now);
        break;
    case Stage::goodbye:
        if (now - client.since > for_goodbye) client.stage = Stage::gone;
        break;
    case Stage::gone: break;
    }
}

void Reception::enter(Client& client, Stage stage, Time now) {
    client.stage = stage;
    client.since = now;
}

// Then reads for a while: closing a socket with unread bytes would drop the answer.
void Reception::answer(Client& client, std::string_view text, Time now) {
    say(client.socket, text);
    ::shutdown(client.socket, SHUT_WR);
    std::string{}.swap(client.said);
    enter(client, Stage::goodbye, now);
}

} // namespace tappet::box
