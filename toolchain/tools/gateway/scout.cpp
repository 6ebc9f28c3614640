// Compares the sockets of a directory with those known.
#include "toolchain/tools/gateway/scout.hpp"

#include "toolchain/tools/gateway/encoding.hpp"

#include "kernel/services/browsing/protocol.hpp"

#include <algorithm>
#include <filesystem>
#include <set>

namespace tappet::network {

namespace {

std::string name_of(const std::string& socket) {
    std::string name = std::filesystem::path{socket}.filename().string();
    name.resize(name.size() - browsing::socket_suffix.size());
    return as_utf8(name);
}

std::set<std::string> sockets_in(const std::string& directory) {
    std::set<std::string> found;
    std::error_code error;
    for (std::filesystem::directory_iterator each{directory, error}, end; !error && each != end;
         each.increment(error)) {
        const std::string& path = each->path().native();
        if (path.ends_with(browsing::socket_suffix) && found.size() < bounds.machines) found.insert(path);
    }
    return found;
}

} // namespace

std::vector<Sighting> Scout::look(Clock::time_point now) {
    std::vector<Sighting> changed;
    const std::set<std::string> present = sockets_in(directory_);
    for (auto each = known_.begin(); each != known_.end();) {
        const bool stays =
            present.contains(each->first) || (each->second.link && !each->second.link->ended());
        if (!stays) changed.push_back({name_of(each->first), each->first, nullptr, "it has ended", true});
        each = stays ? std::next(each) : known_.erase(each);
    }
    for (const std::string& socket : present) {
        Known& known = known_[socket];
        if (known.link && known.link->ended()) {
            known.link.reset();
            known.next = {};
        }
        if (!known.link && now >= known.next) ask(socket, known, now, changed);
    }
    return changed;
}

void Scout::ask(const std::string& socket, Known& known, Clock::time_point now,
                std::vector<Sighting>& changed) {
    auto opened = open_place(socket, name_of(socket) + ".");
    if (opened) {
        known.link.emplace(std::move(opened->first));
        known.place = std::move(opened->second);
        known.pause = {};
        known.reason.clear();
        changed.push_back({name_of(socket), socket, known.place, {}, false});
        return;
    }
    known.pause = std::min(std::max(2 * known.pause, bounds.machine_poll), 16 * bounds.machine_poll);
    known.next = now + known.pause;
    // A machine whose places are all taken refuses this connection and works on: its memory stays readable.
    if (opened.error().fault == browser::Fault::refused && known.place != nullptr) return;
    if (known.place == nullptr && known.reason == opened.error().sentence) return;
    known.place.reset();
    known.reason = opened.error().sentence;
    changed.push_back({name_of(socket), socket, nullptr, known.reason, false});
}

} // namespace tappet::network
